/// Reads and writes torques of springs and harnesses: two numbers, a table, or a torque test in both directions. Also
/// has the functions that readers of all tables share.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The words of `interpolation`, by Interpolation.
inline constexpr std::array<std::string_view, 2> interpolation_names{"monotone", "linear"};

inline constexpr std::size_t most_knots = 1000; ///< of a table; at least two

/// Whether `size` numbers can be a column of a table.
[[nodiscard]] constexpr bool can_be_knots(std::size_t size) {
  return size >= 2 && size <= most_knots;
}

/// "an array of 2 to 1000 numbers, rad": the expectation for a column of a table.
[[nodiscard]] std::string expected_column(std::string_view unit);

/// Reads a column as long as `knots`; returns false if it noted a problem.
bool read_column_beside(const JsonCursor& at, const std::vector<double>& knots,
                        std::string_view knots_name, const Dimension& dimension,
                        std::vector<double>& column);

/// Notes the first number that is not greater than the number before; returns false if there is one.
/// @param at     the array
/// @param column the array as read
/// @param what   one number in words: "time"
bool check_ascending(const JsonCursor& at, const std::vector<double>& column,
                     std::string_view what);

/// Whether a curve's coefficients are finite; they overflow if knots nearly coincide.
[[nodiscard]] bool is_finite(const Curve& curve);

/// The sense of a hinge's angle from stowed to latched.
enum class Way { unknown, up, down };

/// Reads a spring's torque. Only a spring may have a torque test in both directions (`measured`).
/// @param way required sense of a table's angles; `unknown` if the hinge's angles could not be read
void read_spring(const JsonCursor& at, Way way, HingeTorque& spring);
void read_harness(const JsonCursor& at, Way way, HingeTorque& harness);

[[nodiscard]] Json write_torque(const HingeTorque& torque);

} // namespace wingspread
