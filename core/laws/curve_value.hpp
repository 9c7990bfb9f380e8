/// A curve's value, slope and integral for any number: one, or a pack of them.
#pragma once

#include "core/number/pack.hpp"
#include "core/scene/curve.hpp"

#include <array>

namespace wingspread {

/// Of a piece: c of Curve::Piece, where it begins, and the integral up to there.
template <class T> struct PieceAt {
  T u; ///< x less the knot of its powers
  std::array<T, 4> c;
  T integral;
};

namespace detail {

/// From the piece at x and the knot of its powers.
template <class T>
[[nodiscard]] PieceAt<T> piece_at(const Curve::Piece& piece, double knot, const T& x) {
  return {
      x - T(knot), {T(piece.c[0]), T(piece.c[1]), T(piece.c[2]), T(piece.c[3])}, T(piece.integral)};
}

/// The number of knots at or before x: that of its piece. NaN: 0.
template <class T> [[nodiscard]] std::size_t piece_number(const Curve& curve, const T& x) {
  const std::vector<double>& knots = curve.knots();
  std::size_t k = 0;
  while (k < knots.size() && x >= T(knots[k])) ++k;
  return k;
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

/// A lane at a time.
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
/// Of eight lanes out of eight pieces: how many knots lie at or before each x, then a permutation.
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

/// In all lanes at once: from piece to piece, each lane takes what begins before it. With more than
/// a dozen knots it is faster to look for each lane's own.
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

/// A range of values.
template <class T> struct ValueRange {
  T low, high;

  friend ValueRange operator+(const ValueRange& a, const ValueRange& b) {
    return {a.low + b.low, a.high + b.high};
  }
  void include(const T& x) { low = smaller(low, x), high = larger(high, x); }
};

/// By a factor of either sign.
template <class T> [[nodiscard]] ValueRange<T> scaled(const T& by, const ValueRange<T>& range) {
  const T a = by * range.low, b = by * range.high;
  return {smaller(a, b), larger(a, b)};
}

/// The product of two.
template <class T>
[[nodiscard]] ValueRange<T> operator*(const ValueRange<T>& a, const ValueRange<T>& b) {
  ValueRange<T> range = scaled(a.low, b);
  range.include(a.high * b.low), range.include(a.high * b.high);
  return range;
}

/// Of a curve's slope over a range of x: at its ends, on both sides of the knots inside, and where the
/// bend of a cubic turns.
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

/// Over a range of x: the extremes lie at knots, or are no more than the overshoot beyond.
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
