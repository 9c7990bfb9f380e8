/// How static margins are judged: what a campaign's `motorization` gives, by itself or in its `margin`.
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
#include "montecarlo/model/static_margins/motorization_factors.hpp"

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

/// Most places of a travel, and scales of a grid.
inline constexpr std::int64_t most_margin_points = 1000;

struct MotorizationSpec {
  EcssBasis ecss_basis = EcssBasis::theoretical;
  NasaBasis nasa_basis = NasaBasis::analysis;
  MarginPhase gevs_phase = MarginPhase::critical_design;
  MarginPhase aiaa_phase = MarginPhase::critical_design;
  EcssFactors ecss; ///< the basis's or the phase's, or what was put in their place
  NasaFactors nasa;
  PhaseFactors gevs, aiaa;
  std::vector<MotorizationTerms> torques; ///< that the scene does not know, N·m; one a hinge
  std::vector<double> rates;          ///< at which dampers are counted, rad/s, ≥ 0; one a hinge
  std::int64_t springs_per_hinge = 2; ///< equal ones that make up a hinge's torque, ≥ 2
  std::int64_t points = 21;           ///< of the travel, from end to end, ≥ 2
};

/// The standards' factors, nothing that the scene does not know, and dampers at rest.
[[nodiscard]] MotorizationSpec default_motorization(const Scene& scene);

/// Reads it and notes what is wrong.
/// @param scene null when it has problems of its own: then hinges are not looked up
void read_motorization(const JsonCursor& at, const Scene* scene, MotorizationSpec& spec);

/// The key `springs_per_hinge`, which a campaign's `margin` has too.
void read_springs_per_hinge(JsonObject& object, MotorizationSpec& spec);

/// In full, but for the springs of a hinge.
[[nodiscard]] Json write_motorization(const MotorizationSpec& spec, const Scene& scene);

} // namespace wingspread
