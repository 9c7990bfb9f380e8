// The load of a sticking hinge between the ends of steps, and releases that no sample shows.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/core/events/rubbed_wings.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Two discs that swing as one, φ = cos t + sin t/2: the second hinge, which sticks, bears
/// 2 φ̈, at most √5.
Scene swinging_discs(double coulomb, double static_level) {
  Scene scene = coaxial_discs(3, 2);
  scene.hinges[0].stowed = 1, scene.hinges[0].latched = -50, scene.hinges[0].initial_rate = 0.5;
  pull_towards(scene.hinges[0], 0, 5);
  rub(scene.hinges[1], coulomb, static_level);
  return scene;
}

/// A panel that sticks on a base which turns at Ω and is pushed, so that its hinge bears
/// 1.5 sin Ωt N·m.
Scene turning_panel(double rate, double limit) {
  Scene scene = latching_panel();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.rate = rate;
  Hinge& hinge = scene.hinges[0];
  hinge.spring = {0, 0};
  const Eigen::Vector2d arm = -hinge.child_point; // in the panel's frame
  const double turned = hinge.stowed + std::atan2(arm.y(), arm.x());
  // the load of a push a is m |c| a sin(angle from the push to the arm)
  const double push = 1.5 / (scene.bodies[0].mass * arm.norm());
  scene.base.acceleration = push * Eigen::Vector2d(std::cos(turned), std::sin(turned));
  rub(hinge, limit / 2, limit);
  return scene;
}

/// The last sample at which the hinge has not moved.
double held_until(const std::vector<Sample>& samples, int hinge) {
  double last = 0;
  for (const Sample& sample : samples) {
    if (sample.rates[hinge] != 0) break;
    last = sample.t;
  }
  return last;
}

} // namespace

TEST_CASE("the most that a stuck hinge bears is found inside steps, to every method's accuracy") {
  const Scene scene = swinging_discs(10, 10);
  const double exact = std::sqrt(5);
  for (const double rtol : {1e-3, 1e-6, 1e-8, 1e-10})
    with_every_method(scene, within(rtol, 12), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        // the swing's own size is off by what its steps lose, no more than:
                        const double off = astray(within(rtol, 12), out.work.steps, 1);
                        CHECK(std::abs(out.peak_moment[1].value - exact) < 5 * off + 1e-9);
                      });
  Integration how = within(1e-6, 12);
  const Outcome out = Deployment().run(scene, how, to_the_end);
  CHECK(std::abs(out.peak_moment[1].value - exact) < 1e-8); // −6e-4 by samples at quarters
}

TEST_CASE("a release that the load passes by 8e-6 is not missed at any tolerance") {
  const double limit = 2.23605, exact = std::atan(0.5) - std::acos(limit / std::sqrt(5));
  const Scene scene = swinging_discs(1, limit);
  for (const double rtol : {1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    std::vector<Sample> samples;
    (void)Deployment().run(scene, within(rtol, 1), to_the_end,
                           [&](const Sample& sample) { samples.push_back(sample); });
    CAPTURE(rtol);
    // a load of 2e-9 above the limit counts as within it: 2e-9/sin(exact − crest) = 5e-7 s
    CHECK(std::abs(held_until(samples, 1) - exact) < 1e-6 + rtol);
  }
}

// Inside a long step the dense output is too low at a crest, by φ h⁶/46080. If the method's own step to the crest finds a
// load above the limit, the hinge is released at the instant at which the load passes the limit.
TEST_CASE(
    "a load that the dense output has below the limit, and the method's step above, releases") {
  int judged = 0;
  for (const double rtol : {1e-3, 3e-4, 1e-4})
    for (const double rate : {0.5, 0.8, 1.1, 1.4, 1.7}) {
      const auto swinging = [&](double limit) {
        Scene scene = swinging_discs(0.5 * limit, limit);
        scene.hinges[0].initial_rate = rate;
        return scene;
      };
      const double crest = std::atan(rate); // of cos t + rate · sin t
      const Integration how = within(rtol, crest + 0.3);
      const Peak borne = Deployment().run(swinging(10), how, to_the_end).peak_moment[1];
      REQUIRE(borne.time == Approx(crest).margin(10 * rtol));
      for (const double below : {1e-7, 1e-6}) {
        std::vector<Sample> samples;
        const Outcome out =
            Deployment().run(swinging(borne.value * (1 - below)), how, to_the_end,
                             [&](const Sample& sample) { samples.push_back(sample); });
        CAPTURE(rtol, rate, below);
        CHECK(out.final.rates[1] != 0);
        const double early = std::sqrt(2 * below); // cos x = 1 − below
        const double ahead = borne.time - held_until(samples, 1);
        CHECK(ahead > 0.3 * early); // before the crest, and not when the step to it is over
        CHECK(ahead < 3 * early);
        ++judged;
      }
    }
  CHECK(judged == 30);
}

TEST_CASE("a load that stays below the limit by 1e-6 of it releases nothing") {
  const Scene scene = swinging_discs(1, std::sqrt(5) * (1 + 1e-6));
  for (const double rtol : {1e-8, 1e-10}) {
    const Outcome out = Deployment().run(scene, within(rtol, 20), to_the_end);
    CHECK(out.final.rates[1] == 0);
    CHECK(out.final.angles[1] == 0);
  }
}

TEST_CASE("a turning base tears a panel loose at the load's own instant") {
  for (const double rate : {0.1, 1.0, 3.0})
    for (const double part : {0.8, 0.9, 0.99, 1 - 1e-4}) {
      const Scene scene = turning_panel(rate, 1.5 * part);
      const double exact = std::asin(part) / rate, t_end = rate < 1 ? 25 : 60;
      REQUIRE(exact < t_end);
      for (const char* method : {"auto", "cash_karp54", "dop853", "seulex"}) {
        Integration how = within(1e-6, t_end);
        how.method = method;
        std::vector<Sample> samples;
        (void)Deployment().run(scene, how, to_the_end,
                               [&](const Sample& sample) { samples.push_back(sample); });
        CAPTURE(rate, part, method);
        // nothing moves before, so that only the search for the instant can be off; 2e-9 of the limit
        // counts as within it
        CHECK(std::abs(held_until(samples, 0) - exact) < 3e-7 / rate);
      }
    }
}

TEST_CASE("the largest load of a panel that a turning base does not tear loose is its crest") {
  for (const double rate : {0.1, 1.0, 3.0}) {
    const Scene scene = turning_panel(rate, 2);
    with_every_method(scene, within(1e-6, rate < 1 ? 25 : 60), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        CHECK(out.final.rates[0] == 0);
                        CHECK(std::abs(out.peak_moment[0].value - 1.5) < 1e-9);
                        CHECK(std::abs(std::sin(rate * out.peak_moment[0].time)) > 1 - 1e-8);
                      });
  }
}

// Two discs turn as one under 1 N·m and a detent, 1 + D at its middle. The second bears 2/5 of the torque. Work and angle of
// the release follow from its limit, 2/5 (1 + share D). A step that leaps over the detent shows nothing of the load inside.
TEST_CASE("a detent tears a stuck hinge loose at its own angle, however narrow the detent") {
  Draws draws(11);
  for (int k = 0; k < random_cases(100, 10); ++k) {
    const double half_width = draws.log_uniform(1e-5, 1e-2), middle = draws.uniform(0.05, 0.9);
    const double D = draws.uniform(0.1, 1) * std::min(100.0, 0.05 / half_width);
    const double share = draws.uniform(0.05, 0.95), limit = 0.4 * (1 + share * D);
    Scene scene = coaxial_discs(3, 2);
    scene.hinges[0].spring.table =
        torque_table({0, middle - half_width, middle, middle + half_width, 1}, {1, 1, 1 + D, 1, 1},
                     Interpolation::linear);
    rub(scene.hinges[1], 0.2 * limit, limit);
    const double angle = middle - half_width * (1 - share);
    const double rate = std::sqrt(2 * (angle + 0.5 * half_width * share * share * D) / 5);
    (void)run_everywhere(scene, 1e-6, 3.5, true); // the same in lanes
    for (const double rtol : {1e-6, 1e-9})
      for (const char* method : {"auto", "dopri5", "dop853", "cash_karp54", "seulex"}) {
        Integration how = within(rtol, 3.5);
        how.method = method;
        Sample last;
        bool moved = false;
        const Outcome out = Deployment().run(scene, how, to_the_end, [&](const Sample& sample) {
          moved = moved || sample.rates[1] != 0;
          if (!moved) last = sample;
        });
        CAPTURE(k, half_width, middle, D, share, rtol, method, out.reason);
        REQUIRE(moved);
        CHECK(std::abs(last.angles[0] - angle) < 1e-5 * half_width + 1e-12);
        CHECK(relative(last.rates[0], rate) < 30 * rtol);
      }
  }
}
