/// A wing of one panel whose latch time and stalls are known in closed form, and dispersions of it.
#pragma once

#include "montecarlo/analyses/rare/rare_event.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <string>
#include <vector>

namespace wingspread::test {

inline const auto nothing_told = [](const StudyProgress&) {};

/// A lid: a constant spring of 1.2 N·m turns it through 1.5 rad in √(2·1.5/1.2) s, for an inertia of 1 kg·m².
inline Json lid() {
  return parse_json(R"({
    "scene": { "name": "lid", "base": { "motion": "fixed" },
      "bodies": [ { "name": "lid", "mass": 3, "inertia": 0.25 } ],
      "hinges": [ { "name": "h", "parent": "base", "child": "lid", "parent_point": [0, 0],
                    "child_point": [-0.5, 0], "angle": { "stowed": 0, "latched": 1.5 },
                    "spring": { "torque_stowed": 1.2, "torque_latched": 1.2 },
                    "latch": { "stiffness": 2000, "dissipation": 0.3 }, "release": { "time": 0 } } ] },
    "sampling": { "runs": 400, "seed": 3 } })");
}

inline Json discrete_law(const std::string& name, const std::vector<double>& values,
                         const std::vector<double>& weights, const std::string& apply,
                         const std::string& to) {
  return {{"name", name},
          {"distribution", {{"type", "discrete"}, {"values", values}, {"weights", weights}}},
          {"apply", apply},
          {"to", {to}}};
}

inline Json normal_law(const std::string& name, double mean, double std, const std::string& apply,
                       const std::string& to) {
  return {{"name", name},
          {"distribution", {{"type", "normal"}, {"mean", mean}, {"std", std}}},
          {"apply", apply},
          {"to", {to}}};
}

inline RareResult estimate_of(const Json& campaign, RareOptions options) {
  ThreadEvaluator evaluator({.threads = 2}, never);
  return estimate_rare_event(campaign_of(campaign), options, evaluator, nothing_told);
}

/// n discrete dispersions whose last value has this probability.
inline Json rare_values(int count, double probability) {
  Json json = lid();
  json["dispersions"] = Json::array();
  for (int k = 0; k < count; ++k)
    json["dispersions"].push_back(discrete_law("d" + std::to_string(k), {1, 1.001},
                                               {1 - probability, probability}, "scale",
                                               "bodies.lid.inertia"));
  return json;
}

} // namespace wingspread::test
