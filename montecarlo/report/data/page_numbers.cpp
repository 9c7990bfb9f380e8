#include "montecarlo/report/data/page_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

int digits_that_show(double spread, double largest, int least) {
  if (!(spread > 0 && largest > 0)) return least;
  return std::clamp(3 + static_cast<int>(std::ceil(std::log10(largest / spread))), least, 17);
}

Json page_number(double value, int digits) { return json_number(value, digits); }

Json page_number(const std::optional<double>& value, int digits) {
  return value ? page_number(*value, digits) : Json(nullptr);
}

Json page_numbers(std::span<const double> values, int digits) {
  Json json = Json::array();
  for (const double value : values) json.push_back(page_number(value, digits));
  return json;
}

Json page_share(double share) {
  constexpr double near =
      1e-3; // to 1: seven digits of the share would be fewer than four of its distance
  constexpr int all = 16; // at 1 the digits of a double
  return page_number(share, share < 1 && 1 - share < near ? all : page_digits);
}

void add_share_bounds(Json& json, const Bounds& bounds) {
  json["lower"] = bounds.lower ? page_share(*bounds.lower) : Json(nullptr);
  json["upper"] = bounds.upper ? page_share(*bounds.upper) : Json(nullptr);
}

void add_bounds(Json& json, const Bounds& bounds, int digits) {
  json["lower"] = page_number(bounds.lower, digits);
  json["upper"] = page_number(bounds.upper, digits);
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
