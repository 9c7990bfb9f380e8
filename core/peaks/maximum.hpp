/// Finds the maximum of a smooth function from known samples.
#pragma once

#include "core/dense/curved_search.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace wingspread {

/// Fraction of a step within which the dense output counts as exact at a step's end.
///
/// The error of the quintic's rate grows as s². Next to the end of a step of roughness 1 it is 2e-12 of the
/// largest rate for a sine of 1.39 rad, and 4e-11 for the sine of 2.5 rad whose phase hides it best. Heuristic:
/// a larger fraction gives a peak the interpolant's accuracy; a smaller one costs a step of the method that
/// ends beside the step's own end.
inline constexpr double next_to_an_end = 1e-5;

/// The parabola through three points, left to right.
template <class T> struct Parabola {
  Parabola(const Sampled<T>& left, const Sampled<T>& middle, const Sampled<T>& right) {
    const T before = (middle.value - left.value) * (right.s - middle.s);
    const T after = (middle.value - right.value) * (middle.s - left.s);
    both = before + after;
    way = (before * (right.s - middle.s) - after * (middle.s - left.s)) / (T(2) * both);
    vertex = middle.s + way;
  }
  /// Whether it has a maximum between left and right.
  [[nodiscard]] Truth<T> crests(const Sampled<T>& left, const Sampled<T>& right) const {
    return both > T(0) && vertex > left.s && vertex < right.s;
  }

  T both;        ///< > 0: it bends downwards
  T way, vertex; ///< from the middle to the vertex, and the vertex; a number if both > 0
};

/// Whether maximum_near, given these samples of f, finds nothing larger than the last sample: f rises towards it, and
/// so does the parabola through the last two samples and a point between them. For a pack: in which lanes.
template <class T, std::size_t N, class Function>
[[nodiscard]] Truth<T> rises_to_end(const std::array<T, N>& samples, Function f) {
  const Sampled<T> next{T(1) - T(1) / T(static_cast<double>(N - 1)), samples[N - 2]};
  const Sampled<T> end{T(1), samples[N - 1]};
  Truth<T> rises = !(f(T(1 - next_to_an_end)) > end.value);
  for (std::size_t k = 0; k + 1 < N; ++k) rises = rises && end.value > samples[k];
  if (!any(rises)) return rises;
  const T halfway = (end.s + next.s) / T(2);
  const Sampled<T> middle{halfway, f(halfway)};
  return rises && end.value > middle.value && !Parabola<T>(next, middle, end).crests(next, end);
}

/// The maximum of f near the largest of samples at the ends and at equal distances between them,
/// by parabolas through the best three points, within a bracket [Brent 1973, 5]. Accurate to
/// √ε where f is smooth; the value is accurate to ε, because f is flat there.
/// @param f f(s) → T
/// @return the best point seen, and where the last parabola has its vertex
template <class T, std::size_t N, class Function>
[[nodiscard]] std::pair<Sampled<T>, T> maximum_near(const std::array<T, N>& samples,
                                                    std::size_t best, Function f) {
  using std::abs, std::sqrt;
  const T close = sqrt(sqrt(T(epsilon_of<T>))); // a parabola of this width is accurate to close²
  const T spacing = T(1) / T(N - 1);
  const auto sampled = [&](std::size_t k) { return Sampled<T>{T(k) * spacing, samples[k]}; };
  Sampled<T> left, middle, right;
  if (best > 0 && best < N - 1) {
    left = sampled(best - 1), middle = sampled(best), right = sampled(best + 1);
  } else { // the largest sample lies at an end: look for a larger value beside it
    const Sampled<T> end = sampled(best), next = sampled(best == 0 ? 1 : N - 2);
    const T beside = best == 0 ? T(next_to_an_end) : T(1 - next_to_an_end),
            halfway = (end.s + next.s) / T(2);
    middle = {beside, f(beside)};
    if (!(middle.value > end.value)) middle = {halfway, f(halfway)};
    left = best == 0 ? end : next, right = best == 0 ? next : end;
  }
  const auto largest = [&](const T& vertex) -> std::pair<Sampled<T>, T> {
    if (middle.value >= left.value && middle.value >= right.value) return {middle, vertex};
    const Sampled<T>& end = left.value > right.value ? left : right;
    return {end, end.s};
  };
  T last(1), last_but_one(1); // distances between successive points
  for (int pass = 0; pass < 40; ++pass) {
    const Parabola<T> parabola(left, middle, right);
    if (!parabola.crests(left, right)) break; // a plateau, or it rises to an end
    const T way = parabola.way;
    T s = parabola.vertex;
    const T rightwards = right.s - middle.s, leftwards = middle.s - left.s;
    const T wider = rightwards > leftwards ? rightwards : T(-leftwards);
    if (abs(wider) < T(3) * close) return largest(s);
    if (abs(way) < close) // converged: a point beside confirms it
      s = middle.s + (wider > T(0) ? close : T(-close));
    else if (abs(way) > T(0.5) * last_but_one) // parabolas do not converge
      s = middle.s + wider / T(2);
    last_but_one = last, last = abs(s - middle.s);
    const Sampled<T> made{s, f(s)};
    const bool above = made.value > middle.value;
    if (s < middle.s)
      (above ? right : left) = above ? middle : made;
    else
      (above ? left : right) = above ? middle : made;
    if (above) middle = made;
  }
  return largest(middle.s);
}

} // namespace wingspread
