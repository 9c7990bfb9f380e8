/// Where real hinges pass the angles at which their laws change: a stop's contact, a damper's window, either side of
/// a latch's backlash, the latched angle of a latch with dissipation.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/instant.hpp"
#include "core/mechanics/system.hpp"

#include <optional>

namespace wingspread {

/// Calls visit(i, edge) for every edge that hinge i has in its present state.
template <class AnySystem, class Visit> void for_each_edge(const AnySystem& system, Visit&& visit) {
  const auto& wing = system.wing();
  for (int i = 1; i < static_cast<int>(wing.real.size()); ++i)
    for (int e = 0; e < edges_of_hinge; ++e) {
      const Edge edge = static_cast<Edge>(e);
      if (has_edge(wing, i, edge, system.work().engaged[i] != 0)) visit(i, edge);
    }
}

/// The direction in which hinge i will pass the edge next: 1 upwards, −1 downwards.
template <class AnySystem> [[nodiscard]] int way_over(const AnySystem& system, int i, Edge edge) {
  return system.work().above[i][static_cast<int>(edge)] != 0 ? -1 : 1;
}

/// The first s in [0, 1] at which hinge i reaches the edge from its present side; none if it does not. A step that
/// starts at the edge has just passed it or rests there: the root at s = 0 is divided out, up to three times. A hinge
/// that stays within rounding of the edge over the whole step does not pass it: it may lie unloaded on its stop.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_crossing(const AnySystem& system, const Step<T>& step, int i,
                                              Edge edge) {
  const Layout& at = system.layout();
  const T angle = edge_angle(system.wing(), i, edge), way(way_over(system, i, edge));
  Quintic<T> past = step.distance(at.angle(i), at.freedoms(), angle);
  for (T& c : past) c = way * c;
  using std::abs;
  if (!(bound(past) > T(32 * epsilon_of<T>) * (T(1) + abs(angle)))) return std::nullopt;
  if (step.x[at.angle(i)] != angle) return first_nonnegative(past);
  past = without_root_at_start(past);
  if (!(abs(past[0]) > T(vanishes_below) * bound(past))) past = divided_by_s(past);
  return bound(past) > T(0) ? first_nonnegative(past) : std::nullopt;
}

/// Puts hinge `due` exactly at its edge at the start of a step, and every hinge that reaches an edge simultaneously:
/// settle_edges then decides their sides together. A moment may jump at an edge (a damped latch with backlash, a
/// damper's window): of mirrored wings one would bear for an instant what two share.
template <class T, class AnySystem>
void meet_edges_simultaneous(const AnySystem& system, int due, Edge edge_due, Step<T>& step) {
  const Layout& at = system.layout();
  int met = 0; // the last hinge put at an edge beside the one that is due
  for_each_edge(system, [&](int i, Edge edge) {
    if (system.is_locked(i) || (i == due && edge != edge_due)) return;
    using std::abs;
    const T there = edge_angle(system.wing(), i, edge), way(way_over(system, i, edge));
    T& angle = step.x[at.angle(i)];
    if (i != due) {
      const T along = way * step.x[at.rate(i)];
      if (!(abs(angle - there) < one_instant_of_latches(step.t) * along)) return;
      if (met == i && !(way * (there - angle) < T(0))) return; // it reaches its other edge first
      met = i;
    }
    angle = there;
  });
}

/// Sets the side of every hinge that stands exactly at an edge, by its rate or, at rest, its acceleration.
/// @return whether any side has changed
template <class T, class AnySystem>
bool settle_edges(AnySystem& system, const State<T>& x, const State<T>& dxdt) {
  const Layout& at = system.layout();
  bool changed = false;
  for_each_edge(system, [&](int i, Edge edge) {
    if (x[at.angle(i)] != edge_angle(system.wing(), i, edge)) return;
    const T& rate = x[at.rate(i)];
    const T& going = rate != T(0) ? rate : dxdt[at.rate(i)];
    const int way = way_over(system, i, edge);
    if (!(T(way) * going > T(0))) return;
    system.note_crossing(i, edge, way > 0);
    changed = true;
  });
  return changed;
}

} // namespace wingspread
