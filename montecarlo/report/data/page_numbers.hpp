/// Numbers of the page: with as many digits as a reader can use, for every byte of the page is sent around.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// What a table shows, and a curve needs at the edge of a projector's screen.
inline constexpr int page_digits = 7;

/// To so many significant digits: the double that is written with no more. NaN and infinities stay.
[[nodiscard]] double rounded(double value, int digits = page_digits);

/// Null where it is not finite, or not there.
[[nodiscard]] Json page_number(double value, int digits = page_digits);
[[nodiscard]] Json page_number(const std::optional<double>& value);
[[nodiscard]] Json page_numbers(std::span<const double> values, int digits = page_digits);

/// Adds "lower" and "upper".
void add_bounds(Json& json, const Bounds& bounds);

/// A block of JSON that may stand in HTML: one line, and no `<` in it.
[[nodiscard]] std::string page_text(const Json& json);

} // namespace wingspread
