/// Edges: angles at which a real hinge's law changes. A run keeps on which side of each edge the hinge is.
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
  if (edge == Edge::window_low || edge == Edge::window_high) return real.has_window;
  if (edge == Edge::backlash_low) return engaged && real.has_backlash;
  return engaged && real.has_latch_edge();
}

/// Whether the law of the hinge's latch changes where it engages.
template <class T> [[nodiscard]] bool has_edge_at_latch(const Wing<T>& wing, int i) {
  return !wing.real.empty() && wing.real[i].dissipation.present && !wing.real[i].has_backlash;
}

/// Whether the stop is in contact, by the side of its edge.
template <class T> [[nodiscard]] bool touches_stop(const Wing<T>& wing, int i, bool above) {
  const StopTerms<T>& stop = wing.real[i].stop;
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
  return {T(touches_stop(wing, i, above(Edge::stop)) ? 1 : 0), T(acts ? 1 : 0),
          contact == Contact::stuck ? T(0) : T(static_cast<int>(contact)),
          T(engaged ? bearing_side(wing.real[i], sides) : 0)};
}

/// Where an engaged latch bears, less the latched angle: −β/2 or β/2, rad; 0 without backlash; none inside it.
template <class T, class Sides>
[[nodiscard]] std::optional<T> side_of_backlash(const RealHingeTerms<T>& real, const Sides& sides) {
  if (!real.has_backlash) return T(0);
  const int side = bearing_side(real, sides);
  return side == 0 ? std::nullopt : std::optional<T>(T(side) * real.half_backlash);
}

} // namespace wingspread
