#include "core/number/quintic.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <array>

using namespace wingspread;

namespace {
/// sin(w t + p) and its derivatives at t.
Jet<double> wave(double w, double p, double t) {
  return {std::sin(w * t + p), w * std::cos(w * t + p), -w * w * std::sin(w * t + p)};
}
} // namespace

TEST_CASE("a quintic is reproduced, its ends and its derivative with it") {
  oracle::Draws draws(1);
  for (int trial = 0; trial < 200; ++trial) {
    double c[6];
    for (double& v : c) v = draws.uniform(-1, 1);
    const double h = draws.log_uniform(0.01, 10);
    const auto jet = [&](double t) {
      Jet<double> j{0, 0, 0};
      for (int k = 5; k >= 0; --k)
        j = {j.value * t + c[k], j.first * t + j.value, j.second * t + 2 * j.first};
      return j;
    };
    const Quintic<double> p = hermite(h, jet(0), jet(h));
    const Quintic<double> d = derivative(p, h);
    for (const double s : {0.0, 0.125, 0.4, 0.77, 1.0}) {
      const Jet<double> expected = jet(s * h);
      CHECK(value(p, s) == Approx(expected.value).epsilon(1e-12).margin(1e-12 * bound(p)));
      CHECK(value(d, s) == Approx(expected.first).epsilon(1e-10).margin(1e-12 * bound(d)));
      CHECK(std::abs(value(p, s)) <= bound(p) * (1 + 1e-15));
    }
  }
}

TEST_CASE("a part of a quintic is that quintic, however small, and lies within what it is on a "
          "larger one") {
  oracle::Draws draws(3);
  for (int trial = 0; trial < 200; ++trial) {
    Quintic<double> p;
    for (double& v : p) v = draws.uniform(-1, 1);
    const double a = trial % 4 == 0 ? 0 : draws.uniform(0, 1);
    const double b = trial % 4 == 1 ? 1 : a + (1 - a) * draws.log_uniform(1e-12, 1);
    const Quintic<double> part = part_of(p, a, b);
    for (const double s : {0., 0.1, 0.5, 0.93, 1.})
      CHECK(value(part, s) == Approx(value(p, a + (b - a) * s)).margin(1e-15));
    CHECK(bound(part) <= bound(p) * (1 + 1e-15));
  }
}

TEST_CASE("interpolation error falls with the sixth power of the step") {
  const auto error = [](double h) {
    // about the crest, where the even powers of the error alone are left
    const double p0 = 1.5707963267948966 - h / 2;
    const Quintic<double> p = hermite(h, wave(1, p0, 0), wave(1, p0, h));
    double worst = 0;
    for (int k = 1; k < 64; ++k)
      worst = std::max(worst, std::abs(value(p, k / 64.0) - wave(1, p0, h * k / 64).value));
    return worst;
  };
  // down to 1e-13, below which round-off stands
  for (double h = 1; error(h / 2) > 1e-13; h /= 2)
    CHECK(std::log2(error(h) / error(h / 2)) == Approx(6).margin(0.05));
  CHECK(error(1) < 1.0 / 46080); // the bound of the docstring for |φ⁽⁶⁾| ≤ 1
}

TEST_CASE("the first crossing is found to round-off") {
  // −cos(w t) from t = 0 first reaches zero at π/(2w)
  for (const double w : {0.3, 1.0, 1.6, 2.0}) {
    const Jet<double> a = wave(w, -1.5707963267948966, 0), b = wave(w, -1.5707963267948966, 1);
    const Quintic<double> p = hermite(1.0, a, b);
    const auto s = first_nonnegative(p);
    REQUIRE(s.has_value() == (1.5707963267948966 / w <= 1));
    if (s) {
      CHECK(value(p, *s) == Approx(0).margin(1e-14));
      CHECK(value(p, *s - 1e-9) < 0);
    }
  }
}

TEST_CASE("a crossing that comes back inside the step is not missed") {
  // touches zero from below at s = 0.37 with a hump of height e
  const auto hump = [](double e) {
    const auto jet = [&](double t) {
      return Jet<double>{e - (t - 0.37) * (t - 0.37), -2 * (t - 0.37), -2};
    };
    return hermite(1.0, jet(0), jet(1));
  };
  for (const double e : {1e-2, 1e-4, 1e-8, 1e-12}) {
    const auto s = first_nonnegative(hump(e));
    REQUIRE(s.has_value());
    CHECK(*s == Approx(0.37 - std::sqrt(e)).margin(1e-14 / std::sqrt(e)));
    CHECK_FALSE(first_nonnegative(hump(-e)).has_value());
  }
}

namespace {

/// Bernstein coefficients of c[0] + c[1] s + … + c[5] s⁵: b_k = Σ_j (k over j)/(5 over j) c_j.
Quintic<double> from_powers(const std::array<double, 6>& c) {
  const auto over = [](int n, int k) {
    double product = 1;
    for (int i = 1; i <= k; ++i) product = product * (n - k + i) / i;
    return product;
  };
  Quintic<double> p{};
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j <= k; ++j) p[k] += over(k, j) / over(5, j) * c[j];
  return p;
}

} // namespace

TEST_CASE("of three crossings it is the first that is found") {
  // (s − 0.2)(s − 0.5)(s − 0.8)
  const Quintic<double> three = from_powers({-0.08, 0.66, -1.5, 1, 0, 0});
  REQUIRE(value(three, 0.5) == Approx(0).margin(1e-15));
  REQUIRE(first_nonnegative(three).has_value());
  CHECK(*first_nonnegative(three) == Approx(0.2).epsilon(1e-13));
  Quintic<double> back = three; // from above
  for (double& c : back) c = -c;
  CHECK(first_nonnegative(back) == 0.0);
}

TEST_CASE("a root at the start does not count, be it simple or double") {
  const Quintic<double> simple = from_powers({0, -0.3, 1, 0, 0, 0}); // s (s − 0.3)
  const Quintic<double> twice = from_powers({0, 0, -0.3, 1, 0, 0});  // s² (s − 0.3)
  for (const Quintic<double>& p : {simple, twice}) {
    CHECK(first_nonnegative(p) == 0.0);
    const auto s = first_nonnegative(without_root_at_start(p));
    REQUIRE(s.has_value());
    CHECK(*s == Approx(0.3).epsilon(1e-13));
  }
}

TEST_CASE("whether a root at the start is double does not depend on the polynomial's unit") {
  oracle::Draws draws(11);
  for (int trial = 0; trial < 300; ++trial) {
    const double r = draws.uniform(0.1, 0.9), size = std::ldexp(1., draws.below(200) - 100);
    const double first = trial % 2 == 0 ? draws.log_uniform(1e-6, 1) : 0; // 0: a double root
    // s (s + first) (s − r): without its root at 0 it is below 0 up to r
    const Quintic<double> p = from_powers({0, -first * r, first - r, 1, 0, 0});
    Quintic<double> scaled = p;
    for (double& c : scaled) c *= size;
    const Quintic<double> rest = without_root_at_start(p),
                          of_scaled = without_root_at_start(scaled);
    CAPTURE(trial, r, first, size);
    for (int k = 0; k < 6; ++k) CHECK(of_scaled[k] == size * rest[k]);
    const auto next = first_nonnegative(of_scaled);
    REQUIRE(next.has_value());
    CHECK(*next == Approx(r).epsilon(1e-9));
  }
}

TEST_CASE("the only zero of a quintic is found to round-off in a few passes, steep, flat or near "
          "an end") {
  // (s − r) q(s) with q > 0: one zero, at r
  oracle::Draws draws(7);
  for (int trial = 0; trial < 500; ++trial) {
    std::array<double, 5> q;
    for (double& c : q) c = draws.log_uniform(1e-3, 1e3);
    const double r = trial % 3 == 0 ? draws.log_uniform(1e-9, 0.5) : draws.uniform(0.01, 0.99);
    Quintic<double> p;
    for (int k = 0; k < 6; ++k)
      p[k] = (k > 0 ? k / 5.0 * (1 - r) * q[k - 1] : 0) - (k < 5 ? (5 - k) / 5.0 * r * q[k] : 0);
    if (!changes_sign_once(p)) continue;
    CAPTURE(trial, r);
    // what rounding of coefficients as large as p's makes of so flat a crossing
    const double slope = bernstein(q, r), rounding = 1e-15 * bound(p) / slope;
    CHECK(std::abs(only_zero(p) - r) <= 4e-16 * r + 8 * rounding);
  }
}
