// A wing does not know its units: with a number in place of a mass, an energy or a moment it would.
#include "core/deployment.hpp"
#include "tests/core/deployment/any_wing.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/similar_scenes.hpp"

#include <catch2/catch.hpp>

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
      const Units units{mass, other_length ? 0x1p3 : 1.0};
      CAPTURE(seed, mass, out.reason);
      CHECK(oracle::bits_of(Deployment().run(oracle::in_units(scene, units), how, {})) ==
            oracle::bits_of(converted(out, units)));
    }
  }
}
