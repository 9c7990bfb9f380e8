/// Where a step of the series method must end because a hinge turns back.
///
/// The series method takes steps whose interpolant is less accurate than their ends. A hinge that turns back near an
/// angle that it barely passes or misses needs a step that ends there.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/wing.hpp"

#include <optional>

namespace wingspread {

/// Whether hinge i turns back inside the step near its stowed angle (moving away from the latch), or near its latched
/// angle if its latch is open. Near: within one step's travel, on either side.
/// @param waits whether the latch of hinge i is open; for a pack: in which lanes
template <class T, class Mask>
[[nodiscard]] auto turns_near_an_end(const Wing<T>& wing, const Layout& at, const Step<T>& step,
                                     int i, const Mask& waits) {
  const HingeTerms<T>& hinge = wing.hinges[i];
  const T before = hinge.sense * step.x[at.rate(i)], after = hinge.sense * step.x1[at.rate(i)];
  const auto turns = before * after < T(0);
  if (!any(turns)) return turns;
  const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
  T least = hinge.sense * (angle[0] - hinge.stowed), most = least; // travel
  for (const T& c : angle) {
    const T travel = hinge.sense * (c - hinge.stowed);
    least = smaller(least, travel), most = larger(most, travel);
  }
  const T way = most - least, whole = hinge.sense * (hinge.latched - hinge.stowed);
  const auto at_stowed = before < T(0) && least < way;
  const auto at_latched = before > T(0) && most > whole - way;
  return turns && (at_stowed || (at_latched && waits));
}

/// The fraction of the step at which hinge i turns back; none within 1e-3 of an end, where the interpolant is
/// accurate (its error grows as the cube of the distance). Heuristic: larger loses overtravel, smaller adds steps.
template <class T>
[[nodiscard]] std::optional<T> turning_point(const Layout& at, const Step<T>& step, int i) {
  constexpr double beside_an_end = 1e-3; // fraction of the step
  Quintic<T> rate = step.rate(at.angle(i), at.freedoms());
  if (step.x[at.rate(i)] > T(0))
    for (T& c : rate) c = -c;
  const std::optional<T> s = first_nonnegative(rate);
  return s && *s > T(beside_an_end) && *s < T(1 - beside_an_end) ? s : std::nullopt;
}

} // namespace wingspread
