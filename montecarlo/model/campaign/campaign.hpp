/// A campaign: a scene, the parameters that vary, the number of runs, and the outputs and requirements.
#pragma once

#include "core/scene/scene.hpp"
#include "distributions/copula.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/statistics/interim_analyses.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/model/campaign/cases.hpp"
#include "montecarlo/model/campaign/dispersion.hpp"
#include "montecarlo/model/campaign/margin_spec.hpp"
#include "montecarlo/model/campaign/outputs.hpp"
#include "montecarlo/model/campaign/requirement.hpp"
#include "montecarlo/model/campaign/stopping_rule.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// The key of the stamp in result files. A campaign's reader ignores its value.
inline constexpr const char* stamp_key = "wingspread";

struct Campaign {
  Scene
      scene; ///< as written, before dispersion; nominal_scene() has the dispersions at their medians
  std::vector<Dispersion> dispersions;
  std::vector<CaseSpec> cases; ///< empty: the nominal wing only
  std::string of_case;         ///< the case whose campaign this is; empty: none
  std::vector<RankCorrelation>
      wanted_correlations; ///< between dispersions; their matrix is positive definite
  Sampling sampling;
  Integration integration;
  Outputs outputs = default_outputs();
  StatisticsSpec statistics;
  ReportHeader report;
  std::vector<Requirement> requirements;
  StoppingRule until;               ///< empty: makes all runs
  std::optional<MarginSpec> margin; ///< the study of `wingspread margin`; runs ignore it
  StaticMarginSpec motorization; ///< factors of the static margins, from `margin` or the campaign
  /// The campaign as JSON with explicit defaults, and with the scene and empirical values instead of file names. Reads
  /// back to the same campaign in any folder.
  Json resolved;
};

/// The interim analyses, the final one included, which share the risk of all bounds and verdicts: those of a
/// stopping rule, or the analyses before extensions.
[[nodiscard]] InterimAnalyses interim_analyses(const Campaign& campaign);

/// 16 hexadecimal digits that identify a campaign: a hash of `resolved` without its stamp. The same on all platforms.
[[nodiscard]] std::string campaign_hash(const Json& resolved);

/// The scene with every dispersion at the median of its law, tables included. All nominal values come from this scene:
/// those of `simulate`, static margins, input checks, summary.json and the report. Correlations do not move medians.
[[nodiscard]] Scene nominal_scene(const Campaign& campaign);
/// The scene with these draws. @param draws one for each dispersion, in their order
[[nodiscard]] Scene scene_with(const Campaign& campaign, std::span<const double> draws);

/// The parameters that the dispersions change, each once, in the order of their first change.
[[nodiscard]] std::vector<SceneParameter>
dispersed_parameters(std::span<const Dispersion> dispersions);

/// The index, in the campaign's list, of the entry that a dispersion comes from: its own, the `each` of which it is a
/// copy, or the `rows` of which it is a column.
[[nodiscard]] std::size_t entry_of(const Campaign& campaign, const Dispersion& dispersion);
/// Whether the entry with this name draws the dispersion, so that a case's law for the entry is the dispersion's.
[[nodiscard]] bool is_drawn_by(const Campaign& campaign, const std::string& entry,
                               const Dispersion& dispersion);

/// Sets all dispersed parameters of a scene to their nominal values and applies a run's draws. Allocates nothing.
/// @param draws     one for each dispersion, in their order
/// @param nominal   the campaign's scene
/// @param run_scene a copy of `nominal`, unchanged or changed by this function
void apply(const Campaign& campaign, std::span<const double> draws, const Scene& nominal,
           Scene& run_scene);

} // namespace wingspread
