/// The least quotient of two cubics, and the least value of one.
///
/// Along one piece of a table, torques are cubics of the travel, and so are T and what a standard asks of it. Of quotients
/// T/R at places of the piece, none needs to be near the least one: where a spring and a harness both fall towards 0,
/// eight places in a piece missed the least of T/R by 7 %, and a verdict passed at a margin of −0.06. So it is computed.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace wingspread {

/// Where a Cubic is sampled: inside the part, because at a place between two parts a damper's torque may jump.
inline constexpr std::array<double, 4> cubic_samples{0.125, 0.375, 0.625, 0.875};

/// c_0 + c_1 u + c_2 u² + c_3 u³ over a part of the travel, u = 0 … 1.
class Cubic {
public:
  /// The cubic with these values at cubic_samples.
  [[nodiscard]] static Cubic through(const std::array<double, 4>& values);

  [[nodiscard]] double operator()(double u) const {
    return c_[0] + u * (c_[1] + u * (c_[2] + u * c_[3]));
  }
  /// The u in [0, 1] of its least value.
  [[nodiscard]] double place_of_least() const;
  /// This − factor · other.
  [[nodiscard]] Cubic less(double factor, const Cubic& other) const;

private:
  std::array<double, 4> c_{};
};

/// The u in [0, 1] at which over/under is least, if it is less than `quotient` there.
///
/// The cubic over − q · under is least at some u. If it is negative there, over/under is less than q at u, and replaces q;
/// else q is the least quotient [Dinkelbach 1967: the q fall to it superlinearly].
/// @param quotient attained somewhere, or more @pre under ≥ 0
[[nodiscard]] std::optional<double> place_of_least_quotient(const Cubic& over, const Cubic& under,
                                                            double quotient);

} // namespace wingspread
