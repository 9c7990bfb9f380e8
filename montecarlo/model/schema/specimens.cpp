#include "montecarlo/model/schema/schema.hpp"

#include <array>

// A new key of a reader needs a specimen: a test lists the keys, and the words that decide on keys, that no specimen
// has. A value that may be text or a number is in the specimens both ways.
namespace wingspread {
namespace {

constexpr std::array<std::string_view, 6> scenes{
    R"({
  "$schema": "scene.schema.json", "name": "on a fixed base", "base": { "motion": "fixed" },
  "bodies": [
    { "name": "inner", "mass": "10 kg", "inertia": 0.5,
      "plate": { "from": [-0.5, 0], "to": [0.5, 0], "width": 2, "drag_coefficient": 1.9 } },
    { "name": "outer", "mass": 8, "inertia": 0.25 } ],
  "hinges": [
    { "name": "root", "parent": "base", "child": "inner", "parent_point": [0, 0], "child_point": [-0.5, 0],
      "angle": { "stowed": "90 deg", "latched": 0 }, "initial_rate": 0,
      "spring": { "measured": { "angle": [1.6, 0.8, 0], "deploying": [1.9, 1.5, 1.2], "stowing": [2.1, 1.9, 1.5] },
                  "interpolation": "linear", "scale": 1.1, "offset": 0.01 },
      "harness": { "table": { "angle": [1.6, 0], "torque": [0.1, 0.3] }, "interpolation": "monotone", "scale": 1,
                   "offset": 0 },
      "friction": { "model": "regularized", "coulomb": 0.1, "viscous": 0.01, "regularization_rate": 0.002,
                    "scale": 1 },
      "damper": { "law": "power", "coefficient": 3, "exponent": 0.45, "regularization_rate": 1e-5,
                  "window": [1, 0.25], "scale": 0.7 },
      "stop": { "stiffness": 500, "dissipation": 0.2, "gap": 0.01, "side": "stowed" },
      "latch": { "stiffness": 10000, "damping": 100, "backlash": 0.002, "capture_rate": 1, "holding_moment": 12 },
      "motor": { "rate": { "table": { "time": [0, 1, 60], "rate": [0, 0.05, 0.05] }, "interpolation": "linear",
                           "scale": 1 }, "gain": 40, "torque_limit": "5 N*m" },
      "release": { "after": "mid", "event": "latched", "delay": 0.1, "fails": 0 },
      "hold": { "stiffness": 2000, "damping": 3 } },
    { "name": "mid", "parent": "inner", "child": "outer", "parent_point": [0.5, 0], "child_point": [-0.5, 0],
      "angle": { "stowed": -3, "latched": 0 },
      "spring": { "torque_stowed": 1, "torque_latched": 0.5, "scale": 1, "offset": 0 },
      "harness": { "torque_stowed": 0.1, "torque_latched": 0.1, "scale": 1, "offset": 0 },
      "damper": { "law": "eddy_current", "peak_torque": 2, "peak_rate": 4, "window": [1, 0], "scale": 1 },
      "stop": [ { "stiffness": 500, "dissipation": 0.2, "gap": 0.01, "side": "stowed" },
                { "stiffness": 500, "dissipation": 0.2, "gap": 0.01, "side": "latched" } ],
      "initial_rate": 0,
      "latch": { "stiffness": 10000, "dissipation": 0.5 },
      "motor": { "rate": "2 deg/s", "gain": 40, "torque_limit": 5 },
      "release": { "after": "root", "event": { "angle": "45 deg" }, "delay": 0.1, "fails": 0 } } ],
  "synchronisations": [
    { "name": "loop", "between": ["root", "mid"], "ratio": 2, "stiffness": 300, "damping": 0.5, "preload": 8 },
    { "name": "cam", "between": ["mid", "root"], "stiffness": 100,
      "ratio": { "table": { "travel": [0, 1, 3], "travel_of_second": [0, 0.6, 1.5] } } } ],
  "environment": { "gravity": [0.1, -9.81], "air_density": 1.2 } })",
    R"({
  "name": "on a free base",
  "base": { "motion": "free", "mass": 500, "inertia": 100, "position": [0, 0], "velocity": [0, 0], "angle": 0,
            "rate": 0 },
  "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
  "hinges": [
    { "name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0], "child_point": [-0.5, 0],
      "angle": { "stowed": 1.5, "latched": 0 },
      "spring": { "table": { "angle": [1.5, 0], "torque": [2, 1.4] }, "interpolation": "monotone" },
      "friction": { "model": "exact", "coulomb": 0.1, "static": 0.12 },
      "damper": { "law": "viscous", "coefficient": 0.1, "window": [1, 0], "scale": 1 },
      "stop": { "stiffness": 500, "side": "latched" } } ] })",
    R"({
  "name": "on a base with a table of accelerations",
  "base": { "motion": "prescribed", "angle": 0, "rate": 0, "interpolation": "linear",
            "table": { "time": [0, 1], "acceleration": [[0, 0], [1, 0]], "angular_acceleration": [0, 0.1],
                       "scale": 1 } },
  "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
  "hinges": [ { "name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                "child_point": [-0.5, 0], "angle": { "stowed": 1.5, "latched": 0 } } ] })",
    R"({
  "name": "on a base that turns",
  "base": { "motion": "prescribed", "acceleration": [0, 0], "angular_acceleration": 0.1, "angle": 0, "rate": 0 },
  "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
  "hinges": [ { "name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                "child_point": [-0.5, 0], "angle": { "stowed": 1.5, "latched": 0 },
                "release": { "time": "0.5 s", "delay": 0.1, "fails": 0 } } ] })",
    R"({
  "name": "on a base with a table of rates",
  "base": { "motion": "prescribed", "acceleration": [0, 0], "angle": 0, "table": { "time": [0, 1], "rate": [0, 0.1] } },
  "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
  "hinges": [ { "name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                "child_point": [-0.5, 0], "angle": { "stowed": 1.5, "latched": 0 } } ] })",
    R"({
  "name": "bends, with a mirrored wing",
  "base": { "motion": "fixed" },
  "bodies": [
    { "name": "R_yoke", "mass": 3, "inertia": 0.3,
      "plate": { "from": [-0.5, 0], "to": [0.5, 0], "width": 1, "drag_coefficient": 0 },
      "flexible": { "joints": 2, "bending_stiffness": 500, "damping_ratio": 0.01 } },
    { "name": "R_panel", "mass": 8, "inertia": 0.8,
      "plate": { "from": [-0.5, 0], "to": [0.5, 0], "width": 1, "drag_coefficient": 0 },
      "flexible": { "joints": 4, "frequency": "8 Hz", "damping_ratio": 0.01 } } ],
  "hinges": [
    { "name": "R_root", "parent": "base", "child": "R_yoke", "parent_point": [1, 0], "child_point": [-0.5, 0],
      "angle": 0, "initial_rate": 0, "joint": { "stiffness": 1000, "damping": 1 } },
    { "name": "R_hinge", "parent": "R_yoke", "child": "R_panel", "parent_point": [0.5, 0], "child_point": [-0.5, 0],
      "angle": { "stowed": 3, "latched": 0 }, "latch": { "stiffness": 10000, "damping": 100 } } ],
  "mirror": { "of": "R_*", "as": "L_*" } })"};

// A campaign without a scene gets the first scene.
constexpr std::array<std::string_view, 4> campaigns{R"({
  "dispersions": [
    { "name": "a", "distribution": { "type": "normal", "mean": "10 g", "std": "1 g",
                                     "truncate": { "lower": "1 g", "upper": "20 g" } },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "b", "distribution": { "type": "uniform", "lower": "1 g", "upper": "2 g", "truncate": { "lower": 0.0011 } },
      "apply": "add", "each": "bodies.*.mass" },
    { "name": "c", "distribution": { "type": "triangular", "lower": "1 g", "mode": "2 g", "upper": "3 g",
                                     "truncate": { "upper": 0.0029 } },
      "apply": "add", "each": ["bodies.*.mass"] },
    { "name": "d", "distribution": { "type": "lognormal", "mu_log": 0, "sigma_log": 0.1, "truncate": { "upper": 2 } },
      "apply": "scale", "to": ["hinges.*.spring.scale"] },
    { "name": "e", "distribution": { "type": "weibull", "shape": 2, "scale": "1 g", "truncate": { "upper": 2 } },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "f", "distribution": { "type": "gamma", "shape": 2, "scale": "1 g", "truncate": { "upper": 2 } },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "g", "distribution": { "type": "beta", "alpha": 2, "beta": 2, "lower": "1 g", "upper": "2 g",
                                     "truncate": { "upper": 0.0019 } },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "h", "distribution": { "type": "exponential", "rate": 1000, "truncate": { "upper": 2 } },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "i", "distribution": { "type": "discrete", "values": ["1 g", "2 g"], "weights": [1, 2] },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "j", "distribution": { "type": "empirical", "values": ["1 g", "2 g"] },
      "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "k", "distribution": { "type": "constant", "value": "1 g" }, "apply": "add", "to": ["bodies.inner.mass"] },
    { "name": "l", "distribution": { "type": "normal", "mean": 20, "std": 5 },
      "through": [ { "to": ["hinges.*.spring.scale"], "apply": "scale",
                     "table": { "at": [0, 40], "value": [1, 0.9] } },
                   { "to": ["bodies.inner.mass"], "apply": "add",
                     "table": { "at": [0, 40], "value": ["1 g", "2 g"] } } ] },
    { "name": "m", "distribution": { "type": "normal", "mean": 1, "std": 0.1 }, "apply": "scale",
      "to": ["hinges.root.harness.scale"] },
    { "name": "measured",
      "rows": { "values": { "n": [1, 1.1], "o": [0.9, 1], "p": [1, 2], "q": [20, 30] }, "apply": "scale",
                "columns": { "n": "hinges.mid.spring.scale", "o": ["hinges.mid.friction.scale"],
                             "p": { "to": ["hinges.mid.friction.coulomb"], "apply": "add" },
                             "q": { "through": [ { "to": ["hinges.*.spring.scale"], "apply": "scale",
                                                   "table": { "at": [0, 40], "value": [1, 0.9] } } ] } } } } ],
  "correlations": [ { "between": ["a", "d"], "spearman": 0.5 }, { "between": ["l", "m"], "covariance": 0.2 } ],
  "cases": [ { "name": "cold", "set": { "bodies.outer.mass": "8 kg" }, "scale": { "hinges.root.spring.scale": 0.9 },
               "add": { "hinges.mid.initial_rate": 0 },
               "distributions": { "l": { "type": "normal", "mean": -60, "std": 3 } } } ],
  "sampling": { "design": "random", "runs": 1000, "seed": 1, "replicates": 1 },
  "integration": { "method": "auto", "rtol": 1e-8, "atol": 1e-9, "latch": "event", "t_end": "60 s",
                   "max_steps": 100000 },
  "outputs": ["latch_time", "latch_rate", "peak_moment", "peak_force", "rate_at", "overtravel", "peaks_final", "frequency",
              "hold_moment", "captures", "held", "final_angle", "motor_energy"],
  "statistics": { "quantiles": [0.5], "confidence": 0.95, "bins": "auto", "accuracy_runs": 24,
                  "tolerance": [ { "probability": 0.99, "confidence": 0.9, "side": "upper" } ] },
  "requirements": [
    { "name": "moment", "output": "root.peak_moment", "max": "400 N*m", "abs": true, "probability": 0.99,
      "confidence": 0.9, "group": "A", "id": "SYS-1", "source": "specification 4.2", "rationale": "root fitting" },
    { "output": "root.latch_rate", "min": -3, "probability": 0.99, "confidence": 0.9 },
    { "output": "mode_1.frequency", "min": "0.3 Hz", "probability": 0.99, "confidence": 0.9 },
    { "name": "margin", "motorization": "NASA", "hinge": "*", "min": 0, "probability": 0.99, "confidence": 0.9,
      "group": "A" } ],
  "report": { "title": "wing", "author": "A", "organisation": "B", "document": "C", "revision": "D", "date": "E" },
  "until": [ { "output": "root.peak_moment", "quantile": 0.5, "width": "5 N*m" },
             { "output": "root.peak_moment", "quantile": 0.5, "relative_width": 0.02 },
             { "output": "deployed", "width": 0.01 }, { "requirement": "moment" } ],
  "margin": { "scale": ["hinges.*.spring.scale"], "range": [0.5, 2], "widest": [0.1, 10], "mode": "joint", "points": 5,
              "tolerance": 0.01, "cases": ["nominal", "one_spring_out"], "springs_per_hinge": 2,
              "motorization": { "points": 11 } } })",
                                                    R"({
  "$schema": "campaign.schema.json", "case": "cold", "wingspread": { "version": "0.1.0", "seed": 1, "hash": "0" },
  "sampling": { "design": "random", "runs": 1000, "seed": 1, "extended_from": [100] },
  "integration": { "method": "runge_kutta4", "step": 1e-4, "rtol": 1e-7, "latch": { "smoothed": 1e-3 } },
  "statistics": { "bins": 20 },
  "motorization": {
    "ecss": { "basis": "measured", "inertia": 1, "spring": 1, "motor": 1, "friction": 1, "hysteresis": 1, "harness": 1,
              "adhesion": 1, "motorization": 2, "acceleration": 1, "available": 1 },
    "nasa": { "basis": "acceptance", "fixed": 1, "variable": 1 },
    "gevs": { "phase": "test", "known": 1, "variable": 1 },
    "aiaa": { "phase": "test", "known": 1, "variable": 1 },
    "torques": { "root": { "inertia": 0.1, "motor": 0, "hysteresis": 0, "adhesion": 0, "acceleration": 0,
                           "delivered": 0 } },
    "rates": { "root": 0.1 }, "points": 11, "springs_per_hinge": 2 } })",
                                                    R"({ "scene": "no_such_file.json" })",
                                                    R"({
  "dispersions": [ { "name": "file", "distribution": { "type": "empirical", "file": "no_such_file.csv", "column": "x",
                                                       "truncate": { "lower": 0 } },
                     "apply": "set", "to": ["bodies.inner.mass"] },
                   { "name": "rows", "rows": { "file": "no_such_file.csv", "apply": "set",
                                               "columns": { "y": "bodies.outer.mass" } } } ] })"};

} // namespace

std::vector<Json> scene_specimens() {
  std::vector<Json> all;
  for (const std::string_view text : scenes) all.push_back(parse_json(std::string(text)));
  return all;
}

std::vector<Json> campaign_specimens() {
  const std::vector<Json> scenes_alone = scene_specimens();
  std::vector<Json> all;
  for (const std::string_view text : campaigns) {
    all.push_back(parse_json(std::string(text)));
    if (!all.back().contains("scene")) all.back()["scene"] = scenes_alone[0];
  }
  for (const Json& scene : scenes_alone) all.push_back({{"scene", scene}});
  return all;
}

} // namespace wingspread
