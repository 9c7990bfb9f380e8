/// Edges: angles at which a real hinge's law changes. The run's state has the hinge's side of each edge.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/mechanics/workspace.hpp"

#include <optional>

namespace wingspread {

/// Angle of this edge of hinge i, rad. @pre wing.real is not empty
template <class T> [[nodiscard]] T edge_angle(const Wing<T>& wing, int i, Edge edge) {
  const RealHingeTerms<T>& real = wing.real[i];
  switch (edge) {
  case Edge::stop:
    return real.stop.contact_angle;
  case Edge::window_low:
    return real.window_low;
  case Edge::window_high:
    return real.window_high;
  case Edge::backlash_low:
    return wing.hinges[i].latched - real.half_backlash;
  case Edge::far_stop:
    return real.far_stop.contact_angle;
  case Edge::pass:
    return wing.hinges[i].latched;
  case Edge::backlash_high:
    break;
  }
  return wing.hinges[i].latched + real.half_backlash;
}

/// Whether the hinge has that edge now. @param engaged whether its latch has engaged
template <class T>
[[nodiscard]] bool has_edge(const Wing<T>& wing, int i, Edge edge, bool engaged) {
  const RealHingeTerms<T>& real = wing.real[i];
  if (edge == Edge::stop) return real.stop.present;
  if (edge == Edge::far_stop) return real.far_stop.present;
  if (edge == Edge::pass) return !engaged && real.capture.present;
  if (edge == Edge::window_low || edge == Edge::window_high) return real.has_window;
  if (edge == Edge::backlash_low) return engaged && real.has_backlash;
  return engaged && real.has_latch_edge();
}

/// Whether hinge i has a latch that may miss (the hinge passes too fast) or that may let go.
template <class T> [[nodiscard]] bool has_capture(const Wing<T>& wing, int i) {
  return !wing.real.empty() && wing.real[i].capture.present;
}

/// Whether one of the hinge's laws changes exactly where its latch engages: the latch's own dissipation, an end of the
/// damper's window, a stop without gap.
template <class T> [[nodiscard]] bool has_edge_at_latch(const Wing<T>& wing, int i) {
  if (wing.real.empty()) return false;
  for (int e = 0; e < edges_of_hinge; ++e) {
    const Edge edge = static_cast<Edge>(e);
    if (has_edge(wing, i, edge, true) && edge_angle(wing, i, edge) == wing.hinges[i].latched)
      return true;
  }
  return false;
}

/// Whether a stop is in contact, by the side of its edge.
template <class T> [[nodiscard]] bool touches(const StopTerms<T>& stop, bool above) {
  return stop.present && above != (stop.sense > T(0));
}

/// The side on which an engaged latch bears: 1 above the latched angle, −1 below, 0 inside its backlash.
template <class T, class Sides>
[[nodiscard]] int bearing_side(const RealHingeTerms<T>& real, const Sides& sides) {
  if (sides[static_cast<int>(Edge::backlash_high)] != 0) return 1;
  return real.has_backlash && sides[static_cast<int>(Edge::backlash_low)] != 0 ? 0 : -1;
}

/// The mode of hinge i from the sides of its edges and the state of its friction.
/// @param engaged whether it has an event latch that has engaged
template <class T, class Sides>
[[nodiscard]] HingeMode<T> mode_of(const Wing<T>& wing, int i, const Sides& sides, Contact contact,
                                   bool engaged) {
  const auto above = [&](Edge edge) { return sides[static_cast<int>(edge)] != 0; };
  const bool acts =
      !wing.real[i].has_window || (above(Edge::window_low) && !above(Edge::window_high));
  const auto in_contact = [&](const StopTerms<T>& stop, Edge edge) {
    return T(touches(stop, above(edge)) ? 1 : 0);
  };
  return {in_contact(wing.real[i].stop, Edge::stop), T(acts ? 1 : 0), T(sense_of(contact)),
          T(engaged ? bearing_side(wing.real[i], sides) : 0),
          in_contact(wing.real[i].far_stop, Edge::far_stop)};
}

/// The angle at which an engaged latch bears, less the latched angle: −β/2 or β/2, rad; 0 without backlash; none inside
/// the backlash, where it bears on neither side.
template <class T, class Sides>
[[nodiscard]] std::optional<T> side_of_backlash(const RealHingeTerms<T>& real, const Sides& sides) {
  if (!real.has_backlash) return T(0);
  const int side = bearing_side(real, sides);
  return side == 0 ? std::nullopt : std::optional<T>(T(side) * real.half_backlash);
}

} // namespace wingspread
