#include "montecarlo/engine/runs/run_plan.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace wingspread {
namespace {

ResultNames result_names(const Campaign& campaign, const std::vector<OutputColumn>& columns) {
  ResultNames names;
  std::ranges::transform(campaign.dispersions, std::back_inserter(names.draws), &Dispersion::name);
  std::ranges::transform(columns, std::back_inserter(names.outputs), &OutputColumn::name);
  names.peaks_final = campaign.outputs.contains(OutputFamily::peaks_final);
  return names;
}

} // namespace

RunPlan::RunPlan(const Campaign& campaign)
    : campaign_(&campaign), columns_(output_columns(campaign.scene, campaign.outputs)),
      goal_(goal_of(campaign.outputs)), names_(result_names(campaign, columns_)),
      design_(design_of(campaign.sampling), names_.draws),
      copula_(order_by_name(names_.draws), campaign.wanted_correlations) {
  for (const Dispersion& dispersion : campaign.dispersions)
    distributions_.emplace_back(dispersion.distribution);
}

RunPlan::RunPlan(const Campaign& campaign, UnitPoints points) : RunPlan(campaign) {
  points_ = std::move(points);
}

RunPlan::RunPlan(const Campaign& campaign, UnitPoints points, Measure measure)
    : RunPlan(campaign, std::move(points)) {
  columns_.clear();
  names_.outputs = {measure.name};
  names_.peaks_final = false;
  goal_ = measure.goal;
  measure_ = std::move(measure);
}

void RunPlan::draw(long k, std::span<double> draws) const {
  const std::size_t count = draws.size();
  if (!points_ && copula_.is_independent()) { // most campaigns: needs no memory allocation
    for (std::size_t i = 0; i < count; ++i)
      draws[i] = distributions_[i].quantile(design_.uniform(static_cast<std::uint64_t>(k), i));
    return;
  }
  std::vector<Tails> u(count), coupled(count);
  place(k, u);
  copula_.couple(u, coupled);
  for (std::size_t i = 0; i < count; ++i) draws[i] = distributions_[i].quantile(coupled[i]);
}

void RunPlan::place(long k, std::span<Tails> u) const {
  if (points_) return points_(k, u);
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = tails_of_uniform(design_.uniform(static_cast<std::uint64_t>(k), i));
}

} // namespace wingspread
