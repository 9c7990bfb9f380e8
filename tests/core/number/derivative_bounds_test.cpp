#include "core/number/derivative_bounds.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;

namespace {

/// t^k/k! and its derivatives at t.
Jet<double> power(int k, double t) {
  const auto term = [t](int n) { // t^n/n!
    double product = n < 0 ? 0 : 1;
    for (int i = 1; i <= n; ++i) product *= t / i;
    return product;
  };
  return {term(k), term(k - 1), term(k - 2)};
}

} // namespace

TEST_CASE("bounds of derivatives are attained by powers of time") {
  for (const double h : {0.01, 1.0, 7.0})
    for (int k = 1; k <= 4; ++k) {
      const Quintic<double> p = hermite(h, power(k, 0), power(k, h));
      const DerivativeBounds<double> found = derivative_bounds(p, DifferenceScale<double>(h));
      const double all[] = {found.first, found.second, found.third, found.fourth};
      // the n-th derivative is t^(k − n)/(k − n)!, largest at the end; beyond the k-th it is nothing
      for (int n = 1; n <= 4; ++n) {
        CAPTURE(h, k, n);
        const double exact = power(k - n, h).value;
        CHECK(all[n - 1] == Approx(exact).epsilon(1e-10).margin(1e-10 * std::pow(h, k - n)));
      }
    }
}

TEST_CASE("the bound of a direction's fourth derivative has the chain rule's terms") {
  CHECK(fourth_of_direction<double>({2, 0, 0, 0}) == 16);             // θ̇⁴: a steady turn's
  CHECK(fourth_of_direction<double>({0, 3, 0, 0}) == 27);             // 3 θ̈²: from rest
  CHECK(fourth_of_direction<double>({0, 0, 5, 7}) == 7);              // θ⁽⁴⁾
  CHECK(fourth_of_direction<double>({2, 0, 5, 0}) == 16 + 4 * 2 * 5); // and 4 θ̇ θ⃛
  CHECK(fourth_of_direction<double>({2, 3, 0, 0}) == 16 + 27 + 6 * 4 * 3);
}

TEST_CASE("a swing that turns once in a step leaves no chord by more than chord_excess allows") {
  // f = sin(x s + φ) over s = 0 … 1; its second derivative against the fourth one of its quintic
  const auto largest_share = [](double x) {
    double share = 0;
    for (int phase = 0; phase < 180; ++phase) {
      const double phi = std::numbers::pi * phase / 180;
      const auto jet = [&](double s) -> Jet<double> {
        const double angle = x * s + phi;
        return {std::sin(angle), x * std::cos(angle), -x * x * std::sin(angle)};
      };
      const Quintic<double> p = hermite(1.0, jet(0), jet(1));
      const double allowed =
          chord_excess(1.0) * derivative_bounds(p, DifferenceScale<double>(1.0)).fourth;
      for (int k = 0; k <= 200; ++k) {
        const double s = k / 200.0, first = jet(0).second, last = jet(1).second;
        share = std::max(share, std::abs(jet(s).second - (first + (last - first) * s)) / allowed);
      }
    }
    return share;
  };
  constexpr double period = 2 * std::numbers::pi;
  for (const double part : {0.1, 0.25, 0.5, 0.8, 0.95, 1.0}) {
    CAPTURE(part);
    CHECK(largest_share(part * period) <= 1);
  }
  CHECK(largest_share(period) == Approx(0.993).margin(0.01)); // 4/3 is as small as it may be
  CHECK(largest_share(1.27 * period) > 1.5);                  // and breaks beyond a period
}
