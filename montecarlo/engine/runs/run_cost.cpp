#include "montecarlo/engine/runs/run_cost.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>

namespace wingspread {
namespace {

constexpr long most_steps = 50'000; // some tenths of a second for ten bodies

/// Processor time of this thread, s: time in which other programs have the processor is not counted.
double processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct RunCost {
  double seconds = 0; ///< of a processor
  long evaluations = 0;
  bool at_least = false; ///< gave up
  Status status = Status::failed;
  std::string reason;
};

RunCost cost_of(const Scene& scene, Integration integration, Goal goal) {
  goal.audit = goal.end_state = false;
  const bool limited = integration.max_steps > most_steps;
  integration.max_steps = std::min(integration.max_steps, most_steps);
  const double start = processor_time();
  const Outcome outcome = Deployment().run(scene, integration, goal);
  const double taken = processor_time() - start;
  const bool at_limit = outcome.reason.find("max_steps") != std::string::npos;
  return {taken, outcome.work.rhs_evaluations,
          limited && outcome.status == Status::failed && at_limit, outcome.status, outcome.reason};
}

/// The time in which a run's draws are made and set in the scene, s: the shortest of some runs.
double seconds_of_draws(const Campaign& campaign) {
  const RunPlan plan(campaign);
  std::vector<double> draws(campaign.dispersions.size());
  Scene scene = campaign.scene;
  double shortest = std::numeric_limits<double>::infinity();
  for (long run = 0; run < std::min<long>(8, campaign.sampling.runs); ++run) {
    const double start = processor_time();
    plan.draw(run, draws);
    apply(campaign, draws, campaign.scene, scene);
    shortest = std::min(shortest, processor_time() - start);
  }
  return shortest;
}

/// "3.1 ms", "0.4 s", "40 s", "2 min", "5 h": one or two digits.
std::string duration(double seconds) {
  if (seconds < 0.095) return fmt::format("{:.2g} ms", std::max(1e3 * seconds, 0.1));
  if (seconds < 9.5) return fmt::format("{:.1f} s", seconds);
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.0f} h", seconds / 3600);
}

std::string nominal_text(const RunCost& cost) {
  return fmt::format("the nominal run takes {}{} evaluations, {}",
                     cost.at_least ? "more than " : "", cost.evaluations, duration(cost.seconds));
}

/// The input checks of a motion (input_checks/clearance_check.hpp) give up as early.
void add_note(const RunCost& cost, const std::string& of_case, NominalRuns& runs) {
  if (cost.status == Status::deployed) return;
  const std::string wing = "the nominal wing" + (of_case.empty() ? "" : " of case " + of_case);
  if (cost.at_least)
    runs.notes.push_back(fmt::format(
        "{} was followed for {} trial steps only: whether it deploys is not known, and no warning "
        "is of what comes later (bodies that pass through each other, releases, latches)",
        wing, most_steps));
  else
    runs.notes.push_back(fmt::format("{} does not deploy: {}{}", wing,
                                     spaced(to_string(cost.status)),
                                     cost.reason.empty() ? "" : " (" + cost.reason + ")"));
}

} // namespace

NominalRuns try_nominal(const Scene& scene, const Integration& integration) {
  const RunCost cost = cost_of(scene, integration, {});
  NominalRuns runs{nominal_text(cost), {}, cost.seconds, cost.at_least};
  add_note(cost, "", runs);
  return runs;
}

NominalRuns try_nominal(const Campaign& campaign) {
  NominalRuns tried;
  const std::vector<Campaign> cases = campaigns_of(campaign);
  std::vector<RunCost> costs;
  for (const Campaign& each : cases) {
    costs.push_back(cost_of(nominal_scene(each), each.integration, goal_of(each.outputs)));
    add_note(costs.back(), each.of_case, tried);
  }
  const RunCost& cost = costs.front();
  const long runs = campaign.sampling.runs * std::ssize(cases);
  const int threads = thread_count(0);
  const std::string of_cases =
      cases.size() > 1 ? fmt::format(" in {} cases", cases.size()) : std::string();
  const double draws = seconds_of_draws(cases.front());
  tried.seconds = cost.seconds + draws, tried.at_least = cost.at_least;
  const bool counts = draws > cost.seconds / 10;
  tried.cost = fmt::format("{}{}; {}{}: {} on {}, less in packs", nominal_text(cost),
                           counts ? "; the draws of a run take " + duration(draws) : "",
                           counted(runs, "run", "runs"), of_cases, time_of_runs(tried, runs),
                           counted(threads, "thread", "threads"));
  return tried;
}

std::string time_of_runs(const NominalRuns& nominal, long runs) {
  return (nominal.at_least ? "more than " : "about ") +
         duration(nominal.seconds * static_cast<double>(runs) / thread_count(0));
}

} // namespace wingspread
