/// Numbers of the page, rounded to limit its size.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// Significant digits: tables show at most 7, and curves need 4 on a screen of 4000 pixels.
inline constexpr int page_digits = 7;

/// The digits of values up to `largest` that show three digits of their spread: at least `least`, at most 17.
[[nodiscard]] int digits_that_show(double spread, double largest, int least = page_digits);

/// The value rounded to significant digits. NaN and infinities stay.
[[nodiscard]] double rounded(double value, int digits = page_digits);

/// The rounded number; null if not finite or absent.
[[nodiscard]] Json page_number(double value, int digits = page_digits);
[[nodiscard]] Json page_number(const std::optional<double>& value, int digits = page_digits);
[[nodiscard]] Json page_numbers(std::span<const double> values, int digits = page_digits);

/// A share with seven digits of its distance to 0 or 1, whichever is less; null if not finite.
[[nodiscard]] Json page_share(double share);
/// Adds the bounds of a share as "lower" and "upper"; null for a missing one.
void add_share_bounds(Json& json, const Bounds& bounds);

/// Adds the rounded bounds as "lower" and "upper"; null for a missing one.
void add_bounds(Json& json, const Bounds& bounds, int digits = page_digits);

/// JSON text to embed in HTML: one line, each `<` escaped.
[[nodiscard]] std::string page_text(const Json& json);

} // namespace wingspread
