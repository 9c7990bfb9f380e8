/// Numbers with their units: "90 deg", "12 in*lbf", "350 mm", "2 deg/s", "0.1 N·m·s/rad".
///
/// A unit is a product of base units, each to a power, in the order of arithmetic: `*` or `·`, `/`, `^` with a
/// number or ² or ³, and brackets. An angle counts as a dimension of its own, so that a stiffness is no torque. All
/// factors are exact: in = 0.0254 m, lb = 0.45359237 kg, lbf = 4.4482216152605 N, g = 9.80665 m/s² where
/// an acceleration is meant and a gram everywhere else.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// What a number in a document measures.
struct Dimension {
  std::string_view
      unit; ///< the SI unit that plain numbers are in, e.g. "kg·m²"; none: a mere number
  std::string_view condition{}; ///< what it has to hold, for a message, e.g. "> 0"
};

/// The number in `unit`; nothing when the text is no finite number with a unit of the same dimension.
[[nodiscard]] std::optional<double> in_unit(std::string_view text, std::string_view unit);

/// Units of the same dimension that people use, for a message: `"kg", "g" or "lb"`.
[[nodiscard]] std::string units_like(std::string_view unit);

/// "a number, kg, > 0".
[[nodiscard]] std::string expected_number(const Dimension& dimension);
/// `a number, kg, > 0, or a string of a number and its unit: "kg", "g" or "lb"`.
[[nodiscard]] std::string expected_quantity(const Dimension& dimension);
/// "an array of 2 numbers, m"; any number of them without `size`.
[[nodiscard]] std::string expected_numbers(const Dimension& dimension, int size = 0);

} // namespace wingspread
