/// A campaign: a scene, what varies in it, how often it is run, and what is wanted of the runs.
#pragma once

#include "core/scene/scene.hpp"
#include "distributions/copula.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
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

/// The key of a results file that holds its stamp: of no account to the campaign itself.
inline constexpr const char* stamp_key = "wingspread";

struct Campaign {
  Scene scene; ///< nominal
  std::vector<Dispersion> dispersions;
  std::vector<CaseSpec> cases; ///< none: the nominal wing alone
  std::string of_case;         ///< of which case of another campaign this one is; may be empty
  std::vector<RankCorrelation>
      wanted_correlations; ///< between dispersions; their matrix is possible
  Sampling sampling;
  Integration integration;
  Outputs outputs = default_outputs();
  StatisticsSpec statistics;
  std::vector<Requirement> requirements;
  StoppingRule until;               ///< it may stop before all of its runs are made
  std::optional<MarginSpec> margin; ///< what `wingspread margin` sizes; of no account to its runs
  MotorizationSpec motorization;    ///< how static margins are judged; the margin's, if it has one
  /// The same in full as JSON: defaults explicit, the scene and empirical values in place of their
  /// files. Reads back to the same campaign, wherever it is put.
  Json resolved;
};

/// How many looks at growing data its bounds and verdicts share their risk among: the numbers of runs
/// at which it may stop or, of one that was extended, those at which it was looked at and its own.
[[nodiscard]] long count_looks(const Campaign& campaign);

/// What tells campaigns apart: 16 hexadecimal digits that depend on the resolved campaign alone,
/// less its key "wingspread". Stable across platforms and runs of the program.
[[nodiscard]] std::string campaign_hash(const Json& resolved);

/// The wing with nothing dispersed: its scene, with every draw that drives others by tables (`through`) at its median,
/// which is what a temperature is where nobody asks for another.
[[nodiscard]] Scene nominal_scene(const Campaign& campaign);

/// Makes a scene the one of a run: puts back what the campaign varies to its nominal value, then
/// applies the draws. Allocates nothing.
/// @param draws     one per dispersion, in their order
/// @param nominal   the campaign's scene
/// @param run_scene a copy of `nominal`, as it was or as this function left it
void apply(const Campaign& campaign, std::span<const double> draws, const Scene& nominal,
           Scene& run_scene);

} // namespace wingspread
