/// A table's value, slope, integral and their ranges, for one number or a pack.
#pragma once

#include "core/laws/hinge_law.hpp"
#include "core/number/pack.hpp"
#include "core/scene/curve.hpp"

#include <algorithm>
#include <array>

namespace wingspread {

/// The polynomial of a curve at one x: Σ c_k u^k, and the integral from the first knot to u = 0.
template <class T> struct PieceAt {
  T u; ///< x less the knot at the piece's start (of the first piece, at its end)
  std::array<T, 4> c;
  T integral;
};

namespace detail {

/// @param knot the origin of u
template <class T>
[[nodiscard]] PieceAt<T> piece_at(const Curve::Piece& piece, double knot, const T& x) {
  return {
      x - T(knot), {T(piece.c[0]), T(piece.c[1]), T(piece.c[2]), T(piece.c[3])}, T(piece.integral)};
}

/// Index of the piece at x: the number of knots at or before x; 0 for NaN.
template <class T> [[nodiscard]] std::size_t piece_number(const Curve& curve, const T& x) {
  const std::vector<double>& knots = curve.knots();
  std::size_t k = 0;
  while (k < knots.size() && x >= T(knots[k])) ++k;
  return k;
}

/// Whether one piece holds the whole range.
template <class T> [[nodiscard]] Truth<T> is_one_piece(const Curve& curve, const ValueRange<T>& x) {
  Truth<T> one = T(0) <= T(0);
  for (const double knot : curve.knots()) one = one && !(x.low < T(knot) && x.high >= T(knot));
  return one;
}

[[nodiscard]] inline double knot_of(const Curve& curve, std::size_t piece) {
  return curve.knots()[piece > 0 ? piece - 1 : 0];
}

} // namespace detail

/// The piece at x.
template <class T> [[nodiscard]] PieceAt<T> piece_at(const Curve& curve, const T& x) {
  const std::size_t k = detail::piece_number(curve, x);
  return detail::piece_at(curve.pieces()[k], detail::knot_of(curve, k), x);
}

namespace detail {

/// Finds the piece of one lane after the other.
template <int W>
[[nodiscard]] inline PieceAt<Pack<W>> piece_lane_by_lane(const Curve& curve, const Pack<W>& x) {
  PieceAt<Pack<W>> found;
  Pack<W> knot(0.0);
  found.integral = Pack<W>(0.0);
  found.c.fill(Pack<W>(0.0));
  for (int lane = 0; lane < W; ++lane) {
    const double at = x.v[lane];
    const std::size_t k = piece_number(curve, at);
    const Curve::Piece& piece = curve.pieces()[k];
    knot.v[lane] = knot_of(curve, k);
    for (int power = 0; power < 4; ++power) found.c[power].v[lane] = piece.c[power];
    found.integral.v[lane] = piece.integral;
  }
  found.u = x - knot;
  return found;
}

#ifdef __AVX512F__
/// For eight lanes and at most eight pieces: counts the knots at or before each x, then permutes columns.
[[nodiscard, gnu::always_inline]] inline PieceAt<Pack<8>>
piece_of_columns(const Curve::Columns& columns, const std::vector<double>& knots,
                 const Pack<8>& x) {
  __m512i number = _mm512_setzero_si512();
  for (const double knot : knots) {
    const __mmask8 there = _mm512_cmp_pd_mask(x.v, _mm512_set1_pd(knot), _CMP_GE_OQ);
    number = _mm512_mask_add_epi64(number, there, number, _mm512_set1_epi64(1));
  }
  const auto of = [&](const std::array<double, 8>& column) -> Pack<8> {
    return _mm512_permutexvar_pd(number, _mm512_loadu_pd(column.data()));
  };
  return {x - of(columns.from),
          {of(columns.c[0]), of(columns.c[1]), of(columns.c[2]), of(columns.c[3])},
          of(columns.integral)};
}
#endif

} // namespace detail

/// The pieces of all lanes: passes over all knots, and each lane keeps the last piece that begins at or before its x.
/// Heuristic: beyond 12 knots a search lane by lane is faster. A wrong number costs time only.
template <int W>
[[nodiscard]] inline PieceAt<Pack<W>> piece_at(const Curve& curve, const Pack<W>& x) {
  using P = Pack<W>;
  const std::vector<double>& knots = curve.knots();
#ifdef __AVX512F__
  if constexpr (W == 8)
    if (curve.columns()) return detail::piece_of_columns(*curve.columns(), knots, x);
#endif
  if (knots.size() > 12) return detail::piece_lane_by_lane(curve, x);
  PieceAt<P> found = detail::piece_at(curve.pieces()[0], 0.0, x);
  P knot(knots[0]);
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const Curve::Piece& piece = curve.pieces()[k + 1];
    const auto there = x >= P(knots[k]);
    knot = select(there, P(knots[k]), knot);
    for (int power = 0; power < 4; ++power)
      found.c[power] = select(there, P(piece.c[power]), found.c[power]);
    found.integral = select(there, P(piece.integral), found.integral);
  }
  found.u = x - knot;
  return found;
}

template <class T> [[nodiscard]] T value(const PieceAt<T>& p) {
  return fused(p.u, fused(p.u, fused(p.u, p.c[3], p.c[2]), p.c[1]), p.c[0]);
}
template <class T> [[nodiscard]] T slope(const PieceAt<T>& p) {
  return fused(p.u, fused(p.u, T(3) * p.c[3], T(2) * p.c[2]), p.c[1]);
}
/// d²y/dx².
template <class T> [[nodiscard]] T bend(const PieceAt<T>& p) {
  return fused(T(6) * p.c[3], p.u, T(2) * p.c[2]);
}

/// Largest difference between the curve's slope, at any x, and `here`.
[[nodiscard]] inline double most_change_of_slope(const Curve& curve, double here) {
  return std::max(curve.steepest_rise() - here, here - curve.steepest_fall());
}

template <class T> [[nodiscard]] T value(const Curve& curve, const T& x) {
  return value(piece_at(curve, x));
}
template <class T> [[nodiscard]] T slope(const Curve& curve, const T& x) {
  return slope(piece_at(curve, x));
}

/// ∫ of the curve from its first knot to x.
template <class T> [[nodiscard]] T integral(const Curve& curve, const T& x) {
  const PieceAt<T> p = piece_at(curve, x);
  const T mean =
      fused(p.u, fused(p.u, fused(p.u, T(0.25) * p.c[3], p.c[2] / T(3)), T(0.5) * p.c[1]), p.c[0]);
  return fused(p.u, mean, p.integral);
}

/// Range of a curve's slope over a range of x: extremes lie at its ends, at knots inside, or where a cubic's second
/// derivative vanishes.
template <class T>
[[nodiscard]] ValueRange<T> range_of_slope(const Curve& curve, const ValueRange<T>& x) {
  const T first = slope(curve, x.low), last = slope(curve, x.high);
  ValueRange<T> range{smaller(first, last), larger(first, last)};
  for (const Curve::Turn& turn : curve.turns()) {
    const auto inside = x.low <= T(turn.x) && T(turn.x) <= x.high;
    range.low = select(inside, smaller(range.low, T(turn.least)), range.low);
    range.high = select(inside, larger(range.high, T(turn.largest)), range.high);
  }
  return range;
}

/// Range of a curve's values over a range of x: extremes lie at its ends and at knots. Widened by the
/// curve's overshoot, its largest excess between knots.
template <class T>
[[nodiscard]] ValueRange<T> range_of(const Curve& curve, const ValueRange<T>& x) {
  const T first = value(curve, x.low), last = value(curve, x.high);
  ValueRange<T> range{smaller(first, last), larger(first, last)};
  for (std::size_t k = 0; k < curve.knots().size(); ++k) {
    const T knot(curve.knots()[k]), there(curve.pieces()[k + 1].c[0]);
    const auto inside = x.low < knot && knot < x.high;
    range.low = select(inside, smaller(range.low, there), range.low);
    range.high = select(inside, larger(range.high, there), range.high);
  }
  const T over(curve.overshoot());
  return {range.low - over, range.high + over};
}

} // namespace wingspread
