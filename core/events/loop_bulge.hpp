/// How far a loop's torque may leave its chord inside a step.
///
/// With |ẋ|, |ẍ|, |x⃛| of either hinge bounded by a, b and their like over the step, and g the loop's
/// function [loop.hpp], whose derivatives are bounded by G, G₂, G₃ over the way of the first hinge,
///
///     |ė| ≤ G a₁ + b₁    |ë| ≤ G a₂ + G₂ a₁² + b₂    |e⃛| ≤ G a₃ + 3 G₂ a₁ a₂ + G₃ a₁³ + b₃        (1)
///     |τ| ≤ K |e| + D |ė|      |τ̇| ≤ K |ė| + D |ë|      |τ̈| ≤ K |ë| + D |e⃛|                      (2)
///
/// and for g'(x_a) τ, which turns the first hinge, by the product's rule. Between s = a and b of a
/// step of h a smooth function is above the larger end by h²/8 of its second derivative times
/// (b − a)² at most, taken 4/3 times as forces are. Where a strand may go slack inside the step, or
/// the first hinge may pass a knot of the table, by half the first derivative times h (b − a), and
/// by the half of D ė that a strand which goes slack drops.
#pragma once

#include "core/dense/curved_search.hpp"
#include "core/dense/derivative_bounds.hpp"
#include "core/laws/loop.hpp"

namespace wingspread {

/// Of what a loop does to its two hinges.
template <class T> struct LoopBulges { Bulge<T> first, second; };

namespace detail {

/// No |g'|, |g''|, |g'''| is larger on a way; whether g is one polynomial on it.
template <class T> struct GearBounds {
  T first, second, third;
  bool smooth;
};

template <class T>
[[nodiscard]] GearBounds<T> gear_bounds(const LoopTerms<T>& loop, const ValueRange<T>& travel) {
  using std::abs;
  if (!loop.table) return {abs(loop.ratio), T(0), T(0), true};
  const std::size_t k = piece_number(*loop.table, travel.low);
  if (k != piece_number(*loop.table, travel.high)) {
    const T steepest =
        larger(T(abs(T(loop.table->steepest_rise()))), T(abs(T(loop.table->steepest_fall()))));
    return {steepest, T(loop.table->sharpest_bend()), T(0), false};
  }
  const PieceAt<T> piece = piece_at(*loop.table, travel.low);
  const T way = travel.high - travel.low;
  const T bend = abs(fused(T(6) * piece.c[3], piece.u, T(2) * piece.c[2]));
  const T third = abs(T(6) * piece.c[3]), second = fused(third, way, bend);
  return {fused(second, way, T(abs(slope(piece)))), second, third, true};
}

template <class T> [[nodiscard]] ValueRange<T> hull(const Quintic<T>& p) {
  ValueRange<T> range{p[0], p[0]};
  for (int k = 1; k < 6; ++k) range.include(p[k]);
  return range;
}

} // namespace detail

/// Over a step.
/// @param a, b the angles of its hinges
template <class T>
[[nodiscard]] LoopBulges<T> loop_bulges(const LoopTerms<T>& loop, const Quintic<T>& a,
                                        const Quintic<T>& b, const T& h) {
  using std::abs;
  const DifferenceScale<T> scale(h);
  const DerivativeBounds<T> x = derivative_bounds_beyond_rounding(a, scale),
                            y = derivative_bounds_beyond_rounding(b, scale);
  const ValueRange<T> at = detail::hull(a);
  const detail::GearBounds<T> g = detail::gear_bounds(
      loop, scaled(loop.sense_a, ValueRange<T>{at.low - loop.stowed_a, at.high - loop.stowed_a}));
  const T e1 = fused(g.first, x.first, y.first);
  const T e2 = fused(g.first, x.second, fused(g.second, x.first * x.first, y.second));
  const T e3 = fused(g.first, x.third, y.third) +
               x.first * fused(T(3) * g.second, x.second, g.third * x.first * x.first);
  const T start = abs(loop_state(loop, a[0], T(0), b[0], T(0)).elastic);
  const T most = start + loop.stiffness * e1 * h; // of K |e|
  const T tau0 = most + loop.damping * e1, tau1 = loop.stiffness * e1 + loop.damping * e2;
  const T tau2 = loop.stiffness * e2 + loop.damping * e3;
  const bool may_slacken = most > loop.slack_beyond && start - (most - start) < loop.slack_beyond;
  const T drop = may_slacken ? T(0.5) * loop.damping * e1 : T(0);
  const T gear1 = g.second * x.first; // of g'(x_a)
  const T gear2 = fused(g.second, x.second, g.third * x.first * x.first);
  const bool smooth = g.smooth && !may_slacken;
  const T bend = h * h * T(1.0 / 6), lean = T(0.5) * h;
  if (!smooth)
    return {{T(0), lean * fused(g.first, tau1, gear1 * tau0), g.first * drop},
            {T(0), lean * tau1, drop}};
  const T of_first = fused(g.first, tau2, fused(T(2) * gear1, tau1, gear2 * tau0));
  return {{bend * of_first, T(0), T(0)}, {bend * tau2, T(0), T(0)}};
}

} // namespace wingspread
