/// Numbers with their units: "90 deg", "12 in*lbf", "350 mm", "2 deg/s", "0.1 N·m·s/rad".
///
/// A unit is a product of powers of unit symbols: `*` or `·`, `/`, `^` with a number or ² or ³, and brackets. An angle
/// is a dimension of its own, so that a stiffness (N·m/rad) is no torque. All factors are exact: in = 0.0254 m,
/// lb = 0.45359237 kg, lbf = 4.4482216152605 N. g is 9.80665 m/s² for an acceleration, else a gram.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// The dimension of a number in a document.
struct Dimension {
  std::string_view unit;        ///< SI unit of plain numbers, e.g. "kg·m²"; empty: dimensionless
  std::string_view condition{}; ///< condition in words, for messages, e.g. "> 0"
};

/// Converts text to a number in `unit`; nothing if the text is no finite number with a unit of the same dimension.
[[nodiscard]] std::optional<double> in_unit(std::string_view text, std::string_view unit);

/// Whether the text is a unit of any dimension.
[[nodiscard]] bool is_unit(std::string_view text);

/// All units of the same dimension, for messages: `"kg", "g", "lb", "lbm" or "slug"`. For a product of units the usual
/// ones, and the symbols allowed in it: `"s/rad" or "s/deg", or another one made of s, ms, min, h, rad, mrad,
/// deg, °, rev`.
[[nodiscard]] std::string units_like(std::string_view unit);

/// "a number, kg, > 0".
[[nodiscard]] std::string expected_number(const Dimension& dimension);
/// `a number, kg, > 0, or a string of a number and its unit: "kg", "g" or "lb"`.
[[nodiscard]] std::string expected_quantity(const Dimension& dimension);
/// "an array of 2 numbers, m"; `size` 0: any number.
[[nodiscard]] std::string expected_numbers(const Dimension& dimension, int size = 0);

} // namespace wingspread
