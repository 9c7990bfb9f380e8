// Measures deployments per second. Compares packs of runs with one run at a time, and with a program as an engineer writes
// it with Boost.Odeint (the peer). Varies tolerance, lanes, threads and bodies. All times are of one process. Compare
// ratios.
//
//   build/release/studies/throughput            a table, and results/throughput/*.csv, .json
//   build/release/studies/throughput --quick    a tenth of the runs
//   /usr/bin/python3 studies/plots/plot_throughput.py results/throughput

#include "core/deployment.hpp"
#include "core/packs/instruction_set.hpp"
#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "studies/peers/plain_odeint.hpp"
#include "studies/support/pack_kernel.hpp"
#include "studies/support/study.hpp"
#include "studies/support/whole_campaigns.hpp"
#include "studies/support/wing_runs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <thread>

using namespace wingspread;
using namespace wingspread::study;
using Json = nlohmann::ordered_json;

namespace {

bool same(const Outcome& a, const Outcome& b) {
  bool same = a.status == b.status && a.t_end == b.t_end && a.latches.size() == b.latches.size() &&
              a.work.rhs_evaluations == b.work.rhs_evaluations &&
              a.final.angles == b.final.angles && a.final.rates == b.final.rates;
  for (std::size_t k = 0; same && k < a.latches.size(); ++k)
    same = a.latches[k].time == b.latches[k].time && a.latches[k].rates == b.latches[k].rates;
  for (std::size_t k = 0; same && k < a.peak_moment.size(); ++k)
    same = a.peak_moment[k].value == b.peak_moment[k].value;
  for (std::size_t k = 0; same && k < a.peak_force.size(); ++k)
    same = a.peak_force[k].value == b.peak_force[k].value;
  return same;
}

long differing(const std::vector<Outcome>& a, const std::vector<Outcome>& b) {
  long count = 0;
  for (std::size_t k = 0; k < a.size(); ++k) count += !same(a[k], b[k]);
  return count;
}

// ---- accuracy: against runs at rtol 1e-13, which the accuracy study compares with its oracles

/// Infinite where a value is missing (NaN).
double relative(double value, double exact) {
  const double error = value == exact ? 0 : std::abs(value - exact) / std::abs(exact);
  return error >= 0 ? error : std::numeric_limits<double>::infinity();
}

double error_of(const Outcome& out, const Outcome& exact) {
  double worst = out.latches.size() == exact.latches.size() ? 0 : 1;
  for (std::size_t k = 0; k < std::min(out.latches.size(), exact.latches.size()); ++k) {
    const LatchEvent &a = out.latches[k], &b = exact.latches[k];
    worst = std::max({worst, a.hinge == b.hinge ? 0.0 : 1.0, relative(a.time, b.time),
                      relative(a.rates[a.hinge], b.rates[b.hinge])});
  }
  for (std::size_t k = 0; k < out.peak_moment.size(); ++k)
    worst = std::max(worst, relative(out.peak_moment[k].value, exact.peak_moment[k].value));
  return worst;
}

/// The largest error of the peer's latches. Its peaks are left out: the peer samples them, and no tolerance improves them.
double error_of(const PlainOutcome& out, const Outcome& exact) {
  double worst = 0;
  for (const LatchEvent& latch : exact.latches)
    worst = std::max({worst, relative(out.latch_time[latch.hinge], latch.time),
                      relative(out.latch_rate[latch.hinge], latch.rates[latch.hinge])});
  return worst;
}

const std::vector<double> tolerances{3e-4, 1e-4, 3e-5, 1e-5,  3e-6,  1e-6,  3e-7,  1e-7,  3e-8,
                                     1e-8, 3e-9, 1e-9, 3e-10, 1e-10, 3e-11, 1e-11, 3e-12, 1e-12};

/// The loosest tolerance at which the largest error of 32 units, `judge(rtol)`, stays below the level; none if no
/// tolerance brings it there.
template <class Judge> std::optional<double> loosest(double level, Judge judge) {
  for (const double rtol : tolerances)
    if (judge(rtol) <= level) return rtol;
  return std::nullopt;
}

class Throughput {
public:
  Throughput(const StudyOptions& options)
      : options_(options), share_(options.quick ? 0.1 : 1), seed_(seed_wing()) {}

  void run() {
    kernels();
    packs();
    equal_error();
    against_tolerance();
    against_bodies();
    threads();
    json_["campaigns"] = campaign_rates(options_);
    json_["panels"] = panel_rates(options_);
    std::ofstream(options_.folder / "throughput.json") << json_.dump(2) << '\n';
  }

private:
  [[nodiscard]] long runs(double full) const {
    return std::max(32L, static_cast<long>(full * share_));
  }

  void kernels() {
    fmt::print("one acceleration evaluation, ns a lane (springs, friction, latches not counted):\n"
               "independent; each needing the last; so in two packs in turn\n");
    const auto shown = [](const study::KernelTimes& times) {
      return Json{{"independent", times.independent},
                  {"dependent", times.dependent},
                  {"two_in_turn", times.two_in_turn}};
    };
    Json rows = Json::array();
    for (const int n : {3, 10}) {
      Json row{{"bodies", n}};
      if (has_avx512()) row["avx512_ns"] = shown(avx512_evaluation(n));
      if (has_avx2()) row["avx2_ns"] = shown(avx2_evaluation(n));
      fmt::print("  n = {:<3} {}\n", n, row.dump());
      rows.push_back(row);
    }
    json_["evaluation_a_lane"] = rows;
  }

  void packs() {
    fmt::print("\nthe seed wing dispersed, default tolerance: µs a run of one core\n"
               "  {:<24}",
               "");
    for (const InstructionSet set : instruction_sets()) fmt::print("{:>9}", to_string(set));
    for (std::size_t k = 1; k < instruction_sets().size(); ++k) fmt::print("{:>8}", "ratio");
    fmt::print("{:>10}{:>9}{:>8}\n", "lanes", "runs/s", "differ");
    Table table({"what", "set", "us", "ratio", "lanes full", "steps", "evaluations", "returns",
                 "scalar steps"});
    Json rows = Json::array();
    for (const What& what : {every_output, moments_too, latches_only, first_latch, whole_run}) {
      const Integration how = within(1e-8, what);
      const long count = runs(2000);
      Made scalar;
      std::map<InstructionSet, double> us;
      double full = 0;
      long differ = 0;
      Json row{{"what", what.name}};
      for (const InstructionSet set : instruction_sets()) {
        Made made = make(seed_, set, how, what.goal, count);
        us[set] = made.us;
        if (set == InstructionSet::scalar) scalar = made;
        differ += differing(scalar.outcomes, made.outcomes);
        full = made.lanes.trial_steps > 0 ? static_cast<double>(made.lanes.busy) /
                                                static_cast<double>(made.lanes.trial_steps)
                                          : 1;
        const auto each = [&](long n) {
          return static_cast<double>(n) / static_cast<double>(count);
        };
        table.add({std::string(what.name), std::string(to_string(set)), made.us,
                   scalar.us / made.us, full, made.steps, made.evaluations,
                   each(made.lanes.returns), each(made.lanes.scalar)});
        row[to_string(set)] = {
            {"us", made.us}, {"ratio", scalar.us / made.us}, {"lanes_full", full}};
      }
      row["steps"] = scalar.steps, row["evaluations"] = scalar.evaluations, row["differ"] = differ;
      fmt::print("  {:<24}", what.name);
      for (const auto& [set, time] : us) fmt::print("{:>9.1f}", time);
      for (const auto& [set, time] : us)
        if (set != InstructionSet::scalar) fmt::print("{:>8.2f}", scalar.us / time);
      fmt::print("{:>9.1f}%{:>9.0f}{:>8}\n", 100 * full, 1e6 / us.rbegin()->second, differ);
      std::fflush(stdout);
      rows.push_back(row);
    }
    table.write(options_.folder / "packs.csv");
    json_["packs"] = rows;
  }

  void equal_error() {
    fmt::print("\nat equal error (largest relative error of 32 units): µs a run of one core\n"
               "  {:<24}{:>9}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}{:>8}\n",
               "", "error", "rtol", "here", "in packs", "rtol", "odeint", "ratio", "scalar");
    const InstructionSet widest = instruction_sets().back();
    Json rows = Json::array();
    for (const What& what : {first_latch, latches_only, early_stop, whole_run})
      for (const double level : {1e-6, 1e-9}) {
        const bool first = what.goal.first_latch_only;
        const auto exact =
            make(seed_, InstructionSet::scalar, within(1e-13, what), what.goal, 32, 1).outcomes;
        Scene unit = seed_.drawing();
        const auto here = loosest(level, [&](double at) {
          const auto outcomes = make(seed_, widest, within(at, what), what.goal, 32, 1).outcomes;
          double worst = 0;
          for (std::size_t k = 0; k < exact.size(); ++k)
            worst = std::max(worst, error_of(outcomes[k], exact[k]));
          return worst;
        });
        const auto plain = [&](double at, long k) {
          seed_.set(unit, k);
          return plain_odeint(unit, at, seed_t_end, first); // the peer never ends early
        };
        const auto there = loosest(level, [&](double at) {
          double worst = 0;
          for (long k = 0; k < std::ssize(exact) && worst <= level; ++k)
            worst = std::max(worst, error_of(plain(at, k), exact[static_cast<std::size_t>(k)]));
          return worst;
        });
        if (!here || !there) {
          fmt::print("  {:<24}{:>9.0e}   no tolerance of {} brings all errors below it\n",
                     what.name, level,
                     here    ? "odeint"
                     : there ? "ours"
                             : "either");
          continue;
        }
        const double rtol = *here, their_rtol = *there;
        const double alone =
            make(seed_, InstructionSet::scalar, within(rtol, what), what.goal, runs(500)).us;
        const double packed = make(seed_, widest, within(rtol, what), what.goal, runs(2000)).us;
        double theirs = 1e30;
        for (int time = 0; time < 3; ++time) {
          const double start = thread_seconds();
          const long count = runs(first ? 1000 : 200);
          for (long k = 0; k < count; ++k) (void)plain(their_rtol, k);
          theirs = std::min(theirs, 1e6 * (thread_seconds() - start) / static_cast<double>(count));
        }
        fmt::print("  {:<24}{:>9.0e}{:>9.0e}{:>9.1f}{:>10.2f}{:>10.0e}{:>10.1f}{:>10.1f}{:>8.1f}\n",
                   what.name, level, rtol, alone, packed, their_rtol, theirs, theirs / packed,
                   theirs / alone);
        std::fflush(stdout);
        rows.push_back({{"what", what.name},
                        {"error", level},
                        {"rtol", rtol},
                        {"scalar_us", alone},
                        {"packs_us", packed},
                        {"odeint_rtol", their_rtol},
                        {"odeint_us", theirs},
                        {"odeint_over_packs", theirs / packed},
                        {"odeint_over_scalar", theirs / alone}});
      }
    json_["equal_error"] = rows;
  }

  void against_tolerance() {
    fmt::print("\nagainst tolerance: runs a second of one core, all outputs\n");
    Table table({"rtol", "set", "runs a second", "evaluations"});
    for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
      fmt::print("  rtol {:<8.0e}", rtol);
      for (const InstructionSet set : instruction_sets()) {
        const Made made =
            make(seed_, set, within(rtol, every_output), every_output.goal, runs(300), 2);
        table.add({rtol, std::string(to_string(set)), 1e6 / made.us, made.evaluations});
        fmt::print("{:>12.0f}", 1e6 / made.us);
      }
      fmt::print("\n");
      std::fflush(stdout);
    }
    table.write(options_.folder / "tolerance.csv");
  }

  /// Times the first seconds of a folded stack of n equal panels.
  void against_bodies() {
    fmt::print("\nagainst bodies: ns an evaluation a run, whole steps\n");
    Table table({"bodies", "set", "ns an evaluation", "ns an evaluation and body"});
    const What what{
        "", {.peak_moment = false, .peak_force = false, .audit = false, .to_t_end = true}, 3};
    for (const int n : {1, 2, 3, 4, 6, 10, 30, 100, 300}) {
      const Units units(stack(n));
      fmt::print("  n = {:<5}", n);
      for (const InstructionSet set : instruction_sets()) {
        const Made made =
            make(units, set, within(1e-6, what), what.goal, runs(n < 30 ? 480 : 96), 2);
        const double ns = 1e3 * made.us / made.evaluations;
        table.add({double(n), std::string(to_string(set)), ns, ns / n});
        fmt::print("{:>10.1f} ({:.1f} a body)", ns, ns / n);
      }
      fmt::print("\n");
      std::fflush(stdout);
    }
    table.write(options_.folder / "bodies.csv");
  }

  void threads() {
    const int most = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    fmt::print("\nthe seed campaign through the sampler, all outputs: runs a second\n");
    Campaign campaign = read_campaign_file("studies/campaigns/seed.json");
    const long count = runs(20000);
    campaign.sampling.runs = count;
    const RunPlan plan(campaign);
    Table table({"threads", "runs a second", "efficiency"});
    Json rows = Json::array();
    double alone = 0;
    for (int team = 1; team <= most; team *= 2) {
      double best = 1e30;
      for (int time = 0; time < 3; ++time) {
        const std::atomic<bool> never{false};
        const double start = wall_seconds();
        const auto drop = [](const Batch&) {};
        (void)ThreadEvaluator({.threads = team}, never).make(plan, {0, count}, {drop, true});
        best = std::min(best, wall_seconds() - start);
      }
      const double rate = static_cast<double>(count) / best;
      if (team == 1) alone = rate;
      const double efficiency = rate / alone / team;
      table.add({double(team), rate, efficiency});
      rows.push_back({{"threads", team}, {"runs_a_second", rate}, {"efficiency", efficiency}});
      fmt::print("  {} thread{} {:>10.0f}   efficiency {:.3f}\n", team, team == 1 ? " " : "s", rate,
                 efficiency);
    }
    table.write(options_.folder / "threads.csv");
    json_["threads"] = rows;
  }

  StudyOptions options_;
  double share_;
  Units seed_;
  Json json_;
};

} // namespace

int main(int count, char** arguments) {
  return run_study(count, arguments, "throughput",
                   "How many deployments a second, and against what",
                   [](const StudyOptions& options) { Throughput(options).run(); });
}
