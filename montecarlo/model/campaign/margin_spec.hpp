/// The campaign's key `margin`: the springs to size, and the range of their scale.
///
///     "margin": { "scale": ["hinges.*.spring.torque_stowed", "hinges.*.spring.torque_latched"],
///                 "range": [0.5, 2], "widest": [0.0625, 16], "mode": "joint", "points": 13, "tolerance": 0.01,
///                 "cases": ["nominal", "one_spring_out"], "springs_per_hinge": 2,
///                 "motorization": { … } }                         as in static_margin_spec.hpp
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "montecarlo/model/static_margins/static_margin_spec.hpp"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace wingspread {

/// Whether the study scales all parameters together (joint), or those of one hinge at a time (each).
enum class MarginMode { joint, each };
inline constexpr std::array<std::string_view, 2> margin_mode_names{"joint", "each"};

struct MarginSpec {
  std::vector<SceneParameter> scaled; ///< each once, in the order given; at least one
  double lower = 0, upper = 0;        ///< of the scale: 0 < lower < upper
  double lowest = 0,
         highest = 0; ///< limits of widening the range: 0 < lowest ≤ lower, highest ≥ upper
  MarginMode mode = MarginMode::joint;
  std::int64_t points = 13;     ///< scales of the first grid, both ends included, ≥ 2
  double edge_tolerance = 0.01; ///< relative width to which an edge is located, in (0, 1)
  bool nominal = true;          ///< study the wing with all springs
  bool one_spring_out = false;  ///< study wings with one spring lost, one wing for each hinge
};

/// Reads the key `margin` and notes problems.
/// @param scene        null if the scene has problems: then paths and hinges are not looked up
/// @param motorization receives the factors of the static margins and the springs of a hinge
[[nodiscard]] MarginSpec read_margin(const JsonCursor& at, const Scene* scene,
                                     StaticMarginSpec& motorization);

[[nodiscard]] Json write_margin(const MarginSpec& margin, const StaticMarginSpec& motorization,
                                const Scene& scene);

/// The parameters that together scale a hinge's spring, with its offset: its torques stowed and latched, or the scale
/// of its table.
[[nodiscard]] std::vector<SceneParameter> spring_torques(const Scene& scene, int hinge);
/// Whether one of the parameters scales the hinge's spring (its scale counts too).
[[nodiscard]] bool sizes_spring(std::span<const SceneParameter> scaled, const Scene& scene,
                                int hinge);
/// Whether the parameter scales the spring of its hinge.
[[nodiscard]] bool sizes_a_spring(const SceneParameter& parameter, const Scene& scene);

} // namespace wingspread
