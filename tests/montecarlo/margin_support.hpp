/// For tests of margins: a wing with a closed-form solution.
#pragma once

#include "montecarlo/analyses/margin/margin_study.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

namespace wingspread::test {

/// One panel with friction f and a spring torque that falls from 2a N·m (stowed) to 0.2a (latched). It reaches its latch
/// if the mean torque 1.1a exceeds f. The work done over the travel π/2 then gives the latch rate √(π (1.1 a − f)/J).
inline Json one_panel_margin(int runs) {
  Json campaign = parse_json(R"({
    "scene": { "name": "one_panel", "base": { "motion": "fixed" },
      "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
      "hinges": [ { "name": "root", "parent": "base", "child": "panel",
        "parent_point": [0, 0], "child_point": [-0.505, 0.02],
        "angle": { "stowed": 1.5707963267948966, "latched": 0 },
        "spring": { "torque_stowed": 2.0, "torque_latched": 0.2 },
        "friction": { "model": "exact", "coulomb": 0.8, "static": 0.8 },
        "latch": { "stiffness": 1e4, "damping": 100 } } ] },
    "dispersions": [
      { "name": "spring", "distribution": { "type": "normal", "mean": 1, "std": 0.05 },
        "apply": "scale",
        "to": ["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"] },
      { "name": "friction", "distribution": { "type": "normal", "mean": 0, "std": 0.03 },
        "apply": "add",
        "to": ["hinges.root.friction.coulomb", "hinges.root.friction.static"] },
      { "name": "mass", "distribution": { "type": "uniform", "lower": 9, "upper": 11 },
        "apply": "set", "to": ["bodies.panel.mass"] } ],
    "integration": { "rtol": 1e-6, "atol": 1e-8 },
    "outputs": ["latch_time", "latch_rate", "peak_moment"],
    "requirements": [
      { "output": "deployed", "probability": 0.97, "confidence": 0.9 },
      { "output": "root.latch_rate", "min": -0.8, "probability": 0.97, "confidence": 0.9 } ],
    "margin": { "scale": ["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"],
                "range": [0.5, 2] } })");
  campaign["sampling"] = {{"runs", runs}, {"seed", 3}};
  return campaign;
}

/// Numbers of draws that break each of the two requirements, with scaled springs.
struct ClosedForm {
  long not_deployed = 0, too_fast = 0; ///< too_fast: also those not deployed
};
inline ClosedForm closed_form(const Campaign& campaign, double scale, double limit = 0.8) {
  const RunPlan plan(campaign);
  std::vector<double> draws(campaign.dispersions.size());
  ClosedForm count;
  for (long run = 0; run < campaign.sampling.runs; ++run) {
    plan.draw(run, draws);
    const double inertia = 0.5 + draws[2] * (0.505 * 0.505 + 0.02 * 0.02);
    const double left = 1.1 * scale * draws[0] - (0.8 + draws[1]);
    if (left <= 0) ++count.not_deployed;
    if (left <= 0 || std::sqrt(3.14159265358979324 * left / inertia) > limit) ++count.too_fast;
  }
  return count;
}

inline MarginResult margin_of(const Campaign& campaign, int threads = 2) {
  MarginResult result;
  ThreadEvaluator evaluator({.threads = threads}, never);
  find_margin(
      campaign, evaluator, [](const StudyProgress&) {}, result);
  return result;
}

/// @pre there is exactly one window
inline const Window& only_window(const std::vector<Window>& windows) {
  REQUIRE(windows.size() == 1);
  return windows.front();
}

} // namespace wingspread::test
