#include "montecarlo/engine/runs/run_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
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

/// A value of an empirical law in the order of its list.
double value_of_row(const Empirical& law, const Tails& u) {
  const auto rows = static_cast<double>(law.values.size());
  const double at = std::floor((u.below <= u.above ? u.below : 1 - u.above) * rows);
  return law.values[static_cast<std::size_t>(std::clamp(at, 0.0, rows - 1))];
}

/// The wanted correlations between coordinates.
std::vector<RankCorrelation> between_coordinates(const Coordinates& coordinates,
                                                 std::vector<RankCorrelation> wanted) {
  for (RankCorrelation& pair : wanted)
    pair.first = coordinates.of[pair.first], pair.second = coordinates.of[pair.second];
  return wanted;
}

} // namespace

Tails unit_point(double z) {
  constexpr double least = std::numeric_limits<double>::min();
  const auto [below, above] = tails(Normal{}, z);
  return {std::max(below, least), std::max(above, least)};
}

RunPlan::RunPlan(const Campaign& campaign)
    : campaign_(&campaign), columns_(output_columns(campaign.scene, campaign.outputs)),
      integration_(campaign.integration), goal_(goal_of(campaign.outputs)),
      names_(result_names(campaign, columns_)), coordinates_(coordinates_of(campaign.dispersions)),
      design_(design_of(campaign.sampling), coordinates_.names),
      copula_(order_by_name(coordinates_.names),
              between_coordinates(coordinates_, campaign.wanted_correlations)) {
  for (const Dispersion& dispersion : campaign.dispersions)
    distributions_.emplace_back(dispersion.distribution);
  has_rows_ = std::ranges::any_of(
      campaign.dispersions, [](const Dispersion& dispersion) { return !dispersion.rows.empty(); });
}

RunPlan::RunPlan(const Campaign& campaign, UnitPoints points) : RunPlan(campaign) {
  points_ = std::move(points);
}

RunPlan::RunPlan(const Campaign& campaign, UnitPoints points, Measure measure)
    : RunPlan(campaign, std::move(points)) {
  columns_.clear();
  names_.outputs = {measure.name};
  names_.peaks_final = measure.goal.peak_moment || measure.goal.peak_force;
  goal_ = measure.goal;
  measure_ = std::move(measure);
}

RunPlan::RunPlan(const Campaign& campaign, UnitPoints points, SampledColumns samples)
    : RunPlan(campaign, std::move(points)) {
  columns_.clear();
  names_.outputs.clear();
  names_.peaks_final = false;
  integration_.t_end = samples.t_end;
  goal_ = goal_of(campaign.scene, samples);
  samples_ = std::move(samples);
}

void RunPlan::draw(long k, std::span<double> draws) const {
  const std::size_t count = draws.size();
  const Sampling& sampling = campaign_->sampling;
  if (!points_ && sampling.design == DesignKind::latin_hypercube && k >= sampling.runs)
    throw std::out_of_range("a Latin hypercube has no such run");
  if (!points_ && !has_rows_ &&
      copula_.is_independent()) { // most campaigns: needs no memory allocation
    for (std::size_t i = 0; i < count; ++i)
      draws[i] = distributions_[i].quantile(design_.uniform(static_cast<std::uint64_t>(k), i));
    return;
  }
  std::vector<Tails> u(coordinates_.names.size()), coupled(u.size());
  place(k, u);
  copula_.couple(u, coupled);
  for (std::size_t i = 0; i < count; ++i) {
    const Dispersion& dispersion = campaign_->dispersions[i];
    const Tails& at = coupled[coordinates_.of[i]];
    draws[i] = dispersion.rows.empty()
                   ? distributions_[i].quantile(at)
                   : value_of_row(std::get<Empirical>(dispersion.distribution.law), at);
  }
}

void RunPlan::place(long k, std::span<Tails> u) const {
  if (points_) return points_(k, u);
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = tails_of_uniform(design_.uniform(static_cast<std::uint64_t>(k), i));
}

} // namespace wingspread
