/// The key `motorization`, of a campaign or of its `margin`: the factors of the static margins.
///
///     "motorization": { "ecss": { "basis": "theoretical", "friction": 3 },
///                       "nasa": { "basis": "analysis", "variable": 3 },
///                       "gevs": { "phase": "critical_design", "known": 1.5 },
///                       "aiaa": { "phase": "test" },
///                       "torques": { "root": { "hysteresis": 0.02 } },
///                       "rates": { "root": "3 deg/s" },
///                       "springs_per_hinge": 2, "points": 21 }
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/static_margins/torque_factors.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace wingspread {

enum class EcssBasis { theoretical, measured };
inline constexpr std::array<std::string_view, 2> ecss_basis_names{"theoretical", "measured"};

enum class NasaBasis { analysis, development_test, acceptance };
inline constexpr std::array<std::string_view, 3> nasa_basis_names{"analysis", "development_test",
                                                                  "acceptance"};

/// Upper limit of `points`, here and in `margin`.
inline constexpr std::int64_t most_margin_points = 1000;

struct StaticMarginSpec {
  EcssBasis ecss_basis = EcssBasis::theoretical;
  NasaBasis nasa_basis = NasaBasis::analysis;
  MarginPhase gevs_phase = MarginPhase::critical_design;
  MarginPhase aiaa_phase = MarginPhase::critical_design;
  EcssFactors ecss; ///< here and below: defaults by basis or phase; each can be given
  NasaFactors nasa;
  PhaseFactors gevs, aiaa;
  std::vector<TorqueTerms> torques; ///< terms that a scene cannot hold, N·m; one for each hinge
  std::vector<double> rates; ///< rates for the dampers' torque, rad/s, ≥ 0; one for each hinge
  std::int64_t springs_per_hinge = 2; ///< equal springs that share a hinge's torque, ≥ 2
  std::int64_t points = 21; ///< evenly spaced places of the travel, both ends included, ≥ 2
};

/// The standards' factors, no further torques, and dampers at rest.
[[nodiscard]] StaticMarginSpec default_static_margins(const Scene& scene);

/// Reads the key `motorization` and notes problems.
/// @param scene null if the scene has problems: then hinges are not looked up
void read_static_margins(const JsonCursor& at, const Scene* scene, StaticMarginSpec& spec);

/// The key `springs_per_hinge`, which a campaign's `margin` has too.
void read_springs_per_hinge(JsonObject& object, StaticMarginSpec& spec);

/// All keys but `springs_per_hinge`, which `margin` writes itself.
[[nodiscard]] Json write_static_margins(const StaticMarginSpec& spec, const Scene& scene);

} // namespace wingspread
