/// A function over a step by a polynomial through few samples, where these resolve it.
///
/// The samples lie at Chebyshev points of the second kind, s_j = (1 − cos(π j/n))/2, and the polynomial is evaluated
/// by the barycentric formula [Berrut & Trefethen 2004, eqs. 4.2 and 5.4]. The points of n = 4 are among those of 8,
/// and these among those of 16. For a function that is analytic in the step the error falls geometrically with n. The
/// samples added for the next n therefore test the polynomial of degree n. If its error there is a small share
/// (`enough`) of the function's size, the polynomial through all samples is far more accurate. Few samples do not
/// resolve a kink or a jump. Rounding is like many jumps: where large terms cancel, all values may be rounding. The
/// caller therefore says which error is none (`close`).
#pragma once

#include "core/dense/curved_search.hpp"

#include <boost/math/tools/minima.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace wingspread {

template <class T> class StepInterpolant {
public:
  /// The fractions of the step at which `begin` takes samples.
  static constexpr std::array<double, 3> first_places{0.14644660940672624, 0.5,
                                                      0.85355339059327376};

  /// Samples f, a function of the fraction of the step, at these places.
  /// @param first, last f at s = 0 and 1
  template <class Function> void begin(const Function& f, const T& first, const T& last) {
    values_[0] = first, values_[points] = last;
    stride_ = 4;
    for (int k = 0; k < 3; ++k) values_[4 * (k + 1)] = f(T(first_places[k]));
  }
  /// |f| at the ends and at these places. @pre begin
  [[nodiscard]] std::array<Sampled<T>, 5> begun() const {
    using std::abs;
    std::array<Sampled<T>, 5> all;
    for (int k = 0; k <= 4; ++k) all[k] = {T(place(4 * k)), T(abs(values_[4 * k]))};
    return all;
  }

  /// Samples f further, until the samples resolve it. @pre begin
  /// @param close difference below which two values of f count as one
  /// @return whether they do, after at most 12 more
  template <class Function> [[nodiscard]] bool resolve(const Function& f, const T& close) {
    return refine(f, close) || refine(f, close);
  }

  [[nodiscard]] T operator()(const T& s) const {
    T above(0), below(0);
    for (int j = 0; j <= points; j += stride_) {
      const T way = s - T(place(j));
      if (way == T(0)) return values_[j];
      const T weight = weight_of(j, way, stride_);
      above = above + weight * values_[j], below = below + weight;
    }
    return above / below;
  }

  /// Its largest magnitude. @pre resolve has returned true
  [[nodiscard]] Sampled<T> largest_magnitude() const {
    using std::abs;
    const auto size = [this](const T& s) { return T(abs((*this)(s))); };
    const Weights& weights = weights_on_grid(stride_);
    Sampled<T> best{T(0), size(T(0))};
    for (int k = 1; k <= grid; ++k) {
      const T value = abs(weights[k].of(values_, stride_));
      if (value > best.value) best = {T(k) / T(grid), value};
    }
    const T low = larger(T(0), T(best.s - T(1) / T(grid)));
    const T high = smaller(T(1), T(best.s + T(1) / T(grid)));
    std::uintmax_t tries = 40;
    const auto [s, negative] = boost::math::tools::brent_find_minima(
        [&](const T& at) { return T(-size(at)); }, low, high, 26, tries);
    return -negative > best.value ? Sampled<T>{s, T(-negative)} : best;
  }

private:
  static constexpr int points = 16;
  static constexpr int grid = 4 * points; ///< finer than any swing of the polynomial

  /// The barycentric weights at one place: constants, so that a value on the grid takes one division.
  struct AtPlace {
    std::array<T, points + 1> weights{};
    T sum{};
    int sample = -1; ///< the sample at this place, if there is one

    [[nodiscard]] T of(const std::array<T, points + 1>& values, int stride) const {
      if (sample >= 0) return values[sample];
      T above(0);
      for (int j = 0; j <= points; j += stride) above = above + weights[j] * values[j];
      return above / sum;
    }
  };
  using Weights = std::array<AtPlace, grid + 1>;

  /// The barycentric weight of sample j, at this distance from it.
  [[nodiscard]] static T weight_of(int j, const T& way, int stride) {
    const T whole = T((j / stride) % 2 == 0 ? 1 : -1) / way;
    return j == 0 || j == points ? T(0.5) * whole : whole;
  }

  [[nodiscard]] static AtPlace at_place(const T& s, int stride) {
    AtPlace at;
    at.sum = T(0);
    for (int j = 0; j <= points; j += stride) {
      const T way = s - T(place(j));
      if (way == T(0)) {
        at.sample = j;
        return at;
      }
      at.weights[j] = weight_of(j, way, stride);
      at.sum = at.sum + at.weights[j];
    }
    return at;
  }

  /// @param stride 1, 2 or 4
  [[nodiscard]] static const Weights& weights_on_grid(int stride) {
    static const std::array<Weights, 3> all = [] {
      std::array<Weights, 3> made;
      for (int k = 0; k <= grid; ++k)
        for (const int each : {0, 1, 2}) made[each][k] = at_place(T(k) / T(grid), 1 << each);
      return made;
    }();
    return all[stride / 2];
  }

  /// Relative miss of the points that are added. Heuristic: with geometric convergence, a polynomial of degree n
  /// that misses by 1e-6 leaves the one of degree 2n an error of 1e-11, as small as the integration's own.
  static constexpr double enough = 1e-6;

  [[nodiscard]] static double place(int j) {
    static const std::array<double, points + 1> places = [] {
      std::array<double, points + 1> all{};
      for (int k = 0; k <= points; ++k) {
        const double half = std::sin(std::numbers::pi * k / (2 * points));
        all[k] = half * half;
      }
      for (int k = 0; k < 3; ++k) all[4 * (k + 1)] = first_places[k];
      return all;
    }();
    return places[j];
  }

  /// Halves the distance of the points. @return whether the polynomial so far has foretold the new samples
  template <class Function> [[nodiscard]] bool refine(const Function& f, const T& close) {
    using std::abs;
    const int finer = stride_ / 2;
    T size(0), miss(0);
    for (int j = finer; j < points; j += stride_) {
      values_[j] = f(T(place(j)));
      miss = larger(miss, T(abs((*this)(T(place(j))) - values_[j])));
    }
    stride_ = finer;
    for (int j = 0; j <= points; j += stride_) size = larger(size, T(abs(values_[j])));
    return miss <= larger(T(T(enough) * size), close);
  }

  std::array<T, points + 1> values_{};
  int stride_ = points; ///< of the points that have samples
};

} // namespace wingspread
