/// Overtravel: how far a hinge turns beyond its stowed angle, away from the latched one.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/system.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// −travel of hinge i at an angle, rad: > 0 beyond the stowed angle.
template <class T> [[nodiscard]] T beyond_stowed(const HingeTerms<T>& hinge, const T& angle) {
  return hinge.sense * (hinge.stowed - angle);
}

/// Whether hinge i may turn back inside the step with an overtravel above `most`. If not, the step's ends have its
/// largest overtravel, or it stays below `most`. It may begin the step at rest. For packs: in which lanes.
template <class T>
[[nodiscard]] auto may_turn_back(const Wing<T>& wing, const Layout& at, const Step<T>& step, int i,
                                 const T& most) {
  const HingeTerms<T>& hinge = wing.hinges[i];
  const T before = hinge.sense * step.x[at.rate(i)], after = hinge.sense * step.x1[at.rate(i)];
  const auto turns = before <= T(0) && after >= T(0);
  if (!any(turns)) return turns;
  T furthest = most;
  for (const T& c : step.coordinate(at.angle(i), at.freedoms()))
    furthest = larger(furthest, beyond_stowed(hinge, c));
  return turns && furthest > most;
}

/// Raises `most` to the largest overtravel of hinge i over the step.
template <class T>
void raise_overtravel(T& most, const Wing<T>& wing, const Layout& at, const Step<T>& step, int i) {
  const HingeTerms<T>& hinge = wing.hinges[i];
  if (may_turn_back(wing, at, step, i, most)) {
    const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
    Quintic<T> rate = step.rate(at.angle(i), at.freedoms());
    for (T& c : rate) c = hinge.sense * c;
    if (rate[0] == T(0)) rate = without_root_at_start(rate); // it set out from rest
    if (const std::optional<T> s = first_nonnegative(rate))
      most = larger(most, beyond_stowed(hinge, value(angle, *s)));
  }
  most = larger(most, beyond_stowed(hinge, step.x1[at.angle(i)]));
}

} // namespace wingspread
