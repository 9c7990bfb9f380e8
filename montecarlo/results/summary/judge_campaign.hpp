/// Verdicts on all requirements of a campaign. A required static margin is no output of a run: it is computed from the
/// row's draws (static_margins). A run that did not deploy breaks every requirement, also on static margins.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/summary/summary.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <vector>

namespace wingspread {

/// One column for each required static margin, named as the requirement's output, with the values of least_margin().
/// Cost: one scene and its margins for each row. @pre the results have the campaign's draws
[[nodiscard]] std::vector<Column> static_margin_columns(const Campaign& campaign,
                                                        const Results& results);

/// Judges all requirements. @param interim as in judge()
[[nodiscard]] std::vector<Verdict> judge_campaign(const Campaign& campaign, const Results& results,
                                                  const InterimAnalyses& interim = {});

/// Sets `one_run` if nothing is dispersed and all runs have one result (runs of another tool may differ even then).
/// Passed requirements then become undecided, without guaranteed numbers: N times the same run show no probability.
void withdraw_if_one_run(const Campaign& campaign, Summary& summary);

/// Makes all requirements of a shard, a preview or an unfinished folder undecided: the whole is judged.
void withdraw_of_part(Summary& summary);

} // namespace wingspread
