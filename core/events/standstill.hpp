/// When no hinge moves any more: all stick, under loads that are constant.
#pragma once

#include "core/mechanics/system.hpp"

namespace wingspread {

namespace detail {

/// Whether the air's flow past a wing whose hinges all stick is constant.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] bool flow_is_constant(const System<T, Topology, M>& system, const State<T>& x) {
  if constexpr (M == BaseMotion::fixed) return true;
  if constexpr (M == BaseMotion::free) return false;
  const T from =
      system.work()
          .driven.from; // of the present piece: where the base only turns, v is the same everywhere
  const Drive<T> base = system.drive(from);
  const Vec2<T> push = base.felt + system.wing().base.gravity, v = system.base_velocity(x, from);
  const bool drifts = push.x != T(0) || push.y != T(0);
  return !drifts && (base.rate == T(0) || (v.x == T(0) && v.y == T(0)));
}

/// Whether the weight of a smoothed latch still rises.
template <class AnySystem, class T>
[[nodiscard]] bool latches_come_in(const AnySystem& system, const State<T>& x) {
  const Layout& at = system.layout();
  for (int i = 1; at.smoothed && i <= at.bodies; ++i)
    if (system.wing().hinges[i].has_latch && x[at.latch(i)] < system.epsilon() &&
        engagement_rate(system.wing().hinges[i], x[at.angle(i)], system.epsilon()) > T(0))
      return true;
  return false;
}

} // namespace detail

/// Whether a wing whose hinges all stick is loaded by constants: no motor's command changes, no smoothed latch comes
/// in, and the base is fixed, free and without plates, driven without rotation, or rotates about a point at rest at a
/// constant rate. On a driven base, plates need a constant flow too.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] bool loads_are_constant(const System<T, Topology, M>& system, const State<T>& x) {
  const Wing<T>& wing = system.wing();
  if (detail::latches_come_in(system, x)) return false;
  if (M == BaseMotion::prescribed && !system.drive_is_steady()) return false;
  if (!system.motors_are_steady()) return false;
  if (!wing.plates.empty() && !detail::flow_is_constant(system, x)) return false;
  if (M != BaseMotion::prescribed) return true;
  const Drive<T> base = system.drive(system.work().driven.from); // as at any other time
  const bool pushed = base.felt.x != T(0) || base.felt.y != T(0);
  return base.rate == T(0) || !pushed;
}

/// Whether every hinge sticks under loads that are constant: no hinge moves any more.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] bool is_stuck_for_good(const System<T, Topology, M>& system, const State<T>& x) {
  return system.work().locked >= system.layout().bodies && loads_are_constant(system, x);
}

} // namespace wingspread
