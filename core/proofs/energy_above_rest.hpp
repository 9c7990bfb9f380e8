/// How much energy a wing has left after its last latch.
#pragma once

#include "core/mechanics/energy.hpp"

#include <optional>

namespace wingspread {

/// Energy above rest, E of peak_bounds.hpp. None where that proof does not apply: a base that is
/// driven, a hinge without an engaged latch, or a latch softer than its spring is steep.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] std::optional<T> energy_above_rest(System<T, Topology, M>& system, const State<T>& x,
                                                 const T& t) {
  if constexpr (M == BaseMotion::prescribed) return std::nullopt;
  const Layout& at = system.layout();
  T energy(0);
  for (int i = 1; i <= at.bodies; ++i) {
    const LinearLaw<T> law = linear_law(system.wing().hinges[i], true);
    const bool holds = system.wing().hinges[i].has_latch && system.work().engaged[i] &&
                       law.stiffness > T(0) && (!at.smoothed || x[at.latch(i)] >= system.epsilon());
    if (!holds) return std::nullopt;
    const T y = x[at.angle(i)] - law.latched - law.drive / law.stiffness;
    energy = energy + T(0.5) * law.stiffness * y * y;
  }
  const TotalMotion<T> now = total_motion(system, x, t);
  energy = energy + (M == BaseMotion::free ? now.central_kinetic() : now.kinetic);
  return energy + T(64 * epsilon_of<T>) * now.kinetic; // what the difference may have lost
}

} // namespace wingspread
