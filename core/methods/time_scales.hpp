/// Time scales of a wing's motion: they limit steps that the error estimate cannot, and inform the choice of `auto`.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/workspace.hpp"

#include <cmath>

namespace wingspread {

/// Frequency of the fastest motion at the step's start, 1/s: the largest ratio over all hinges. A hinge has the ratio
/// of acceleration to rate or, if larger and its latch is engaged, that of rate to distance from rest. In a swing about
/// an engaged latch one of the two is always at least the frequency; an elastic joint has only the first. A hinge
/// counts however slow it is beside others: an implicit step must resolve its swing to the tolerance. Hinges slower
/// than 100 times `still` do not count (heuristic: rounding and the rest of a mode that has died out would look like a
/// high frequency).
/// @param still rad/s: the rate that an explicit method leaves of a motion that has died out
/// @return 0 if no hinge counts
template <class T, class AnySystem>
[[nodiscard]] double highest_frequency(const AnySystem& system, const Step<T>& step,
                                       const T& still) {
  using std::abs;
  const Layout& at = system.layout();
  T swing(0);
  for (int i = 1; i <= at.bodies; ++i) {
    const LinearLaw<T>& law = system.work().laws[i];
    const T rate = abs(step.x[at.rate(i)]);
    if (rate < T(100) * still) continue;
    swing = larger(swing, T(abs(step.dxdt[at.rate(i)]) / rate));
    if (!system.work().engaged[i] || !(law.stiffness > T(0))) continue;
    const T way = step.x[at.angle(i)] - law.latched - law.drive / law.stiffness;
    if (way != T(0)) swing = larger(swing, T(rate / abs(way)));
  }
  return static_cast<double>(swing);
}

/// Time from the step's start in which no hinge turns by much more than a radian, s, at most `longest`.
/// Limits the first step: while accelerations are constant, error estimates vanish and would allow any step.
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

/// Time in which a base of prescribed motion turns by about 0.1 rad, s, at most `longest`. Limits steps
/// while hinges stick: the state may then be constant while the load on the hinges changes.
/// 0.1 rad is heuristic: the load is sampled some 60 times a turn. Larger: a release could be overlooked.
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
  return select(spin > T(0), smaller(longest, T(T(turn) / spin)), longest);
}

/// Largest angle whose sine is known well enough, rad: a double near 1e8 rounds by up to 7e-9 rad.
inline constexpr double largest_known_angle = 1e8;

/// Whether all angles are below largest_known_angle in magnitude; false with a NaN.
template <class T> [[nodiscard]] bool angles_are_known(const Layout& at, const State<T>& x) {
  using std::abs;
  for (int i = 1; i <= at.bodies; ++i)
    if (!(abs(x[at.angle(i)]) < T(largest_known_angle))) return false;
  return true;
}

} // namespace wingspread
