#include "montecarlo/engine/runs/runner.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {

Runner::Runner(const RunPlan& plan) : plan_(&plan), scene_(plan.campaign().scene) {
  if (plan.samples()) taker_.emplace(scene_, *plan.samples());
}

ResultRow Runner::run(long k) {
  const DeploymentPack::Watch taken = make_watch();
  Observer observer;
  if (taken) observer = [&taken, k](const Sample& sample) { taken(k, sample); };
  return make(k, plan_->goal(), observer).row;
}

Runner::Replay Runner::replay(long k, const Observer& observer, double interval) {
  Goal goal = plan_->goal();
  goal.audit = goal.end_state = true;
  goal.sample_interval = interval;
  Replay made = make(k, goal, observer);
  made.scene = scene_;
  return made;
}

Outcome Runner::watch(long k, const Goal& goal, double t_end, const Observer& observer) {
  std::vector<double> draws;
  set_scene(k, draws, scene_);
  Integration how = plan_->integration();
  how.t_end = t_end;
  return deployment_.run(scene_, how, goal, observer);
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
  return DeploymentPack(set, plan_->integration(), plan_->goal())
      .run(plan_->campaign().scene, next_scene, ended, make_watch());
}

DeploymentPack::Watch Runner::make_watch() {
  if (!taker_) return {};
  return [this](long k, const Sample& sample) { taker_->take(sample, samples_[k]); };
}

Runner::Replay Runner::make(long k, const Goal& goal, const Observer& observer) {
  std::vector<double> draws;
  set_scene(k, draws, scene_);
  Replay made;
  made.outcome = deployment_.run(scene_, plan_->integration(), goal, observer);
  made.row = row_of(k, std::move(draws), made.outcome);
  return made;
}

void Runner::set_scene(long k, std::vector<double>& draws, Scene& scene) const {
  const Campaign& campaign = plan_->campaign();
  draws.resize(campaign.dispersions.size());
  plan_->draw(k, draws);
  apply(campaign, draws, campaign.scene, scene);
}

std::vector<double> Runner::outputs_of(std::span<const double> draws, const Outcome& outcome) {
  std::vector<double> outputs;
  if (const auto& measure = plan_->measure()) {
    apply(plan_->campaign(), draws, plan_->campaign().scene, scene_);
    outputs.push_back(measure->of(scene_, outcome));
  }
  for (const OutputColumn& column : plan_->columns()) outputs.push_back(output_of(column, outcome));
  return outputs;
}

ResultRow Runner::row_of(long k, std::vector<double>&& draws, Outcome& outcome) {
  ResultRow row;
  row.run = k;
  row.outputs = outputs_of(draws, outcome);
  if (taker_) {
    row.outputs = std::move(samples_[k]);
    samples_.erase(k);
    if (outcome.status == Status::invalid || outcome.status == Status::failed) row.outputs.clear();
  }
  row.draws = std::move(draws);
  // A draw that overflowed becomes an empty cell; the reason of its invalid run names the value.
  std::ranges::transform(row.draws, row.draws.begin(), finite_or_none);
  row.status = outcome.status;
  row.reason = outcome.latches_final ? outcome.reason : std::string(latches_may_let_go);
  if (plan_->names().peaks_final) row.peaks_final = peaks_final_of(outcome);
  row.latch_order = latch_order(plan_->campaign().scene, outcome);
  return row;
}

} // namespace wingspread
