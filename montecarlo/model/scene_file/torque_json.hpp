/// Torques of springs and harnesses from JSON and back: by two numbers, by a table, by a torque test both ways.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The words for each way of interpolation, in the order of its values.
inline constexpr std::array<std::string_view, 2> interpolation_names{"monotone", "linear"};

inline constexpr std::size_t most_knots = 1000; ///< of a table; at least two

/// Whether `size` numbers can be a column of a table.
[[nodiscard]] constexpr bool can_be_knots(std::size_t size) {
  return size >= 2 && size <= most_knots;
}

/// What a column of a table has to be: "an array of 2 to 1000 numbers, rad".
[[nodiscard]] std::string expected_column(std::string_view unit);

/// Reads `at` into a column with as many numbers as `knots` has; notes a problem and returns false when it is
/// none.
bool read_column_beside(const JsonCursor& at, const std::vector<double>& knots,
                        std::string_view knots_name, const Dimension& dimension,
                        std::vector<double>& column);

/// Whether a curve's coefficients are numbers; not so where knots all but coincide.
[[nodiscard]] bool is_finite(const Curve& curve);

/// A hinge's way: the sense in which its angle grows from stowed to latched.
enum class Way { unknown, up, down };

/// Reads a spring, which a torque test both ways may stand for, or a harness.
/// @param way that a table's angles have to run; `unknown` when the hinge's own could not be read
void read_spring(const JsonCursor& at, Way way, HingeTorque& spring);
void read_harness(const JsonCursor& at, Way way, HingeTorque& harness);

[[nodiscard]] Json write_torque(const HingeTorque& torque);

} // namespace wingspread
