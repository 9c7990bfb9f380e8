/// How quickly a wing moves: what bounds a step where no error would, and tells methods apart.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/workspace.hpp"

#include <cmath>

namespace wingspread {

/// The frequency of what still moves at the step's start, 1/s: largest acceleration over largest
/// rate or, if larger, the rate of a latched hinge over its way from rest; in a swing one of the
/// two is always as large as its frequency. Swings a thousand times slower than the fastest hinge
/// do not count.
template <class T, class AnySystem>
[[nodiscard]] double quickness(const AnySystem& system, const Step<T>& step) {
  using std::abs;
  const Layout& at = system.layout();
  T fastest(0), acceleration(0), swing(0);
  for (int i = 1; i <= at.bodies; ++i) {
    fastest = larger(fastest, T(abs(step.x[at.rate(i)])));
    acceleration = larger(acceleration, T(abs(step.dxdt[at.rate(i)])));
  }
  if (!(fastest > T(0))) return 0;
  for (int i = 1; i <= at.bodies; ++i) {
    const LinearLaw<T>& law = system.work().laws[i];
    const T rate = abs(step.x[at.rate(i)]);
    if (!system.work().engaged[i] || !(law.stiffness > T(0)) || rate < T(1e-3) * fastest) continue;
    const T way = step.x[at.angle(i)] - law.latched - law.drive / law.stiffness;
    if (way != T(0)) swing = larger(swing, T(rate / abs(way)));
  }
  return static_cast<double>(larger(swing, T(acceleration / fastest)));
}

/// A time from the step's start in which no hinge turns by much more than a radian, s, at most
/// `longest`: where a motion is a parabola no error would keep the first step from leaping over it.
template <class T>
[[nodiscard]] T time_to_a_radian(const Layout& at, const Step<T>& step, T longest) {
  using std::abs, std::sqrt;
  for (int i = 1; i <= at.bodies; ++i) {
    const T rate = abs(step.dxdt[at.angle(i)]), acceleration = abs(step.dxdt[at.rate(i)]);
    if (rate > T(0)) longest = smaller(longest, T(T(1) / rate));
    if (acceleration > T(0)) longest = smaller(longest, T(sqrt(T(2) / acceleration)));
  }
  return longest;
}

/// A time in which a base of prescribed motion turns by about 0.1 rad, s, at most `longest`: while
/// hinges stick nothing need change in the state, and the load on them is to be sampled.
template <class T>
[[nodiscard]] T time_of_base(const BaseTerms<T>& base, const DrivenPiece<T>& piece, const T& t,
                             const T& longest) {
  using std::abs, std::sqrt;
  constexpr double turn = 0.1; // rad
  T rate = abs(base.rate + base.angular_acceleration * t);
  T acceleration = abs(base.angular_acceleration);
  if (base.table) {
    rate = abs(turning(piece, t).rate);
    acceleration = cubic_bounds(shifted(piece.turning, T(t - piece.from)), longest).value;
  }
  const T spin = larger(rate, T(sqrt(T(turn) * acceleration)));
  return spin > T(0) ? smaller(longest, T(T(turn) / spin)) : longest;
}

/// Whether a double can tell the sines of all angles to the accuracy that is promised.
template <class T> [[nodiscard]] bool angles_are_known(const Layout& at, const State<T>& x) {
  using std::abs;
  constexpr double largest = 1e8; // rad
  for (int i = 1; i <= at.bodies; ++i)
    if (!(abs(x[at.angle(i)]) < T(largest))) return false;
  return true;
}

} // namespace wingspread
