/// The static margins that are required of a campaign: of every row's draw, by its applied draws.
///
/// They are of the wing that was drawn, not of its run; but a run that did not deploy breaks every
/// requirement, and this too (verdict.hpp).
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <vector>

namespace wingspread {

/// A column for each static margin that a requirement is on, by its output's name: the least over the travel of the
/// hinges that are meant. NaN for a draw that is unphysical, the largest number where nothing resists.
/// Cost: a scene and its margins a row; memory: the columns.
/// @pre the results have the campaign's draws
[[nodiscard]] std::vector<Column> static_margin_columns(const Campaign& campaign,
                                                        const Results& results);

/// Verdicts on all requirements of the campaign, static margins among them. @param looks as in judge_all
[[nodiscard]] std::vector<Verdict> judge_campaign(const Campaign& campaign, const Results& results,
                                                  long looks = 1);

} // namespace wingspread
