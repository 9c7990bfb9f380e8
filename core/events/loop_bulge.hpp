/// How far a loop's moments may leave their chords inside a step.
///
/// A smooth function leaves its chord by at most chord_excess(h) times its second derivative. A moment with a
/// kink or a jump lies above its larger end by at most half its first derivative times the interval, plus the
/// jump. A loop has a kink where a strand goes slack or hinge a passes a knot of the table; a strand that goes
/// slack drops half of D ė. Symbols, and the bounds of τ and its derivatives: core/laws/loop.hpp, (4) and (5).
#pragma once

#include "core/dense/curved_search.hpp"
#include "core/laws/loop.hpp"

namespace wingspread {

/// Excesses of the moments at the loop's two hinges.
template <class T> struct LoopBulges { Bulge<T> first, second; };

/// Over a step of h. @param a, b angles of the loop's hinges
template <class T>
[[nodiscard]] LoopBulges<T> loop_bulges(const LoopTerms<T>& loop, const Quintic<T>& a,
                                        const Quintic<T>& b, const T& h) {
  const LoopTorqueBounds<T> tau = loop_torque_bounds(loop, a, b, h);
  const T bend = chord_excess(h), lean = T(0.5) * h;
  const T of_first = fused(tau.gear, tau.second,
                           fused(T(2) * tau.gear_first, tau.first, tau.gear_second * tau.torque));
  const T lean_of_first = lean * fused(tau.gear, tau.first, tau.gear_first * tau.torque);
  const auto smooth = [&](const T& value) { return select(tau.smooth, value, T(0)); };
  const auto kinked = [&](const T& value) { return select(tau.smooth, T(0), value); };
  return {{smooth(bend * of_first), kinked(lean_of_first), kinked(tau.gear * tau.drop)},
          {smooth(bend * tau.second), kinked(lean * tau.first), kinked(tau.drop)}};
}

} // namespace wingspread
