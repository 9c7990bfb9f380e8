#include "montecarlo/foundation/formats/json.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace wingspread {

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_number(double value, int digits) { return json_number(rounded(value, digits)); }

Json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : Json(nullptr);
}

double rounded(double value, int digits) {
  if (!std::isfinite(value)) return value;
  std::array<char, 64> text{};
  const char* end = fmt::format_to(text.data(), "{:.{}g}", value, digits);
  double result = value;
  std::from_chars(text.data(), end, result);
  return result == 0 ? 0 : result; // no -0
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

} // namespace wingspread
