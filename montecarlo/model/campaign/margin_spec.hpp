/// What the `margin` of a campaign asks for: which springs to size, and in what range of strength.
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

/// Whether all parameters are scaled together, or those of one hinge at a time.
enum class MarginMode { joint, each };
inline constexpr std::array<std::string_view, 2> margin_mode_names{"joint", "each"};

struct MarginSpec {
  std::vector<SceneParameter> scaled; ///< each once, in the order given; at least one
  double lower = 0, upper = 0;        ///< of the scale: 0 < lower < upper
  double lowest = 0,
         highest = 0; ///< how far it may be widened: 0 < lowest ≤ lower, highest ≥ upper
  MarginMode mode = MarginMode::joint;
  std::int64_t points = 13;     ///< scales looked at first, from end to end, ≥ 2
  double edge_tolerance = 0.01; ///< how closely an edge is located, relative, in (0, 1)
  bool nominal = true;          ///< the case of the wing as it is
  bool one_spring_out = false;  ///< the cases with a spring lost, each hinge in turn
};

/// Reads it and notes what is wrong.
/// @param scene null when it has problems of its own: then paths and hinges are not looked up
/// @param motorization what it says of the static margins, with the springs of a hinge
[[nodiscard]] MarginSpec read_margin(const JsonCursor& at, const Scene* scene,
                                     StaticMarginSpec& motorization);

[[nodiscard]] Json write_margin(const MarginSpec& margin, const StaticMarginSpec& motorization,
                                const Scene& scene);

/// What a hinge's spring is scaled by: its torques, stowed and latched, or the scale of its table.
[[nodiscard]] std::vector<SceneParameter> spring_torques(const Scene& scene, int hinge);
/// Whether one of the parameters is among these, or the scale of a spring without a table.
[[nodiscard]] bool sizes_spring(std::span<const SceneParameter> scaled, const Scene& scene,
                                int hinge);

} // namespace wingspread
