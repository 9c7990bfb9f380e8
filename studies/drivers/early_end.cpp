// Measures the work that runs save by ending early, and checks that they lose no result. Makes every run of several
// campaigns twice: as a campaign does, and to its t_end. No bit of a latch or another event, a peak, an overtravel or a motor's
// energy may differ, no status, and no run may fail.
//
//   build/release/studies/early_end                 some ten thousand runs of each campaign; minutes
//   build/release/studies/early_end --quick         a hundred of each
//   build/release/studies/early_end CAMPAIGN.json … all runs of these, with their own t_end and outputs
//
// Exits 1 if any bit differs or a run fails.

#include "core/deployment.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "studies/support/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace wingspread;

namespace {

/// A campaign, its number of runs, and their t_end. Some campaigns have a far later t_end, before which the wing is at rest
/// most of the time.
struct Case {
  const char* campaign;
  long runs;
  double t_end; ///< s
  std::uint64_t seed;
};
constexpr Case cases[] = {{"seed", 40000, 30, 11},
                          {"work_precision", 20000, 30, 12},
                          {"work_precision_rubbing", 15000, 30, 13},
                          {"work_precision_sticking", 15000, 30, 14},
                          {"prescribed_base", 4000, 40, 15},
                          {"stall", 8000, 40, 16},
                          {"yoke_wing", 2000, 40, 17},
                          {"two_wing_free", 1000, 30, 18},
                          {"satellite", 1000, 20, 19},
                          {"two_wing_release", 500, 40, 20},
                          {"bending_wings", 200, 20, 21}};

struct Found {
  long runs = 0, deployed = 0, early = 0, lost = 0, failed = 0;
  double evaluations = 0, of_whole = 0; ///< of all runs: as they end, and to t_end
  long tails = 0;                       ///< deployed runs that ended early
  double tail = 0;                      ///< sum over these of the time from last latch to end, s

  void add(const Found& other) {
    runs += other.runs, deployed += other.deployed, early += other.early, lost += other.lost;
    failed += other.failed, tails += other.tails, tail += other.tail;
    evaluations += other.evaluations, of_whole += other.of_whole;
  }
};

bool same(const std::vector<Peak>& a, const std::vector<Peak>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Peak& p, const Peak& q) {
    return p.value == q.value && p.time == q.time;
  });
}

bool same(const std::vector<LatchEvent>& a, const std::vector<LatchEvent>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.hinge == q.hinge && p.time == q.time && p.rates == q.rates;
  });
}

bool same(const std::vector<HingeEvent>& a, const std::vector<HingeEvent>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.hinge == q.hinge && p.time == q.time && p.rate == q.rate;
  });
}

/// Whether the run to t_end has the status, the events and all that was asked for of the early one.
bool nothing_lost(const Outcome& early, const Outcome& whole, const Goal& goal) {
  const auto& [was, is] = std::pair(early.base_peaks, whole.base_peaks);
  const bool base =
      !goal.base_motion || !was || (is && was->angle == is->angle && was->rate == is->rate);
  return early.status == whole.status && base && same(early.latches, whole.latches) &&
         same(early.let_go, whole.let_go) && same(early.missed, whole.missed) &&
         same(early.releases, whole.releases) && early.overtravel == whole.overtravel &&
         early.motor_energy == whole.motor_energy &&
         (!goal.to_rest || early.final_angle == whole.final_angle) &&
         same(early.peak_moment, whole.peak_moment) && same(early.peak_force, whole.peak_force) &&
         same(early.hold_moment, whole.hold_moment) &&
         same(early.bending_moment, whole.bending_moment);
}

Found compare(Deployment& deployment, const Scene& scene, const Integration& how, Goal goal,
              long run) {
  const Outcome early = deployment.run(scene, how, goal);
  goal.to_t_end = true;
  const Outcome whole = deployment.run(scene, how, goal);
  Found found;
  found.runs = 1, found.deployed = early.status == Status::deployed;
  found.failed = early.status == Status::failed || whole.status == Status::failed;
  found.early = early.t_end < whole.t_end;
  found.lost = !found.failed && !nothing_lost(early, whole, goal);
  found.evaluations = static_cast<double>(early.work.rhs_evaluations);
  found.of_whole = static_cast<double>(whole.work.rhs_evaluations);
  if (found.early && found.deployed)
    found.tails = 1, found.tail = early.t_end - early.latches.back().time;
  if (found.lost) fmt::print("  run {} has lost something\n", run);
  if (found.failed)
    fmt::print("  run {} fails: {}\n", run, early.reason.empty() ? whole.reason : early.reason);
  return found;
}

/// @param goal of the early runs
Found compare_all(const Campaign& campaign, const Goal& goal) {
  const long runs = campaign.sampling.runs;
  const RunPlan plan(campaign);
  std::atomic<long> next = 0;
  std::mutex mutex;
  Found all;
  const auto work = [&] {
    Deployment deployment;
    Scene scene = campaign.scene;
    std::vector<double> draws(campaign.dispersions.size());
    Found own;
    for (long k = next++; k < runs; k = next++) {
      plan.draw(k, draws);
      apply(campaign, draws, campaign.scene, scene);
      own.add(compare(deployment, scene, campaign.integration, goal, k));
    }
    const std::lock_guard lock(mutex);
    all.add(own);
  };
  std::vector<std::jthread> threads;
  for (unsigned k = 0; k < std::max(1U, std::thread::hardware_concurrency()); ++k)
    threads.emplace_back(work);
  threads.clear();
  return all;
}

/// A study's table, on the terminal and as a file.
class Report {
public:
  Report() {
    fmt::print("{:24} {:>7} {:>8} {:>11} {:>5} {:>6} {:>8} {:>17} {:>9}\n", "campaign", "runs",
               "deployed", "ended early", "lost", "failed", "tail, s", "evaluations a run",
               "to t_end");
  }

  void add(const std::string& name, const Found& found) {
    const auto runs = static_cast<double>(found.runs);
    const double tail = found.tail / static_cast<double>(std::max(1L, found.tails));
    fmt::print("{:24} {:7} {:8} {:11} {:5} {:6} {:8.3f} {:17.0f} {:9.0f}\n", name, found.runs,
               found.deployed, found.early, found.lost, found.failed, tail,
               found.evaluations / runs, found.of_whole / runs);
    table_.add({name, runs, static_cast<double>(found.deployed), static_cast<double>(found.early),
                static_cast<double>(found.lost), static_cast<double>(found.failed), tail,
                found.evaluations / runs, found.of_whole / runs});
    faults_ += found.lost + found.failed;
  }

  [[nodiscard]] const study::Table& table() const { return table_; }
  [[nodiscard]] long faults() const { return faults_; }

private:
  study::Table table_{"campaign", "runs",     "deployed",          "ended early", "lost",
                      "failed",   "tail [s]", "evaluations a run", "to t_end"};
  long faults_ = 0; ///< runs that lost something or failed
};

long study_all(const study::StudyOptions& options) {
  Report report;
  for (const std::string& file : options.files) {
    const Campaign campaign = read_campaign_file(file);
    report.add(file, compare_all(campaign, RunPlan(campaign).goal()));
  }
  for (const Case& one : cases) {
    if (!options.files.empty()) break;
    Campaign campaign = read_campaign_file(fmt::format("studies/campaigns/{}.json", one.campaign));
    campaign.sampling.seed = one.seed;
    campaign.sampling.runs = options.quick ? 100 : one.runs;
    campaign.integration.t_end = one.t_end;
    report.add(one.campaign, compare_all(campaign, {}));
  }
  report.table().write(options.folder / "early_end.csv");
  return report.faults();
}

} // namespace

int main(int count, char** arguments) {
  long faults = 0;
  const int status = study::run_study(
      count, arguments, "early_end",
      "What an early end of runs saves, and whether it loses a result",
      [&](const study::StudyOptions& options) { faults = study_all(options); },
      "Campaigns in place of the study's own");
  return status != 0 ? status : faults > 0 ? 1 : 0;
}
