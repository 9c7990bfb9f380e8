#include "core/dense/step_interpolant.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

TEST_CASE("few samples resolve a smooth function, and give its largest magnitude of either sign") {
  for (const double top : {0.07, 0.3, 0.61, 0.98})
    for (const double sign : {1.0, -1.0}) {
      int samples = 0;
      const auto f = [&](double s) { return ++samples, sign * (0.2 + std::cos(2 * (s - top))); };
      StepInterpolant<double> p;
      const double first = f(0), last = f(1);
      samples = 0;
      CAPTURE(top, sign);
      REQUIRE((p.begin(f, first, last), p.resolve(f, 0)));
      CHECK(samples <= 15);
      CHECK(p(0.456) == Approx(f(0.456)).epsilon(1e-10));
      const Sampled<double> found = p.largest_magnitude();
      CHECK(found.value == Approx(1.2).epsilon(1e-10));
      CHECK(found.s == Approx(top).margin(1e-5));
    }
}

TEST_CASE("a kink or a jump is not resolved by few samples") {
  for (const double at : {0.21, 0.52, 0.83}) {
    const auto kink = [&](double s) { return std::abs(s - at); };
    const auto jump = [&](double s) { return s < at ? 1.0 : 1.3; };
    StepInterpolant<double> p;
    CHECK_FALSE((p.begin(kink, kink(0), kink(1)), p.resolve(kink, 1e-10)));
    CHECK_FALSE((p.begin(jump, jump(0), jump(1)), p.resolve(jump, 1e-10)));
  }
}

TEST_CASE("the largest magnitude is a value of the polynomial, and none on the grid is larger") {
  // with samples enough at 9 points, and at 17
  for (const double speed : {0.4, 2.5})
    for (double phase = 0; phase < 6; phase += 0.37) {
      const auto f = [&](double s) { return std::sin(speed * s + phase); };
      StepInterpolant<double> p;
      CAPTURE(speed, phase);
      REQUIRE((p.begin(f, f(0), f(1)), p.resolve(f, 0)));
      const Sampled<double> found = p.largest_magnitude();
      CHECK(found.value == std::abs(p(found.s)));
      for (int k = 0; k <= 64; ++k) CHECK(std::abs(p(k / 64.0)) <= found.value);
    }
}

TEST_CASE("rounding counts as resolved, and a small function beside it is found within rounding") {
  // f is the small difference of terms of size 1, to the last bit of these
  for (double size = 1; size > 1e-18; size /= 10) {
    int samples = 0;
    const auto f = [&](double s) { return ++samples, 1 + size * std::cos(2 * (s - 0.37)) - 1; };
    StepInterpolant<double> p;
    CAPTURE(size);
    REQUIRE((p.begin(f, f(0), f(1)), p.resolve(f, 1e-10)));
    CHECK(samples <= 17);
    CHECK(std::abs(p.largest_magnitude().value - size) <= 1e-9 * size + 1e-15);
  }
}
