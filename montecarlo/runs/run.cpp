#include "montecarlo/runs/run.hpp"

#include "montecarlo/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace wingspread {
namespace {

using Quantity = OutputColumn::Quantity;

double finite_or_none(double value) { return std::isfinite(value) ? value : undefined; }

void add_rates_at(const Scene& scene, int hinge, std::vector<OutputColumn>& columns) {
  for (int other = 0; other < std::ssize(scene.hinges); ++other)
    if (other != hinge && scene.hinges[other].latch)
      columns.push_back({scene.hinges[hinge].name + ".rate_at." + scene.hinges[other].name,
                         Quantity::rate_at, hinge, other});
}

const LatchEvent* latch_of(int hinge, const Outcome& outcome) {
  const auto found = std::ranges::find(outcome.latches, hinge, &LatchEvent::hinge);
  return found == outcome.latches.end() ? nullptr : &*found;
}

double peak_of(int hinge, const std::vector<Peak>& peaks, Status status) {
  return peaks.empty() || status == Status::failed ? undefined : peaks[hinge].value;
}

double number_of(const OutputColumn& column, const Outcome& outcome) {
  const auto at_latch = [&](int hinge, auto value) {
    const LatchEvent* latch = latch_of(hinge, outcome);
    return latch ? value(*latch) : undefined;
  };
  const auto rate = [&](const LatchEvent& latch) { return latch.rates[column.hinge]; };
  switch (column.quantity) {
  case Quantity::latch_time:
    return at_latch(column.hinge, [](const LatchEvent& latch) { return latch.time; });
  case Quantity::latch_rate:
    return at_latch(column.hinge, rate);
  case Quantity::rate_at:
    return at_latch(column.other, rate);
  case Quantity::peak_moment:
    return peak_of(column.hinge, outcome.peak_moment, outcome.status);
  case Quantity::peak_force:
    return peak_of(column.hinge, outcome.peak_force, outcome.status);
  case Quantity::deployment_time:
    return outcome.status == Status::deployed ? outcome.latches.back().time : undefined;
  }
  return undefined;
}

ResultNames result_names(const Campaign& campaign, const std::vector<OutputColumn>& columns) {
  ResultNames names;
  std::ranges::transform(campaign.dispersions, std::back_inserter(names.draws), &Dispersion::name);
  std::ranges::transform(columns, std::back_inserter(names.outputs), &OutputColumn::name);
  return names;
}

} // namespace

std::vector<OutputColumn> output_columns(const Scene& scene, const Outputs& outputs) {
  std::vector<OutputColumn> columns;
  for (int i = 0; i < std::ssize(scene.hinges); ++i) {
    const Hinge& hinge = scene.hinges[i];
    const auto add = [&](OutputFamily family, const char* name, Quantity quantity) {
      if (outputs.contains(family)) columns.push_back({hinge.name + '.' + name, quantity, i, -1});
    };
    if (hinge.latch) {
      add(OutputFamily::latch_time, "latch_time", Quantity::latch_time);
      add(OutputFamily::latch_rate, "latch_rate", Quantity::latch_rate);
    }
    add(OutputFamily::peak_moment, "peak_moment", Quantity::peak_moment);
    add(OutputFamily::peak_force, "peak_force", Quantity::peak_force);
    if (outputs.contains(OutputFamily::rate_at)) add_rates_at(scene, i, columns);
  }
  columns.push_back({"deployment_time", Quantity::deployment_time, -1, -1});
  return columns;
}

Goal goal_of(const Outputs& outputs) {
  Goal goal;
  goal.peak_moment = outputs.contains(OutputFamily::peak_moment);
  goal.peak_force = outputs.contains(OutputFamily::peak_force);
  goal.audit = false;
  goal.to_t_end = false;
  return goal;
}

double output_of(const OutputColumn& column, const Outcome& outcome) {
  return finite_or_none(number_of(column, outcome));
}

std::string latch_order(const Scene& scene, const Outcome& outcome) {
  std::string order;
  for (const LatchEvent& latch : outcome.latches) {
    if (!order.empty()) order += '>';
    order += scene.hinges[latch.hinge].name;
  }
  return order;
}

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
