// Whether an engaged latch lets go: its load, by the moments that the latch exerts, and bounds of the load.
#include "core/laws/latch_laws.hpp"
#include "core/laws/linear_law.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A hinge that moves either way, with a latch that may let go.
struct HeldHinge {
  Hinge hinge;
  double sense;
  CaptureTerms<double> terms;

  explicit HeldHinge(std::uint64_t seed) {
    Draws draws(seed);
    hinge.stowed = draws.uniform(-2, 2);
    sense = draws.sign();
    hinge.latched = hinge.stowed + sense * draws.uniform(0.5, 2);
    Latch latch{draws.log_uniform(10, 1e3), 0, draws.chance(0.5) ? draws.uniform(0, 0.05) : 0};
    if (draws.chance(0.5))
      latch.dissipation = draws.log_uniform(0.1, 5);
    else
      latch.damping = draws.log_uniform(0.1, 10);
    latch.holding_moment = draws.log_uniform(0.1, 20);
    hinge.latch = latch;
    terms = capture_terms(hinge, sense);
  }

  /// Where the latch bears on its stowed side, rad.
  [[nodiscard]] double start() const { return hinge.latched - sense * hinge.latch->backlash / 2; }

  /// The moment towards the latched angle of the latch that bears on its stowed side, less the holding moment: by the
  /// laws that the right-hand side sums. A latch with dissipation has no linear damping.
  [[nodiscard]] double excess(double angle, double rate) const {
    HingeTerms<double> linear{};
    linear.latched = hinge.latched, linear.has_latch = true;
    linear.stiffness = hinge.latch->stiffness, linear.damping = hinge.latch->damping;
    double m = linear_moment(linear_law(linear, true, 0.0, std::optional(start() - hinge.latched)),
                             angle, rate);
    const LatchDissipationTerms<double> loss = dissipation_terms<double>(hinge);
    const double side = -sense;
    if (loss.present) LatchDissipation<double>{loss, side}.add_moment(m, angle, rate);
    return sense * m - *hinge.latch->holding_moment;
  }
};

} // namespace

TEST_CASE("a latch lets go where the moment that it exerts reaches its holding moment") {
  int opens = 0, holds = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const HeldHinge held(seed);
    Draws draws(seed + 1000);
    const double angle = held.start() - held.sense * draws.log_uniform(1e-4, 0.1);
    const double rate = draws.uniform(-2, 2), exact = held.excess(angle, rate);
    CAPTURE(seed, angle, rate);
    CHECK(held.terms.excess(angle, rate) == Approx(exact).epsilon(1e-9).margin(1e-9));
    CHECK(held.terms.lets_go(angle, rate) == (exact >= 0));
    ++(exact >= 0 ? opens : holds);
    const double beyond = held.start() + held.sense * 1e-6; // no load: in the backlash or further
    CHECK_FALSE(held.terms.lets_go(beyond, -held.sense * 1e3));
  }
  CHECK(std::min(opens, holds) >= 50);
}

TEST_CASE("the rate of a latch's load is its difference quotient along a motion") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const HeldHinge held(seed);
    Draws draws(seed + 2000);
    const double angle = held.start() - held.sense * draws.log_uniform(1e-3, 0.1);
    const double rate = draws.uniform(-2, 2), acceleration = draws.uniform(-10, 10), dt = 1e-6;
    const auto at = [&](double t) {
      return held.excess(angle + t * (rate + 0.5 * acceleration * t), rate + acceleration * t);
    };
    CAPTURE(seed);
    CHECK(held.terms.excess_rate(angle, rate, acceleration) ==
          Approx((at(dt) - at(-dt)) / (2 * dt)).epsilon(1e-6).margin(1e-4));
  }
}

TEST_CASE("the bound of a latch's load over angles and rates holds its samples, whichever way it "
          "deploys") {
  int reached = 0, outside = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const HeldHinge held(seed);
    Draws draws(seed + 3000);
    const double from = held.start() + held.sense * draws.uniform(-0.1, 0.03);
    const ValueRange<double> angle{from, from + draws.log_uniform(1e-3, 0.1)};
    const double slowest = draws.uniform(-2, 2);
    const ValueRange<double> rate{slowest, slowest + draws.log_uniform(1e-3, 2)};
    const double bound = held.terms.most_excess(angle, rate);
    double most = -std::numeric_limits<double>::infinity();
    constexpr int parts = 40;
    for (int k = 0; k <= parts; ++k)
      for (int l = 0; l <= parts; ++l) {
        const double x = std::lerp(angle.low, angle.high, k / double(parts));
        const double v = std::lerp(rate.low, rate.high, l / double(parts));
        if (held.terms.deflection(x) < 0) most = std::max(most, held.excess(x, v));
      }
    CAPTURE(seed, bound, most, rate.low, rate.high);
    CHECK(most <= bound + 1e-9 * (1 + std::abs(bound)));
    const bool bears =
        std::min(held.terms.deflection(angle.low), held.terms.deflection(angle.high)) < 0;
    if (!bears) {
      CHECK(bound == -*held.hinge.latch->holding_moment);
      ++outside;
    }
    // a damped latch: both terms are largest at one corner, and damping relieves one that moves towards its stop
    if (!bears || held.hinge.latch->dissipation) continue;
    CHECK(bound == Approx(most).epsilon(1e-9).margin(1e-9));
    ++reached;
  }
  CHECK(std::min(reached, outside) >= 20);
}
