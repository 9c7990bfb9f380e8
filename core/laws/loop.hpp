/// A synchronisation loop: a closed cable that ties one hinge's travel to a function of another's.
///
/// | symbol   | meaning                                                     | unit   |
/// |----------|-------------------------------------------------------------|--------|
/// | x_a, x_b | travel of its hinges, s (φ − φ_stowed)                      | rad    |
/// | g        | the gear: ratio·x_a, or a table                             | rad    |
/// | e        | g(x_a) − x_b                                                | rad    |
/// | K, D     | stiffness and damping along x_b                             | N·m/rad, N·m·s/rad |
/// | M_p      | preload: a strand is slack where K abs(e) > 2 M_p           | N·m    |
///
///     τ = K e + D ė,    with a slack strand ½ K e + M_p sign e + ½ D ė                          (1)
///     hinge b: M = s_b τ        hinge a: M = −s_a g'(x_a) τ                                     (2)
///     P = ½ K e²,       with a slack strand ½ K e² − (K |e| − 2 M_p)²/(4 K)                     (3)
///
/// With |ẋ|, |ẍ|, |x⃛| of hinges a and b bounded by a₁, a₂, a₃ and b₁, b₂, b₃ over a step, and the first three
/// derivatives of g by G, G₂, G₃:
///
///     |ė| ≤ G a₁ + b₁    |ë| ≤ G a₂ + G₂ a₁² + b₂    |e⃛| ≤ G a₃ + 3 G₂ a₁ a₂ + G₃ a₁³ + b₃        (4)
///     |τ| ≤ K |e| + D |ė|      |τ̇| ≤ K |ė| + D |ë|      |τ̈| ≤ K |ë| + D |e⃛|                      (5)
#pragma once

#include "core/laws/curve_value.hpp"
#include "core/number/derivative_bounds.hpp"

#include <array>

namespace wingspread {

inline constexpr double never_slack = 1e300; ///< N·m

template <class T> struct LoopTerms {
  int first, second;  ///< bodies of the hinges a and b
  const Curve* table; ///< g; null: ratio·x
  T ratio;
  T stiffness, damping;
  T slack_beyond;       ///< 2 M_p, or never_slack
  T stowed_a, stowed_b; ///< rad
  T sense_a, sense_b;
};

/// A loop at one instant.
template <class T> struct LoopState {
  T elastic; ///< K e, N·m
  T viscous; ///< D ė, N·m
  T gear;    ///< g'(x_a)
};

template <class T>
[[nodiscard]] LoopState<T> loop_state(const LoopTerms<T>& loop, const T& angle_a, const T& rate_a,
                                      const T& angle_b, const T& rate_b) {
  const T x = loop.sense_a * (angle_a - loop.stowed_a);
  const T y = loop.sense_b * (angle_b - loop.stowed_b);
  T given = loop.ratio * x, gear = loop.ratio;
  if (loop.table) {
    const PieceAt<T> piece = piece_at(*loop.table, x);
    given = value(piece), gear = slope(piece);
  }
  const T e_rate = fused(gear, T(loop.sense_a * rate_a), T(-(loop.sense_b * rate_b)));
  return {loop.stiffness * (given - y), loop.damping * e_rate, gear};
}

/// The elastic part of (1), N·m. @param elastic K e
template <class T> [[nodiscard]] T carried_by_strands(const LoopTerms<T>& loop, const T& elastic) {
  using std::abs;
  const T rest = T(0.5) * larger(T(abs(elastic) - loop.slack_beyond), T(0));
  return elastic - select(elastic > T(0), rest, T(-rest));
}

/// The share of K and D that acts: ½ with a slack strand, else 1.
template <class T> [[nodiscard]] T taut_share(const LoopTerms<T>& loop, const T& elastic) {
  using std::abs;
  return select(abs(elastic) > loop.slack_beyond, T(0.5), T(1));
}

/// Whether τ jumps where a strand goes slack.
template <class T> [[nodiscard]] Truth<T> jumps(const LoopTerms<T>& loop) {
  return loop.damping > T(0) && loop.stiffness > T(0) && loop.slack_beyond < T(never_slack);
}

/// τ of (1), N·m.
template <class T> [[nodiscard]] T loop_torque(const LoopTerms<T>& loop, const LoopState<T>& at) {
  return fused(taut_share(loop, at.elastic), at.viscous, carried_by_strands(loop, at.elastic));
}

/// (2) for τ = 1.
template <class T> [[nodiscard]] T on_first(const LoopTerms<T>& loop, const T& gear) {
  return -loop.sense_a * gear;
}
template <class T> [[nodiscard]] T on_second(const LoopTerms<T>& loop) { return loop.sense_b; }

/// (3), J. @param elastic K e
template <class T> [[nodiscard]] T loop_energy(const LoopTerms<T>& loop, const T& elastic) {
  using std::abs;
  if (!(loop.stiffness > T(0))) return T(0);
  const T size = abs(elastic), slack = larger(T(size - loop.slack_beyond), T(0));
  return (T(0.5) * size * size - T(0.25) * slack * slack) / loop.stiffness;
}

/// Whether hinge i is one of the loop's two hinges.
template <class T> [[nodiscard]] bool joins(const LoopTerms<T>& loop, int i) {
  return loop.first == i || loop.second == i;
}

/// (2) for τ = 1 at hinge i, one of the loop's two.
template <class T> [[nodiscard]] T on_hinge(const LoopTerms<T>& loop, int i, const T& gear) {
  return loop.first == i ? on_first(loop, gear) : on_second(loop);
}

/// τ̇, N·m/s; neglects the second derivative of g. @param rates, accelerations of the hinges a and b
template <class T>
[[nodiscard]] T loop_torque_rate(const LoopTerms<T>& loop, const LoopState<T>& at,
                                 const std::array<T, 2>& rates,
                                 const std::array<T, 2>& accelerations) {
  const T a = loop.sense_a * at.gear, b = loop.sense_b;
  const T e1 = a * rates[0] - b * rates[1];
  const T e2 = a * accelerations[0] - b * accelerations[1];
  return taut_share(loop, at.elastic) * fused(loop.stiffness, e1, loop.damping * e2);
}

// ---- over a step of h, in which the hinges a and b move by two quintics, at the rates va and vb

/// A range of (2) at hinge i, N·m. K e and D ė are polynomials of time if g is replaced by its tangent at the step's
/// start. That neglects at most half of g's largest second derivative times the square of the travel of hinge a.
template <class T>
[[nodiscard]] ValueRange<T> loop_moment_range(const LoopTerms<T>& loop, int i, const Quintic<T>& a,
                                              const Quintic<T>& va, const Quintic<T>& b,
                                              const Quintic<T>& vb) {
  using std::abs;
  const LoopState<T> start = loop_state(loop, a[0], va[0], b[0], vb[0]);
  const T on_a = loop.sense_a * start.gear;
  Quintic<T> elastic, viscous;
  for (int k = 0; k < 6; ++k) {
    elastic[k] =
        fused(loop.stiffness, on_a * (a[k] - a[0]) - loop.sense_b * (b[k] - b[0]), start.elastic);
    viscous[k] = loop.damping * (on_a * va[k] - loop.sense_b * vb[k]);
  }
  ValueRange<T> carried = hull(elastic), damped = hull(viscous);
  T gear = abs(start.gear);
  if (loop.table) {
    const ValueRange<T> way = hull(a);
    const T longest = way.high - way.low, fastest = largest_magnitude_of(hull(va));
    const T bend(loop.table->sharpest_bend()), turns = bend * longest;
    const T off = loop.stiffness * T(0.5) * turns * longest;
    carried = {carried.low - off, carried.high + off};
    damped = {damped.low - loop.damping * turns * fastest,
              damped.high + loop.damping * turns * fastest};
    gear = gear + turns;
  }
  damped.include(T(0)); // a slack strand halves D ė
  const ValueRange<T> torque{carried_by_strands(loop, carried.low) + damped.low,
                             carried_by_strands(loop, carried.high) + damped.high};
  if (loop.second == i) return scaled(loop.sense_b, torque);
  const T most = gear * largest_magnitude_of(torque);
  return {-most, most};
}

/// A range of dM/dt of (2) at hinge i; unknown where a strand may go slack, and with a table.
template <class T>
[[nodiscard]] KnownRange<T> loop_moment_change(const LoopTerms<T>& loop, int i, const Quintic<T>& a,
                                               const Quintic<T>& b, const T& h) {
  KnownRange<T> change;
  change.known = T(0) < T(0);
  if (loop.table) return change;
  Quintic<T> elastic;
  for (int k = 0; k < 6; ++k)
    elastic[k] = loop_state(loop, a[k], T(0), b[k], T(0)).elastic; // K e is a polynomial too
  const ValueRange<T> carried = hull(elastic);
  const auto has_stiffness = loop.stiffness > T(0);
  change.known = carried.high <= loop.slack_beyond && carried.low >= -loop.slack_beyond &&
                 (has_stiffness || !(loop.damping > T(0)));
  const Quintic<T> rise = derivative(elastic, h), bend = derivative(rise, h);
  const T time = select(has_stiffness, T(loop.damping / loop.stiffness), T(0));
  Quintic<T> rate;
  for (int k = 0; k < 6; ++k) rate[k] = fused(time, bend[k], rise[k]);
  change.range = scaled(on_hinge(loop, i, T(loop.ratio)), hull(rate));
  return change;
}

/// Bounds of the first three derivatives of g over a range of travel.
template <class T> struct GearBounds {
  T first, second, third;
  Truth<T> smooth; ///< g is one polynomial there; else `third` is 0 and bounds nothing
};

/// The largest |dg/dx_a|.
template <class T> [[nodiscard]] T largest_gear(const LoopTerms<T>& loop) {
  using std::abs;
  return loop.table ? larger(T(abs(T(loop.table->steepest_rise()))),
                             T(abs(T(loop.table->steepest_fall()))))
                    : T(abs(loop.ratio));
}

template <class T>
[[nodiscard]] GearBounds<T> gear_bounds(const LoopTerms<T>& loop, const ValueRange<T>& travel) {
  using std::abs;
  if (!loop.table) return {abs(loop.ratio), T(0), T(0), T(0) <= T(0)};
  const Truth<T> smooth = detail::is_one_piece(*loop.table, travel);
  const PieceAt<T> piece = piece_at(*loop.table, travel.low);
  const T way = travel.high - travel.low;
  const T bend = abs(fused(T(6) * piece.c[3], piece.u, T(2) * piece.c[2]));
  const T third = abs(T(6) * piece.c[3]), second = fused(third, way, bend);
  return {select(smooth, fused(second, way, T(abs(slope(piece)))), largest_gear(loop)),
          select(smooth, second, T(loop.table->sharpest_bend())), select(smooth, third, T(0)),
          smooth};
}

/// Bounds of τ, of the gear dg/dx_a, and of their derivatives by time.
template <class T> struct LoopTorqueBounds {
  T torque, first, second;         ///< N·m, N·m/s, N·m/s²; `second` only where smooth
  T gear, gear_first, gear_second; ///< 1, 1/s, 1/s²; `gear_second` only where smooth
  T drop;                          ///< jump of τ where a strand goes slack, N·m
  Truth<T> smooth;                 ///< no strand goes slack and no knot of the table is passed
};

/// (4) and (5) over a step.
template <class T>
[[nodiscard]] LoopTorqueBounds<T> loop_torque_bounds(const LoopTerms<T>& loop, const Quintic<T>& a,
                                                     const Quintic<T>& b, const T& h) {
  using std::abs;
  const DifferenceScale<T> scale(h);
  const DerivativeBounds<T> x = derivative_bounds_beyond_rounding(a, scale),
                            y = derivative_bounds_beyond_rounding(b, scale);
  const ValueRange<T> at = hull(a);
  const GearBounds<T> g = gear_bounds(
      loop, scaled(loop.sense_a, ValueRange<T>{at.low - loop.stowed_a, at.high - loop.stowed_a}));
  const T e1 = fused(g.first, x.first, y.first);
  const T e2 = fused(g.first, x.second, fused(g.second, x.first * x.first, y.second));
  const T e3 = fused(g.first, x.third, y.third) +
               x.first * fused(T(3) * g.second, x.second, g.third * x.first * x.first);
  const T start = abs(loop_state(loop, a[0], T(0), b[0], T(0)).elastic);
  const T most = start + loop.stiffness * e1 * h; // K |e|
  const Truth<T> may_slacken =
      most > loop.slack_beyond && start - (most - start) < loop.slack_beyond;
  return {most + loop.damping * e1,
          loop.stiffness * e1 + loop.damping * e2,
          loop.stiffness * e2 + loop.damping * e3,
          g.first,
          g.second * x.first,
          fused(g.second, x.second, g.third * x.first * x.first),
          select(may_slacken, T(T(0.5) * loop.damping * e1), T(0)),
          g.smooth && !may_slacken};
}

} // namespace wingspread
