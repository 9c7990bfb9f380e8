// How finely the runs of a fit are sampled: a trace that the model made itself must be found again.
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/engine/runs/sampled_motion.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The panel with a stiff latch, whose damping is dispersed: it rings with a period of 34 ms.
Campaign ringing_campaign(double damping_std = 0.1) {
  Json json = panel_campaign();
  json["scene"]["hinges"][0]["latch"] = {{"stiffness", 1e5}, {"damping", 40}};
  json["dispersions"] = parse_json(R"([ { "name": "damping", "apply": "scale",
    "distribution": { "type": "normal", "mean": 1, "std": 0.1 },
    "to": ["hinges.root.latch.damping"] } ])");
  json["dispersions"][0]["distribution"]["std"] = damping_std;
  json["integration"]["t_end"] = 4;
  return campaign_of(json);
}

/// The nominal run's column at multiples of `pace` from `begin` on, each moved by `jitter` of that or less.
std::string own_trace(const Campaign& campaign, std::size_t column, double begin, double pace,
                      double jitter = 0) {
  constexpr double fine = 1e-4;
  const SampledColumns columns{{column}, fine, campaign.integration.t_end - fine / 2};
  const RunPlan plan(
      campaign,
      [](long, std::span<Tails> u) {
        std::ranges::fill(u, Tails{.5, .5});
      },
      columns);
  const std::vector<double> samples = Runner(plan).run(0).outputs;
  RandomStream random(1, 0, stream_name("jitter"));
  std::string text = "t,y\n";
  for (long k = 0; begin + (static_cast<double>(k) + 1) * pace < campaign.integration.t_end; ++k) {
    const double t = begin + pace * (static_cast<double>(k) + jitter * open_uniform(random()));
    const auto at = static_cast<std::size_t>(std::llround(t / fine));
    text += csv_cell(fine * static_cast<double>(at)) + "," + csv_cell(samples.at(2 * at)) + "\n";
  }
  return text;
}

struct SelfFit {
  FitSpec spec;
  FitResult result;
};

/// Fits the damping to a run's own trace.
SelfFit self_fit(const Campaign& campaign, std::size_t column, const std::string& recorded,
                 Json std, double clock_std = 0) {
  const Folder folder;
  folder.write("t.csv", recorded);
  Json tests =
      parse_json(R"({ "tests": [ { "name": "itself", "trace": { "file": "t.csv", "time": "t",
      "correlated": false } } ], "fit": { "parameters": ["damping"], "samples": 400, "starts": 2 } })");
  Json measured{{"column", "y"}};
  if (!std.is_null()) measured["std"] = std;
  tests["tests"][0]["trace"]["columns"][trajectory_columns(campaign.scene)[column]] = measured;
  if (clock_std > 0) tests["tests"][0]["trace"]["time_offset_std"] = clock_std;
  FitSpec spec = read_fit(tests, "", folder.path(), campaign);
  FitResult result = fitted(campaign, spec);
  return {std::move(spec), std::move(result)};
}

constexpr std::size_t angle = 1, rate = 2, moment = 3; // columns of root

} // namespace

TEST_CASE("a model finds its own trace again: angle, rate and moment of a shock, at any times",
          "[fit]") {
  const Campaign campaign = ringing_campaign();
  for (const auto& [column, std] : {std::pair(angle, 2e-5), {rate, 0.005}, {moment, 1.0}})
    for (const auto& [jitter, clock] : {std::pair(0.0, 0.0), {0.9, 0.0}, {0.0, 1e-3}}) {
      if (column == moment && clock + jitter > 0)
        continue; // it jumps by a hundred σ: no interval resolves that
      const auto [spec, result] =
          self_fit(campaign, column, own_trace(campaign, column, 0, 0.002, jitter), std, clock);
      const FittedParameter& damping = result.parameters.at(0);
      CAPTURE(column, jitter, clock, damping.mode, damping.std, damping.score_std);
      CHECK(damping.std < 0.06); // the trace tells it
      CHECK(std::abs(damping.mode - 1) < 0.15 * damping.std);
      CHECK(result.channels.at(0).outliers.empty());
      CHECK(result.interpolated.empty());
    }
}

TEST_CASE("a coarse grid serves where nothing is fast, and unknown noise is judged by the trace",
          "[fit]") {
  const auto intervals = [](const Campaign& campaign, std::size_t column,
                            const std::string& recorded, Json std) {
    const Folder folder;
    folder.write("t.csv", recorded);
    Json tests =
        parse_json(R"({ "tests": [ { "name": "a", "trace": { "file": "t.csv", "time": "t" } } ],
      "fit": { "parameters": ["damping"] } })");
    Json measured{{"column", "y"}};
    if (!std.is_null()) measured["std"] = std;
    tests["tests"][0]["trace"]["columns"][trajectory_columns(campaign.scene)[column]] = measured;
    FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    const ParameterSpace space(campaign, spec);
    ThreadEvaluator evaluator({.threads = 1}, never);
    const std::vector<FitPoint> points{FitPoint::Constant(1, -0.5), FitPoint::Zero(1),
                                       FitPoint::Constant(1, 0.5)};
    const long runs = choose_intervals(spec.tests, spec.parameters, space, evaluator, points);
    CHECK(runs % 3 == 0);
    CHECK(runs >= 6);
    return spec.tests[0];
  };
  const Campaign campaign = ringing_campaign();
  const std::string ringing = own_trace(campaign, rate, 0, 0.002);
  CHECK(intervals(campaign, rate, ringing, 100.0).interval == 0.01); // noise far above the motion
  const FitTest fine = intervals(campaign, rate, ringing, 0.005);
  CHECK(fine.interval == Approx(0.002)); // the times themselves
  CHECK(fine.interpolation == 0);
  CHECK(intervals(campaign, rate, ringing, nullptr).interval ==
        Approx(0.002)); // no noise: 1e-5 of the range
  // times of no common step: the interval is halved until the interpolation does not count
  const FitTest odd = intervals(campaign, rate, own_trace(campaign, rate, 0, 0.002, 0.9), 0.005);
  CHECK(odd.interval < 0.01);
  CHECK(odd.interpolation <= most_interpolated);
  // before the latch nothing is fast
  std::string before = ringing.substr(0, ringing.find("\n2,") + 1);
  CHECK(intervals(campaign, rate, before, 1e-3).interval == Approx(0.01));
}
