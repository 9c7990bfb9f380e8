/// Quintic Hermite interpolation in Bernstein form: the dense output of every method inside a step.
///
/// A second-order system knows angle, rate and acceleration at both ends of a step, so each angle
/// has a quintic with an error of at most φ⁽⁶⁾ h⁶/46080, and each rate one of order h⁵. In
/// Bernstein form a polynomial lies within the hull of its coefficients [Farin, Curves and
/// Surfaces, ch. 5], which turns "no crossing in this step" and "no larger peak in this step" into
/// proofs rather than samples.
#pragma once

#include "core/number/scalar.hpp"

#include <array>
#include <optional>

namespace wingspread {

/// Bernstein coefficients over s ∈ [0, 1].
template <class T> using Quintic = std::array<T, 6>;

/// One end of a step.
template <class T> struct Jet {
  T value;
  T first;  ///< d/dt
  T second; ///< d²/dt²
};

/// The quintic over a step of h with the given jets at s = 0 and s = 1.
template <class T>
[[nodiscard, gnu::always_inline]] inline Quintic<T> hermite(const T& h, const Jet<T>& a,
                                                            const Jet<T>& b) {
  const T fifth = h * (T(1) / T(5)); // the constants are folded
  const T twentieth = h * h * (T(1) / T(20));
  return {a.value,
          fused(fifth, a.first, a.value),
          fused(twentieth, a.second, fused(T(2) * fifth, a.first, a.value)),
          fused(twentieth, b.second, fused(T(-2) * fifth, b.first, b.value)),
          fused(-fifth, b.first, b.value),
          b.value};
}

/// Value of a polynomial in Bernstein form at s ∈ [0, 1], by Volk and Schumaker's scheme. Sums of coefficients of
/// one sign cancel nothing.
template <class T, std::size_t N> [[nodiscard]] T bernstein(const std::array<T, N>& p, const T& s) {
  const T r = T(1) - s;
  T sum = p[0], power = s;
  double binomial = 1;
  for (std::size_t k = 1; k < N; ++k) {
    binomial *= static_cast<double>(N - k) / static_cast<double>(k);
    sum = fused(sum, r, T(binomial) * power * p[k]);
    power = power * s;
  }
  return sum;
}

template <class T> [[nodiscard]] T value(const Quintic<T>& p, const T& s) {
  return bernstein(p, s);
}

/// Raises a polynomial's degree from four to five.
template <class T>
[[nodiscard, gnu::always_inline]] inline Quintic<T> raised(const std::array<T, 5>& p) {
  Quintic<T> q{p[0], T(0), T(0), T(0), T(0), p[4]};
  for (int k = 1; k < 5; ++k) q[k] = fused(T(k) / T(5), p[k - 1] - p[k], p[k]);
  return q;
}

/// dp/dt.
template <class T>
[[nodiscard, gnu::always_inline]] inline Quintic<T> derivative(const Quintic<T>& p, const T& h) {
  std::array<T, 5> d;
  for (int k = 0; k < 5; ++k) d[k] = T(5) / h * (p[k + 1] - p[k]);
  return raised(d);
}

/// p/s of a polynomial with p(0) = 0.
template <class T> [[nodiscard]] Quintic<T> divided_by_s(const Quintic<T>& p) {
  std::array<T, 5> r;
  for (int k = 0; k < 5; ++k) r[k] = T(5) / T(k + 1) * p[k + 1];
  return raised(r);
}

/// Upper bound of |p(s)| over s ∈ [0, 1].
template <class T> [[nodiscard, gnu::always_inline]] inline T bound(const Quintic<T>& p) {
  using std::abs;
  T largest(0);
  for (const T& c : p) largest = larger(largest, T(abs(c)));
  return largest;
}

/// p where `these` hold, else q. For packs: lane by lane.
template <class Mask, class T>
[[nodiscard, gnu::always_inline]] inline Quintic<T> chosen(const Mask& these, const Quintic<T>& p,
                                                           const Quintic<T>& q) {
  Quintic<T> either;
  for (int k = 0; k < 6; ++k) either[k] = select(these, p[k], q[k]);
  return either;
}

/// The share of its bound below which a value of a polynomial is rounding: a difference of angles that agree to half
/// of the digits. Larger: a root close to the start is taken for one at it. Smaller: a root at the start is found again.
inline constexpr double vanishes_below = 1e-8;

/// p without its root at s = 0: p/s, or p/s² where p/s vanishes there to rounding.
template <class T> [[nodiscard]] Quintic<T> without_root_at_start(const Quintic<T>& p) {
  using std::abs;
  const Quintic<T> once = divided_by_s(p);
  const auto single = abs(once[0]) > T(vanishes_below) * bound(once);
  return any(!single) ? chosen(single, once, divided_by_s(once)) : once;
}

template <class T> [[nodiscard]] bool all_negative(const Quintic<T>& p) {
  for (const T& c : p)
    if (!(c < T(0))) return false;
  return true;
}

/// Splits p at s = ½ into its left and right half.
template <class T> void halve(Quintic<T> p, Quintic<T>& left, Quintic<T>& right) {
  for (int level = 5; level >= 0; --level) {
    left[5 - level] = p[0];
    right[level] = p[level];
    for (int k = 0; k < level; ++k) p[k] = T(0.5) * (p[k] + p[k + 1]);
  }
}

/// p over s = a … b as a polynomial over 0 … 1, 0 ≤ a < b ≤ 1: splits at b, then the left part at a/b.
template <class T> [[nodiscard]] Quintic<T> part_of(Quintic<T> p, const T& a, const T& b) {
  Quintic<T> left, right;
  for (int level = 5; level >= 0; --level) {
    left[5 - level] = p[0];
    for (int k = 0; k < level; ++k) p[k] = fused(b, T(p[k + 1] - p[k]), p[k]);
  }
  const T ratio = a / b;
  for (int level = 5; level >= 0; --level) {
    right[level] = left[level];
    for (int k = 0; k < level; ++k) left[k] = fused(ratio, T(left[k + 1] - left[k]), left[k]);
  }
  return right;
}

/// Whether the coefficients change from negative to non-negative once: then p has one zero in [0, 1], since their
/// sign changes bound the number of zeros.
template <class T> [[nodiscard]] bool changes_sign_once(const Quintic<T>& p) {
  int changes = 0;
  for (int k = 0; k < 5; ++k) changes += (p[k] < T(0)) != (p[k + 1] < T(0));
  return changes == 1 && p[0] < T(0);
}

/// The only zero of p in [0, 1], to round-off: Newton's method in a bracket. @pre p rises through one zero
/// The method squares its error: after moves Δ₁, Δ₂ the next one is about Δ₂ (Δ₂/Δ₁)², and is skipped below
/// round-off.
template <class T> [[nodiscard]] T only_zero(const Quintic<T>& p) {
  using std::abs;
  std::array<T, 5> slope;
  for (int k = 0; k < 5; ++k) slope[k] = T(5) * (p[k + 1] - p[k]);
  T lower(0), upper(1), s = p[0] / (p[0] - p[5]), before(0);
  for (int pass = 0; pass < std::numeric_limits<T>::digits; ++pass) {
    const T f = value(p, s);
    if (f == T(0)) return s;
    (f < T(0) ? lower : upper) = s;
    T next = s - f / bernstein(slope, s);
    const bool bisects = !(next > lower && next < upper);
    if (bisects) next = T(0.5) * (lower + upper);
    const T move = abs(next - s), finest = std::numeric_limits<T>::epsilon() * s;
    if (move <= finest || move * move * move <= finest * (before * before)) return next;
    before = bisects ? T(0) : move;
    s = next;
  }
  return upper;
}

/// The first s in [0, 1] at which p ≥ 0, to round-off; none if p stays negative.
/// Subdivides and drops pieces whose coefficients are all negative: no crossing is missed, not even one that
/// returns inside the step. Cost: a comparison for most steps, a few
/// evaluations for a crossing.
template <class T> [[nodiscard]] std::optional<T> first_nonnegative(const Quintic<T>& p) {
  if (all_negative(p)) return std::nullopt;
  if (p[0] >= T(0)) return T(0);
  if (changes_sign_once(p)) return only_zero(p);
  struct Piece {
    Quintic<T> p;
    T lower, width;
  };
  constexpr int deepest = std::numeric_limits<T>::digits;
  std::array<Piece, deepest + 2> open;
  int count = 0;
  open[count++] = {p, T(0), T(1)};
  const T finest = std::numeric_limits<T>::epsilon();
  while (count > 0) {
    const Piece piece = open[--count];
    if (all_negative(piece.p)) continue;
    if (piece.p[0] >= T(0)) return piece.lower;
    if (piece.width <= finest) return piece.lower + piece.width;
    if (changes_sign_once(piece.p)) return fused(piece.width, only_zero(piece.p), piece.lower);
    Piece left{{}, piece.lower, T(0.5) * piece.width};
    Piece right{{}, piece.lower + left.width, left.width};
    halve(piece.p, left.p, right.p);
    open[count++] = right;
    open[count++] = left;
  }
  return std::nullopt;
}

} // namespace wingspread
