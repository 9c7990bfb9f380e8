/// A synchronisation loop: a closed cable that keeps one hinge's travel to a function of another's.
///
/// | symbol   | meaning                                                    | unit   |
/// |----------|------------------------------------------------------------|--------|
/// | x_a, x_b | travel of its hinges, s (φ − φ_stowed)                     | rad    |
/// | e        | g(x_a) − x_b                                               | rad    |
/// | τ        | K e + D ė; where a strand is slack ½ K e + M_p sign e + ½ D ė | N·m |
///
/// It is slack where K |e| > 2 M_p, and turns hinge b by s_b τ, hinge a by −s_a g'(x_a) τ.
#pragma once

#include "core/laws/curve_value.hpp"

namespace wingspread {

template <class T> struct LoopTerms {
  int first, second;  ///< bodies whose hinges it joins, a and b
  const Curve* table; ///< g; null: ratio·x
  T ratio;
  T stiffness, damping;
  T slack_beyond;       ///< 2 M_p; where the loop never goes slack, more than any K |e|
  T stowed_a, stowed_b; ///< rad
  T sense_a, sense_b;
};

/// Where a loop stands.
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

/// K e as it is carried where a strand may be slack.
template <class T> [[nodiscard]] T carried_by_strands(const LoopTerms<T>& loop, const T& elastic) {
  using std::abs;
  const T rest = T(0.5) * larger(T(abs(elastic) - loop.slack_beyond), T(0));
  return elastic - select(elastic > T(0), rest, T(-rest));
}

/// The share of K and D that acts: ½ where a strand is slack.
template <class T> [[nodiscard]] T taut_share(const LoopTerms<T>& loop, const T& elastic) {
  using std::abs;
  return select(abs(elastic) > loop.slack_beyond, T(0.5), T(1));
}

/// τ, N·m.
template <class T> [[nodiscard]] T loop_torque(const LoopTerms<T>& loop, const LoopState<T>& at) {
  return fused(taut_share(loop, at.elastic), at.viscous, carried_by_strands(loop, at.elastic));
}

/// What it does to each hinge for a torque of one.
template <class T> [[nodiscard]] T on_first(const LoopTerms<T>& loop, const T& gear) {
  return -loop.sense_a * gear;
}
template <class T> [[nodiscard]] T on_second(const LoopTerms<T>& loop) { return loop.sense_b; }

/// Its elastic energy, J.
template <class T> [[nodiscard]] T loop_energy(const LoopTerms<T>& loop, const T& elastic) {
  using std::abs;
  if (!(loop.stiffness > T(0))) return T(0);
  const T size = abs(elastic), slack = larger(T(size - loop.slack_beyond), T(0));
  return (T(0.5) * size * size - T(0.25) * slack * slack) / loop.stiffness;
}

} // namespace wingspread
