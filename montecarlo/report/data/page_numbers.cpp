#include "montecarlo/report/data/page_numbers.hpp"

namespace wingspread {

Json page_number(double value, int digits) { return json_number(value, digits); }

Json page_number(const std::optional<double>& value) {
  return value ? page_number(*value) : Json(nullptr);
}

Json page_numbers(std::span<const double> values, int digits) {
  Json json = Json::array();
  for (const double value : values) json.push_back(page_number(value, digits));
  return json;
}

void add_bounds(Json& json, const Bounds& bounds) {
  json["lower"] = page_number(bounds.lower);
  json["upper"] = page_number(bounds.upper);
}

std::string page_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char letter : text)
    if (letter == '<')
      safe += "\\u003c";
    else
      safe += letter;
  return safe;
}

} // namespace wingspread
