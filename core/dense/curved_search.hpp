/// Finds where a function over a step is first positive, and where it is largest, from a bound on its curvature.
///
/// Between s = a and b a smooth function exceeds its larger end by at most rise·(b − a)². It is monotone there if the
/// values at the ends differ by more than 8 rise·(b − a)². For the slope differs from the chord's by at most (b − a)
/// times the largest second derivative, 8 rise.
///
/// A function with kinks and jumps exceeds its larger end by at most bend·(b − a)² + lean·(b − a) + jump, and need
/// not be monotone. Halving does not reduce a jump: the caller's bound must say, per interval, whether a jump is
/// possible.
///
/// The searches halve intervals until the bound decides each. So they miss no crossing and no maximum between samples,
/// unless it exceeds the larger end by less than the caller's `close`.
#pragma once

#include "core/number/scalar.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace wingspread {

/// Largest excess of a function over the larger of its values at two fractions of the step, and whether it is
/// smooth between them.
template <class T> struct Inside {
  T most;
  Truth<T> smooth;
};

/// Coefficients of the largest excess over the larger end, for any part of the step.
template <class T> struct Bulge {
  T bend;   ///< times the part's square
  T lean{}; ///< times the part
  T jump{}; ///< on every part

  [[nodiscard]] T over(const T& part) const { return fused(part, fused(part, bend, lean), jump); }
  [[nodiscard]] Truth<T> is_smooth() const { return lean == T(0) && jump == T(0); }
  [[nodiscard]] Inside<T> operator()(const T& a, const T& b) const {
    return {over(T(b - a)), is_smooth()};
  }
  Bulge& operator+=(const Bulge& other) {
    bend = bend + other.bend, lean = lean + other.lean, jump = jump + other.jump;
    return *this;
  }
};

/// The part of a step below which intervals are not halved: 2^-17, so that a search ends after 2^17 samples whatever
/// its bound says. A smooth function exceeds its larger end there by at most 2^-34 = 6e-11 of its rise over the step; a
/// kink or a jump hides at most the 2^-17 part of the step in which it lies. In a very short step the part is larger:
/// four roundings of the time, because times closer than that are equal.
/// @param t, h start and length of the step, s
template <class T> [[nodiscard]] T shortest_part(const T& t, const T& h) {
  using std::abs;
  return larger(T(1.0 / (1 << 17)), T(4 * epsilon_of<T>) * abs(t) / h);
}

/// A function's value at a fraction of the step.
template <class T> struct Sampled { T s, value; };

/// Where a function becomes positive, and its slope there by fractions of the step.
template <class T> struct RisingRoot { T s, slope; };

namespace detail {

template <class T> struct Stretch { Sampled<T> a, b; };

/// 2^-17 of a step: below, a stretch counts as a point. Heuristic: more cost samples where a function lies close to 0
/// over a stretch, fewer end the search before the root is separated.
inline constexpr int most_halvings = 17;

/// Intervals still to be decided, last in, first out: at most one per halving, and the last one's twin.
template <class T> class OpenStretches {
public:
  void push(const Stretch<T>& stretch) { open_[count_++] = stretch; }
  [[nodiscard]] std::optional<Stretch<T>> pop() {
    if (count_ == 0) return std::nullopt;
    return open_[--count_];
  }

private:
  std::array<Stretch<T>, most_halvings + 1> open_;
  std::size_t count_ = 0;
};

/// Largest excess of the function over its larger end; 0 where it is monotone.
template <class T, class Bulges>
[[nodiscard]] T rise_inside(const Stretch<T>& at, const Bulges& bulge) {
  using std::abs;
  const Inside<T> inside = bulge(at.a.s, at.b.s);
  const Truth<T> monotone = inside.smooth && abs(at.b.value - at.a.value) > T(8) * inside.most;
  return select(monotone, T(0), inside.most);
}

/// Whether the function may exceed `floor` and both ends by more than `close` inside the stretch.
template <class T>
[[nodiscard]] Truth<T> may_crest(const Stretch<T>& at, const T& inside, const T& floor,
                                 const T& close) {
  return larger(at.a.value, at.b.value) + inside > floor && !(inside <= close);
}

/// The slope, at the root r, of the parabola through the root and two samples on its two sides.
template <class T>
[[nodiscard]] T slope_at_root(const T& r, const Sampled<T>& before, const Sampled<T>& after) {
  const T back = r - before.s, ahead = after.s - r;
  return (after.value * back / ahead - before.value * ahead / back) / (back + ahead);
}

/// The root of a function that is negative at the stretch's start and positive at its end. An evaluation of f is
/// costly, so the search stops where |f| is 1e-9 of the larger end: a step of the method then corrects the instant. The
/// slope is that of a parabola through samples beyond 1e-3 of it: nearer ones differ by little more than rounding.
template <class T, class Function>
[[nodiscard]] RisingRoot<T> root_of_rise(const Stretch<T>& at, const Function& f) {
  using std::abs;
  const T size = larger(T(-at.a.value), at.b.value);
  Sampled<T> before = at.a, after = at.b;
  const auto rounded = [&](const T& s) {
    const T value = f(s);
    if (value < T(-1e-3) * size && s > before.s) before = {s, value};
    if (value > T(1e-3) * size && s < after.s) after = {s, value};
    return abs(value) <= T(1e-9) * size ? T(0) : value;
  };
  std::uintmax_t iterations = 60;
  const T root =
      boost::math::tools::toms748_solve(rounded, at.a.s, at.b.s, at.a.value, at.b.value,
                                        boost::math::tools::eps_tolerance<T>(40), iterations)
          .second;
  const bool between = before.s < root && root < after.s;
  return {root, between ? slope_at_root(root, before, after)
                        : T((at.b.value - at.a.value) / (at.b.s - at.a.s))};
}

} // namespace detail

/// The first s in [0, 1] where f > 0, with f's slope; none where f ≤ `close` throughout.
/// @param first, last f at s = 0 and 1
/// @param rise  rise(a, b) → Inside between two fractions of the step
/// @param shortest part of the step that is not halved (shortest_part)
/// @param crest raised to the largest sample made
template <class T, class Function, class Bulges>
[[nodiscard]] std::optional<RisingRoot<T>>
first_positive(const Function& f, const T& first, const T& last, const Bulges& rise, const T& close,
               const T& shortest, Sampled<T>& crest) {
  if (first > T(0)) {
    constexpr double width =
        1e-3; // of the step; heuristic: the slope is only the start of an iteration
    return RisingRoot<T>{T(0), (f(T(width)) - first) / T(width)};
  }
  detail::OpenStretches<T> open;
  open.push({{T(0), first}, {T(1), last}});
  while (const auto at = open.pop()) {
    const T inside = detail::rise_inside(*at, rise);
    const bool ends_above = at->b.value > T(0);
    if (!ends_above && !(larger(at->a.value, at->b.value) + inside > T(0))) continue;
    if (inside <= close || at->b.s - at->a.s <= shortest) {
      if (!ends_above) continue;
      if (at->a.value < T(0)) return detail::root_of_rise(*at, f);
      return RisingRoot<T>{at->a.s, (at->b.value - at->a.value) / (at->b.s - at->a.s)};
    }
    const T s = T(0.5) * (at->a.s + at->b.s);
    const Sampled<T> middle{s, f(s)};
    if (middle.value > crest.value) crest = middle;
    if (!(middle.value > T(0)))
      open.push({middle, at->b}); // else the first crossing lies before it
    open.push({at->a, middle});
  }
  return std::nullopt;
}

/// Whether `largest_of` would take samples inside the step; for a pack: in which lanes.
template <class T>
[[nodiscard]] Truth<T> wants_samples(const T& first, const T& last, const Bulge<T>& rise,
                                     const T& floor, const T& close) {
  const detail::Stretch<T> whole{{T(0), first}, {T(1), last}};
  return detail::may_crest(whole, detail::rise_inside(whole, rise),
                           larger(larger(first, last), floor), close);
}

/// Whether a function may exceed `floor` and its larger end by more than `close` between samples of it; for a
/// pack: in which lanes. @param samples by ascending s, the first at 0, the last at 1
template <class T, std::size_t count>
[[nodiscard]] Truth<T> may_crest_between(const std::array<Sampled<T>, count>& samples,
                                         const Bulge<T>& rise, const T& floor, const T& close) {
  const T least = larger(larger(samples.front().value, samples.back().value), floor);
  Truth<T> may = T(0) > T(0);
  for (std::size_t k = 1; k < count; ++k) {
    const detail::Stretch<T> part{samples[k - 1], samples[k]};
    may = may || samples[k].value > least ||
          detail::may_crest(part, detail::rise_inside(part, rise), least, close);
  }
  return may;
}

/// The maximum of f, to `close`, if it exceeds `floor`; else any sample.
template <class T, class Function>
[[nodiscard]] Sampled<T> largest_of(const Function& f, const T& first, const T& last,
                                    const Bulge<T>& rise, const T& floor, const T& close,
                                    const T& shortest) {
  Sampled<T> best = last > first ? Sampled<T>{T(1), last} : Sampled<T>{T(0), first};
  detail::OpenStretches<T> open;
  open.push({{T(0), first}, {T(1), last}});
  while (const auto at = open.pop()) {
    const T inside = detail::rise_inside(*at, rise);
    if (!detail::may_crest(*at, inside, larger(best.value, floor), close) ||
        at->b.s - at->a.s <= shortest)
      continue;
    const T s = T(0.5) * (at->a.s + at->b.s);
    const Sampled<T> middle{s, f(s)};
    if (middle.value > best.value) best = middle;
    const bool left_first = at->a.value > at->b.value;
    open.push(left_first ? detail::Stretch<T>{middle, at->b} : detail::Stretch<T>{at->a, middle});
    open.push(left_first ? detail::Stretch<T>{at->a, middle} : detail::Stretch<T>{middle, at->b});
  }
  return best;
}

} // namespace wingspread
