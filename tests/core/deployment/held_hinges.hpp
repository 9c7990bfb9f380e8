/// Holds and wings of the tests of hinges that are held.
#pragma once

#include "tests/core/deployment/real_runs.hpp"

#include <cmath>
#include <numbers>

namespace wingspread::oracle {

inline Release at_time(double time, double delay = 0) { return {.time = time, .delay = delay}; }

inline Release after(int hinge, Release::Event event, double delay = 0, double angle = 0) {
  return {.event = event, .after = hinge, .angle = angle, .delay = delay};
}

/// Two panels side by side on a fixed base, which do not feel each other.
inline Scene two_panels() {
  Scene scene = latching_panel();
  scene.bodies.push_back({"other_panel", 10, 0.5});
  Hinge other = scene.hinges[0];
  other.name = "other", other.child = 1, other.parent_point = {3, 1};
  scene.hinges.push_back(other);
  return scene;
}

inline double way_of_panel() {
  return std::sqrt(2 * (std::numbers::pi / 2) * panel_inertia / 2);
} // √(2ΘJ/τ), s

inline Outcome run_stalled(const Scene& scene, double t_end) {
  const Integration how = within(1e-10, t_end);
  const Outcome out = Deployment().run(scene, how, {});
  REQUIRE(out.status == Status::stalled);
  require_equal_bits({scene, scene, scene}, how, every_peak);
  return out;
}

} // namespace wingspread::oracle
