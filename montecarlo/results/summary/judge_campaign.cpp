#include "montecarlo/results/summary/judge_campaign.hpp"

#include <algorithm>
#include <cassert>

namespace wingspread {
namespace {

/// One required static margin and its column.
struct MarginColumn {
  RequiredMargin margin;
  std::vector<HingeDrive> drives;
  Column column;
};

bool have_one_result(const Summary& summary) {
  const auto all_or_none = [&](const StatusShare& share) {
    return share.count == 0 || share.count == summary.runs;
  };
  const auto is_constant = [](const OutputSummary& output) {
    return output.moments.count == 0 ||
           (output.missing == 0 && output.moments.min == output.moments.max);
  };
  return std::ranges::all_of(summary.statuses, all_or_none) &&
         std::ranges::all_of(summary.outputs, is_constant);
}

std::vector<MarginColumn> margin_columns(const Campaign& campaign) {
  std::vector<MarginColumn> found;
  for (const Requirement& requirement : campaign.requirements) {
    if (!requirement.static_margin) continue;
    const RequiredMargin& margin = *requirement.static_margin;
    if (std::ranges::find(found, margin, &MarginColumn::margin) == found.end())
      found.push_back({margin, required_drives(campaign.scene, margin), {requirement.output, {}}});
  }
  return found;
}

} // namespace

std::vector<Column> static_margin_columns(const Campaign& campaign, const Results& results) {
  assert(results.draws.size() == campaign.dispersions.size());
  std::vector<MarginColumn> found = margin_columns(campaign);
  std::vector<Column> columns;
  if (found.empty()) return columns;
  std::vector<double> draws(results.draws.size());
  Scene scene = campaign.scene;
  for (std::size_t row = 0; row < results.size(); ++row) {
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i] = results.draws[i].values[row];
    apply(campaign, draws, campaign.scene, scene);
    for (MarginColumn& each : found)
      each.column.values.push_back(
          least_margin(scene, each.drives, each.margin.kind, campaign.motorization));
  }
  results.release();
  for (MarginColumn& each : found) columns.push_back(std::move(each.column));
  return columns;
}

std::vector<Verdict> judge_campaign(const Campaign& campaign, const Results& results,
                                    const InterimAnalyses& interim) {
  return judge_all(campaign.requirements, results, interim,
                   static_margin_columns(campaign, results));
}

namespace {

void withdraw(Verdict& verdict) {
  verdict.decision = Decision::undecided;
  verdict.guaranteed_share = undefined;
  verdict.guaranteed = verdict.margin = std::nullopt;
}

} // namespace

void withdraw_if_one_run(const Campaign& campaign, Summary& summary) {
  if (summary.runs == 0 || vary(campaign.dispersions) || !have_one_result(summary)) return;
  summary.one_run = true;
  for (Verdict& verdict : summary.requirements) {
    if (verdict.failures() > 0) continue; // one run is enough to break it
    verdict.one_run = true;
    withdraw(verdict);
  }
}

void withdraw_of_part(Summary& summary) {
  for (Verdict& verdict : summary.requirements) {
    verdict.of_part = true;
    verdict.disproved = false;
    withdraw(verdict);
  }
}

} // namespace wingspread
