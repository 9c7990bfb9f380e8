#include "montecarlo/runs/run.hpp"

#include <algorithm>
#include <iterator>
#include <map>
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
      names_(result_names(campaign, columns_)), design_(design_of(campaign.sampling), names_.draws),
      copula_(order_by_name(names_.draws), campaign.correlations) {
  for (const Dispersion& dispersion : campaign.dispersions)
    distributions_.emplace_back(dispersion.distribution);
}

RunPlan::RunPlan(const Campaign& campaign, UnitPoints points) : RunPlan(campaign) {
  points_ = std::move(points);
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

Runner::Runner(const RunPlan& plan)
    : plan_(&plan), goal_(goal_of(plan.campaign().outputs)), scene_(plan.campaign().scene) {}

ResultRow Runner::run(long k) { return make(k, goal_, {}).row; }

Runner::Replay Runner::replay(long k, const Observer& observer) {
  Goal goal = goal_;
  goal.audit = true;
  return make(k, goal, observer);
}

Occupancy Runner::run_all(InstructionSet set, const std::function<std::optional<long>()>& next,
                          const std::function<void(ResultRow&&)>& done) {
  std::map<long, std::vector<double>> draws; // of the runs in the lanes
  const auto next_scene = [&](Scene& scene) {
    const std::optional<long> k = next();
    if (k) set_scene(*k, draws[*k], scene);
    return k;
  };
  const auto ended = [&](long k, Outcome&& outcome) {
    done(row_of(k, std::move(draws.extract(k).mapped()), outcome));
  };
  return DeploymentPack(set, plan_->campaign().integration, goal_)
      .run(plan_->campaign().scene, next_scene, ended);
}

Runner::Replay Runner::make(long k, const Goal& goal, const Observer& observer) {
  std::vector<double> draws;
  set_scene(k, draws, scene_);
  Replay made;
  made.outcome = deployment_.run(scene_, plan_->campaign().integration, goal, observer);
  made.row = row_of(k, std::move(draws), made.outcome);
  return made;
}

void Runner::set_scene(long k, std::vector<double>& draws, Scene& scene) const {
  const Campaign& campaign = plan_->campaign();
  draws.resize(campaign.dispersions.size());
  plan_->draw(k, draws);
  apply(campaign, draws, campaign.scene, scene);
}

ResultRow Runner::row_of(long k, std::vector<double>&& draws, Outcome& outcome) const {
  ResultRow row;
  row.run = k;
  row.draws = std::move(draws);
  // A draw that overflowed is in the reason of its invalid run; the table has room for numbers.
  std::ranges::transform(row.draws, row.draws.begin(), finite_or_none);
  row.status = outcome.status;
  row.reason = outcome.reason;
  row.latch_order = latch_order(plan_->campaign().scene, outcome);
  for (const OutputColumn& column : plan_->columns())
    row.outputs.push_back(output_of(column, outcome));
  return row;
}

} // namespace wingspread
