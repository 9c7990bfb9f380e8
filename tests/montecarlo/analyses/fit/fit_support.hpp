/// For the tests of the fit: one panel with a constant torque, whose motion has a closed form.
#pragma once

#include "montecarlo/analyses/fit/fit_study.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <cmath>

namespace wingspread::test {

inline constexpr double panel_torque = 2, panel_travel = 1.5, panel_inertia = 0.5 + 10 * 0.25;

/// One panel that a spring of 2 N·m turns through 1.5 rad, with Coulomb friction of 0.3 N·m. Both are dispersed.
inline Json panel_campaign(double spring_std = 0.05, double friction_std = 0.3) {
  Json campaign = parse_json(R"({
    "scene": { "name": "panel", "base": { "motion": "fixed" },
      "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
      "hinges": [ { "name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                    "child_point": [-0.5, 0], "angle": { "stowed": 1.5, "latched": 0 },
                    "spring": { "torque_stowed": 2, "torque_latched": 2 },
                    "friction": { "coulomb": 0.3, "viscous": 0, "regularization_rate": 1e-6 },
                    "latch": { "stiffness": 1e4, "damping": 100 } } ] },
    "dispersions": [
      { "name": "spring", "distribution": { "type": "normal", "mean": 1, "std": 0 }, "apply": "scale",
        "to": ["hinges.root.spring.scale"] },
      { "name": "friction", "distribution": { "type": "normal", "mean": 1, "std": 0 }, "apply": "scale",
        "to": ["hinges.root.friction.scale"] } ],
    "integration": { "t_end": 20 }, "outputs": ["latch_time"], "sampling": { "runs": 100, "seed": 5 } })");
  campaign["dispersions"][0]["distribution"]["std"] = spring_std;
  campaign["dispersions"][1]["distribution"]["std"] = friction_std;
  return campaign;
}

/// The angle at a time before the latch. @param rate at the start, > 0: away from the latch
inline double panel_angle(double t, double spring, double friction, double rate = 0) {
  const double back = (panel_torque * spring - 0.3 * friction) / panel_inertia;
  const double out = (panel_torque * spring + 0.3 * friction) / panel_inertia;
  const double turn = rate / out;
  if (t < turn) return panel_travel + rate * t - out * t * t / 2;
  return panel_travel + rate * rate / (2 * out) - back * (t - turn) * (t - turn) / 2;
}

inline double panel_latch_time(double spring, double friction) {
  return std::sqrt(2 * panel_travel * panel_inertia / (panel_torque * spring - 0.3 * friction));
}

/// A trace of the closed form with noise, every 20 ms until 1.6 s.
inline std::string panel_trace(double spring, double friction, double rate, double std,
                               std::uint64_t seed) {
  std::string text = "t,th\n";
  RandomStream random(seed, 0, stream_name("trace"));
  for (int k = 0; k <= 80; ++k) {
    const double t = 0.02 * k;
    const double z = inverse(Normal{}, tails_of_uniform(open_uniform(random())));
    text +=
        std::to_string(t) + "," + csv_cell(panel_angle(t, spring, friction, rate) + std * z) + "\n";
  }
  return text;
}

inline FitResult fitted(const Campaign& campaign, const FitSpec& spec, FitOptions options = {},
                        BatchLog* log = nullptr) {
  options.pool.threads = options.pool.threads == 0 ? 1 : options.pool.threads;
  return fit_campaign(campaign, spec, options, never, log, [](const EnsembleState&) {});
}

/// One trace of the panel, in "t1.csv".
inline constexpr const char* one_way = R"({ "tests": [ { "name": "one way",
    "trace": { "file": "t1.csv", "time": "t", "correlated": false,
               "columns": { "root.angle": { "column": "th", "std": 0.005 } } } } ],
  "fit": { "parameters": ["spring", "friction"], "samples": 800, "starts": 2 } })";

/// The panel without friction, and with an initial rate of mean ± std. Its rate at the latch is the same for both senses
/// of the initial rate, so that a measured one has two modes.
inline Json two_mode_campaign(double mean, double std) {
  Json campaign = panel_campaign();
  campaign["scene"]["hinges"][0].erase("friction");
  campaign["dispersions"] = {{{"name", "rate"},
                              {"distribution", {{"type", "normal"}, {"mean", mean}, {"std", std}}},
                              {"apply", "set"},
                              {"to", {"hinges.root.initial_rate"}}}};
  campaign["outputs"] = {"latch_time", "latch_rate"};
  return campaign;
}

/// The test that measures the rate at the latch of an initial rate of ±0.8 rad/s.
inline Json two_mode_test() {
  Json tests = parse_json(R"({ "tests": [ { "name": "film",
      "values": [ { "output": "root.latch_rate", "value": 0, "std": 0.01 } ] } ],
    "fit": { "parameters": ["rate"], "samples": 400, "starts": 9 } })");
  tests["tests"][0]["values"][0]["value"] =
      -std::sqrt(2 * panel_torque / panel_inertia * panel_travel + 0.8 * 0.8);
  return tests;
}

} // namespace wingspread::test
