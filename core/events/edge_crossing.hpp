/// Where real hinges pass the angles at which their laws change: a stop's contact, a damper's window, either side of
/// a latch's backlash, the latched angle of a latch with dissipation.
#pragma once

#include "core/dense/step.hpp"
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
/// starts at the edge has just passed it or rests there: the root at s = 0 is divided out, up to three times.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_crossing(const AnySystem& system, const Step<T>& step, int i,
                                              Edge edge) {
  const Layout& at = system.layout();
  const T angle = edge_angle(system.wing(), i, edge), way(way_over(system, i, edge));
  Quintic<T> past = step.distance(at.angle(i), at.freedoms(), angle);
  for (T& c : past) c = way * c;
  if (step.x[at.angle(i)] != angle) return first_nonnegative(past);
  past = without_root_at_start(past);
  using std::abs;
  if (!(abs(past[0]) > T(vanishes_below) * bound(past))) past = divided_by_s(past);
  return bound(past) > T(0) ? first_nonnegative(past) : std::nullopt;
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
