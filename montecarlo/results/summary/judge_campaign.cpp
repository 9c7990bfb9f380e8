#include "montecarlo/results/summary/judge_campaign.hpp"

#include <algorithm>
#include <cassert>

namespace wingspread {
namespace {

/// One required static margin and its column.
struct Wanted {
  RequiredMargin margin{};
  std::vector<HingeDrive> drives;
  Column column;
};

std::vector<Wanted> wanted_of(const Campaign& campaign) {
  std::vector<Wanted> wanted;
  for (const Requirement& requirement : campaign.requirements) {
    if (!requirement.static_margin) continue;
    const RequiredMargin& margin = *requirement.static_margin;
    if (std::ranges::find(wanted, margin, &Wanted::margin) == wanted.end())
      wanted.push_back({margin, required_drives(campaign.scene, margin), {requirement.output, {}}});
  }
  return wanted;
}

} // namespace

std::vector<Column> static_margin_columns(const Campaign& campaign, const Results& results) {
  assert(results.draws.size() == campaign.dispersions.size());
  std::vector<Wanted> wanted = wanted_of(campaign);
  std::vector<Column> columns;
  if (wanted.empty()) return columns;
  std::vector<double> draws(results.draws.size());
  Scene scene = campaign.scene;
  for (std::size_t row = 0; row < results.size(); ++row) {
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i] = results.draws[i].values[row];
    apply(campaign, draws, campaign.scene, scene);
    for (Wanted& each : wanted)
      each.column.values.push_back(
          least_margin(scene, each.drives, each.margin.kind, campaign.motorization));
  }
  results.release();
  for (Wanted& each : wanted) columns.push_back(std::move(each.column));
  return columns;
}

std::vector<Verdict> judge_campaign(const Campaign& campaign, const Results& results,
                                    const InterimAnalyses& interim) {
  return judge_all(campaign.requirements, results, interim,
                   static_margin_columns(campaign, results));
}

} // namespace wingspread
