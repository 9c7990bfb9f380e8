/// Runs of scenes with real hinges, alone and in packs, and helpers of their tests.
#pragma once

#include "tests/core/packs/same_bits.hpp"
#include "tests/support/real_closed_forms.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

namespace wingspread::oracle {

/// Runs a scene by `auto` with all outputs, and CHECKs that the lanes of every pack give the same bits.
inline Outcome run_everywhere(const Scene& scene, double rtol, double t_end,
                              bool to_t_end = false) {
  Goal goal;
  goal.to_t_end = to_t_end;
  const Integration how = within(rtol, t_end);
  const Outcome out = Deployment().run(scene, how, goal);
  INFO(to_string(out.status) << " " << out.reason);
  REQUIRE((out.status == Status::deployed || out.status == Status::timed_out));
  CHECK(finite(out));
  const std::string alone = bits_of(out);
  for (const InstructionSet set : instruction_sets())
    for (const auto& [name, bits] : in_lanes(set, {3, scene}, how, goal)) {
      CAPTURE(to_string(set), name);
      CHECK(bits == alone);
    }
  return out;
}

/// Checks time and rate of a run's only latch; the rate may have either sign.
inline void check_arrival(const Outcome& out, const Arrival& exact, double tolerance) {
  REQUIRE(out.latches.size() == 1);
  CAPTURE(out.latches[0].time, exact.time, out.latches[0].rates[0], exact.rate);
  CHECK(relative(out.latches[0].time, exact.time) < tolerance);
  CHECK(relative(std::abs(out.latches[0].rates[0]), std::abs(exact.rate)) < tolerance);
}

/// A panel with initial rate `rate`, 1 rad before a latch that exerts no moment: the latch only records the arrival.
inline Scene thrown_panel(double rate = 1) {
  Scene scene = free_panel(0, rate);
  scene.hinges[0].latch = Latch{};
  return scene;
}

/// A reference run in extended precision, with tolerances for the jumps of real hinges (reference_run.hpp).
inline ReferenceOutcome real_reference(const Scene& scene, double t_end) {
  ReferenceOptions options;
  options.t_end = t_end;
  options.rtol = 1e-13, options.atol = 1e-14;
  return high_precision_run<long double>(scene, options);
}

/// The mirror image of the scene: every angle changes its sign.
inline Scene other_sense(Scene scene) {
  for (Hinge& hinge : scene.hinges) {
    hinge.parent_point.y() *= -1, hinge.child_point.y() *= -1;
    hinge.stowed *= -1, hinge.latched *= -1, hinge.initial_rate *= -1;
    if (hinge.damper && hinge.damper->window)
      for (double& edge : *hinge.damper->window) edge *= -1;
  }
  for (Body& body : scene.bodies)
    if (body.plate) body.plate->from.y() *= -1, body.plate->to.y() *= -1;
  scene.environment.gravity.y() *= -1;
  return scene;
}

} // namespace wingspread::oracle
