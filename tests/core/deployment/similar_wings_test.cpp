// A wing does not know its units: with a number in place of a mass, an energy or a moment it would.
#include "core/deployment.hpp"
#include "tests/core/deployment/any_wing.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/similar_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using oracle::Units;

namespace {

/// The outcome in units of mass and length such that the original's moments and forces have these values.
Outcome converted(Outcome outcome, const Units& units) {
  for (auto* peaks : {&outcome.peak_moment, &outcome.hold_moment, &outcome.bending_moment})
    for (Peak& peak : *peaks) peak.value *= units.moment();
  for (Peak& peak : outcome.peak_force) peak.value *= units.force();
  for (double& energy : outcome.motor_energy) energy *= units.moment();
  outcome.final.base_position *= units.length, outcome.final.base_velocity *= units.length;
  EnergyAudit& audit = outcome.energy;
  for (double* energy : {&audit.initial, &audit.final, &audit.drift_before_first_latch})
    *energy *= units.moment();
  return outcome;
}

} // namespace

TEST_CASE("a wing in other units of mass and length deploys alike, bit for bit") {
  Integration how;
  how.t_end = 6, how.rtol = 1e-5;
  for (int seed = 1; seed <= random_cases(2000, 120); ++seed) {
    const Scene scene = oracle::any_wing(seed);
    // tolerances of a free base's place are absolute, and a table over time holds accelerations
    const bool other_length = scene.base.motion != BaseMotion::free && !scene.base.table;
    const Outcome out = Deployment().run(scene, how, {});
    for (const double mass : {0x1p-20, 0x1p40}) {
      // shorter: a trial step in which the wing flies apart may overflow, and is then refused otherwise
      const Units units{mass, other_length ? 0x1p-3 : 1.0};
      CAPTURE(seed, mass, out.reason);
      CHECK(oracle::bits_of(Deployment().run(oracle::in_units(scene, units), how, {})) ==
            oracle::bits_of(converted(out, units)));
    }
  }
}

TEST_CASE("a wing in another unit of mass deploys alike by every method, bit for bit") {
  Integration how;
  how.t_end = 1.5, how.rtol = 1e-5, how.step = 2e-3;
  int seed = 1;
  for (const MethodInfo& method : methods())
    for (int k = 0; k < 3; ++k, ++seed) {
      how.method = method.name;
      const Scene scene = oracle::any_wing(seed);
      const Units units{0x1p40};
      CAPTURE(method.name, seed);
      CHECK(oracle::bits_of(Deployment().run(oracle::in_units(scene, units), how, {})) ==
            oracle::bits_of(converted(Deployment().run(scene, how, {}), units)));
    }
}

// Tolerances of angles and rates have one number, so that other steps are made; two latches at one instant stay so.
TEST_CASE("a wing in other units of time latches at the same times, at one instant or one by one") {
  Scene turning = oracle::seed_scene();
  turning.base.motion = BaseMotion::prescribed, turning.base.rate = 0.1;
  turning.base.acceleration = {0.1, -0.2};
  for (const Scene& scene : {oracle::symmetric_tree(), oracle::two_wing_free_spacecraft(),
                             oracle::seed_scene(), turning}) {
    Integration how;
    how.t_end = 16, how.rtol = 1e-9, how.atol = 1e-11;
    const Outcome out = Deployment().run(scene, how, oracle::latches_only);
    REQUIRE(out.latches.size() >= 2);
    for (const double time : {0x1p-14, 0x1p14}) {
      Integration other = how;
      other.t_end *= time;
      other.atol *= std::max(1 / time, 1e-3); // of rates; angles need not be known better
      const Outcome alike =
          Deployment().run(oracle::in_units(scene, {.time = time}), other, oracle::latches_only);
      CAPTURE(scene.hinges.size(), time, out.reason, alike.reason);
      CHECK(alike.status == out.status);
      REQUIRE(alike.latches.size() == out.latches.size());
      for (std::size_t k = 0; k < out.latches.size(); ++k) {
        CAPTURE(k, out.latches[k].time, alike.latches[k].time / time);
        CHECK(alike.latches[k].time == Approx(out.latches[k].time * time).epsilon(1e-6));
        if (k > 0)
          CHECK((alike.latches[k].time == alike.latches[k - 1].time) ==
                (out.latches[k].time == out.latches[k - 1].time));
      }
    }
  }
}
