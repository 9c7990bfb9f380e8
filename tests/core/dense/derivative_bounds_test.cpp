#include "core/dense/derivative_bounds.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

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

TEST_CASE("a base of prescribed motion turns over a step as its law says") {
  BaseTerms<double> base{};
  base.rate = 0.3, base.angular_acceleration = 0.2;
  Step<double> step;
  step.t = 5, step.h = 2;
  const Quintic<double> turned = turn_of_base(base, {}, step);
  for (const double s : {0.0, 0.3, 1.0}) {
    const double t = s * step.h, rate = 0.3 + 0.2 * step.t;
    CHECK(value(turned, s) == Approx(rate * t + 0.1 * t * t).margin(1e-15));
  }
}

TEST_CASE("a base that a table drives turns over a step as its piece says, and is pushed no more") {
  BaseTerms<double> base{};
  const BaseTable table({{0, 1}, {}, {0, 1}, {}}, Interpolation::linear);
  base.table = &table, base.gravity = {0.5, 0};
  DrivenPiece<double> piece{};
  piece.from = 4, piece.rate = 0.3, piece.turning = {0.2, -0.1, 0.05, 0.02};
  piece.x = {1, 2, 0, 0}, piece.y = {0, 0, -3, 0};
  Step<double> step;
  step.t = 5, step.h = 2;
  const Quintic<double> turned = turn_of_base(base, piece, step);
  for (const double s : {0.0, 0.3, 1.0}) {
    const auto angle = [&](double u) {
      return 0.3 * u + u * u * (0.1 + u * (-0.1 / 6 + u * (0.05 / 12 + u * 0.02 / 20)));
    };
    CHECK(value(turned, s) == Approx(angle(1 + s * step.h) - angle(1)).margin(1e-14));
  }
  const CubicBounds<double> push = push_of_base(base, piece, step); // largest at the end, u = 3
  CHECK(push.value == Approx(std::hypot(6.5, 27)).epsilon(1e-14));
  CHECK(push.first == Approx(std::hypot(2, 18)).epsilon(1e-14));
  CHECK(push.second == Approx(6).epsilon(1e-14));
}
