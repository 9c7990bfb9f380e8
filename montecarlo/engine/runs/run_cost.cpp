#include "montecarlo/engine/runs/run_cost.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace wingspread {
namespace {

constexpr long most_steps = 50'000; // some tenths of a second for ten bodies

struct RunCost {
  double seconds = 0;
  long evaluations = 0;
  bool at_least = false; ///< gave up
};

RunCost cost_of(const Scene& scene, Integration integration, Goal goal) {
  goal.audit = goal.end_state = false;
  const bool limited = integration.max_steps > most_steps;
  integration.max_steps = std::min(integration.max_steps, most_steps);
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = Deployment().run(scene, integration, goal);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {taken.count(), outcome.work.rhs_evaluations, limited && outcome.status == Status::failed};
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

} // namespace

std::string describe_cost(const Scene& scene, const Integration& integration) {
  return nominal_text(cost_of(scene, integration, {}));
}

std::string describe_cost(const Campaign& campaign) {
  const std::vector<Campaign> cases = campaigns_of(campaign);
  const RunCost cost =
      cost_of(nominal_scene(cases.front()), campaign.integration, goal_of(campaign.outputs));
  const long runs = campaign.sampling.runs * std::ssize(cases);
  const int threads = thread_count(0);
  const std::string of_cases =
      cases.size() > 1 ? fmt::format(" in {} cases", cases.size()) : std::string();
  return fmt::format("{}; {}{}: about {} on {}, less in packs", nominal_text(cost),
                     counted(runs, "run", "runs"), of_cases,
                     duration(cost.seconds * static_cast<double>(runs) / threads),
                     counted(threads, "thread", "threads"));
}

} // namespace wingspread
