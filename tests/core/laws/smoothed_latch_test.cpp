#include "core/laws/smoothed_latch.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a smoothed latch engages over its widths") {
  HingeTerms<double> h{};
  h.stowed = 1, h.latched = 0, h.sense = -1, h.stiffness = 1000, h.damping = 10;
  const double epsilon = 1e-2;
  CHECK(engagement_rate(h, 0.001, epsilon) == 0);
  CHECK(engagement_rate(h, -0.005, epsilon) == Approx(0.5));
  CHECK(engagement_rate(h, -0.02, epsilon) == 1);
  const double full = 1000 * 0.02 - 10 * -0.3;
  CHECK(smoothed_latch_moment(h, -0.02, -0.3, 0.0, epsilon) == 0);
  CHECK(smoothed_latch_moment(h, -0.02, -0.3, 0.005, epsilon) == Approx(0.5 * full));
  CHECK(smoothed_latch_moment(h, -0.02, -0.3, 0.02, epsilon) == Approx(full));
}

TEST_CASE("a smoothed latch's engagement quickens as its rate changes") {
  Draws draws(4);
  for (int k = 0; k < 100; ++k) {
    HingeTerms<double> h{};
    h.latched = draws.uniform(-1, 1), h.sense = draws.sign();
    const double epsilon = draws.log_uniform(1e-4, 1e-1), rate = draws.uniform(-2, 2), d = 1e-7;
    const double angle = h.latched + h.sense * epsilon * draws.uniform(-0.2, 1.2);
    const auto after = [&](double t) { return engagement_rate(h, angle + rate * t, epsilon); };
    CHECK(engagement_acceleration(h, angle, rate, epsilon) ==
          Approx((after(d) - after(-d)) / (2 * d))
              .epsilon(1e-4)
              .margin(1e-4 * std::abs(rate) / epsilon));
  }
}

TEST_CASE("a smoothed latch never exceeds its full load over a step, whose energy's slope it is") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Draws draws(seed);
    HingeTerms<double> hinge{};
    hinge.latched = draws.uniform(-1, 1), hinge.sense = draws.sign();
    hinge.stiffness = draws.log_uniform(1, 1e4);
    (seed % 2 ? hinge.damping : hinge.dissipation) = draws.log_uniform(0.1, 1e3);
    const double h = draws.log_uniform(1e-3, 1);
    Quintic<double> angle;
    for (double& c : angle) c = hinge.latched + draws.uniform(-0.1, 0.1);
    const Quintic<double> rate = derivative(angle, h);
    const double most = most_of_smoothed_latch(hinge, angle, rate);
    for (int k = 0; k <= 40; ++k) {
      const double s = k / 40.0, S = draws.uniform(0, 2);
      const double x = value(angle, s), v = value(rate, s), d = 1e-6;
      REQUIRE(std::abs(smoothed_latch_moment(hinge, x, v, S, 1.0)) <= most * (1 + 1e-12));
      CHECK((full_latch_energy(hinge, x - d) - full_latch_energy(hinge, x + d)) / (2 * d) ==
            Approx(smoothed_latch_moment(hinge, x, 0.0, 1.0, 1.0)).epsilon(1e-6).margin(1e-6));
    }
  }
}
