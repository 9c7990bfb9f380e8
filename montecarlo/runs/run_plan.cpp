#include "montecarlo/runs/run_plan.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace wingspread {
namespace {

ResultNames result_names(const Campaign& campaign, const std::vector<OutputColumn>& columns) {
  ResultNames names;
  std::ranges::transform(campaign.dispersions, std::back_inserter(names.draws), &Dispersion::name);
  std::ranges::transform(columns, std::back_inserter(names.outputs), &OutputColumn::name);
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
  goal_ = measure.goal;
  measure_ = std::move(measure);
}

void RunPlan::draw(long k, std::span<double> draws) const {
  if (points_)
    points_(k, draws);
  else
    for (std::size_t i = 0; i < draws.size(); ++i)
      draws[i] = design_.uniform(static_cast<std::uint64_t>(k), i);
  to_draws(draws);
}

void RunPlan::to_draws(std::span<double> point) const {
  if (copula_.is_independent()) {
    for (std::size_t i = 0; i < point.size(); ++i) point[i] = distributions_[i].quantile(point[i]);
    return;
  }
  std::vector<Tails> coupled(point.size());
  copula_.couple(point, coupled);
  for (std::size_t i = 0; i < point.size(); ++i) point[i] = distributions_[i].quantile(coupled[i]);
}

} // namespace wingspread
