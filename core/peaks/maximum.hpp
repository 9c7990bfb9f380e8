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
    const T before = (middle.value - left.value) * (right.s - middle.s);
    const T after = (middle.value - right.value) * (middle.s - left.s), both = before + after;
    if (!(both > T(0))) break; // no maximum inside, or a plateau
    const T way = (before * (right.s - middle.s) - after * (middle.s - left.s)) / (T(2) * both);
    T s = middle.s + way;
    if (!(s > left.s && s < right.s)) break; // it rises to an end
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
