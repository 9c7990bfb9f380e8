#include "montecarlo/analyses/fit/mode_search.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A panel's latch time and its friction, measured; the spring and the friction are sought.
FitSpec fit_of_time_and_friction(const Campaign& campaign) {
  return read_fit(parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 2, "std": 0.01 } ,
                  { "parameter": "hinges.root.friction.scale", "value": 1, "std": 0.1 } ] } ],
    "fit": { "parameters": ["spring", "friction"] } })"),
                  "", ".", campaign);
}

/// That fit, and its runs on this many threads.
struct TimerFit {
  explicit TimerFit(int threads) : evaluator({.threads = threads}, never) {}

  Campaign campaign = campaign_of(panel_campaign());
  FitSpec spec = fit_of_time_and_friction(campaign);
  ParameterSpace space{campaign, spec};
  ThreadEvaluator evaluator;
  TestRuns runs{spec.tests, spec.parameters, space, evaluator};
};

} // namespace

TEST_CASE("derivatives of a latch time have the closed form's value to 1e-5") {
  TimerFit fit(2);
  FitPoint at(2);
  at << 0.5, -1;
  const Eigen::MatrixXd slopes = jacobian_of(fit.runs, at);
  const double s = 1 + 0.05 * 0.5, f = 1 - 0.3, torque = 2 * s - 0.3 * f;
  const double t = panel_latch_time(s, f);
  CHECK(slopes(0, 0) == Approx(-0.5 * t / torque * 2 * 0.05)
                            .epsilon(1e-5)); // a run's error of 1e-12 s over a step of 1e-5
  CHECK(slopes(0, 1) == Approx(0.5 * t / torque * 0.3 * 0.3).epsilon(1e-5));
  CHECK(slopes(1, 0) == Approx(0).margin(1e-9));
  CHECK(slopes(1, 1) == Approx(0.3).epsilon(1e-9));
  CHECK(fit.runs.runs() == 4);
}

TEST_CASE("what the runs around a point lack has no slope, and leaves the other slopes alone") {
  TimerFit fit(1);
  FitPoint at(2);
  at << 0, 20; // a friction of 7 · 0.3 N·m, more than the spring's 2
  const Eigen::MatrixXd slopes = jacobian_of(fit.runs, at);
  REQUIRE((slopes.rows() == 2 && slopes.cols() == 2));
  CHECK(slopes(0, 0) == 0);
  CHECK(slopes(0, 1) == 0);
  CHECK(slopes(1, 0) == Approx(0).margin(1e-9));
  CHECK(slopes(1, 1) == Approx(0.3).epsilon(1e-9));
}

TEST_CASE("Laplace's approximation of one torque from one latch time is Bayes' rule, linearized") {
  const Campaign campaign = campaign_of(panel_campaign(0.01));
  Json tests = parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 0, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"] } })");
  const double measured = panel_latch_time(1.01, 1);
  tests["tests"][0]["values"][0]["value"] = measured;
  const FitSpec spec = read_fit(tests, "", ".", campaign);
  const ParameterSpace space(campaign, spec);
  ThreadEvaluator evaluator({.threads = 1}, never);
  TestRuns runs(spec.tests, spec.parameters, space, evaluator);
  const FitData data = data_of(spec.tests);
  const std::vector<FitPoint> starts{FitPoint::Zero(1)};
  const FitMode mode = find_modes(data, runs, starts).front();
  const double s = 1 + 0.01 * mode.at[0], t = panel_latch_time(s, 1), slope = -t / (2 * s - 0.3);
  // Its mode: the slope of log π is zero. Its deviation: 1/sd² = 1/σ_s² + (t'/σ)².
  CHECK((s - 1) / 1e-4 ==
        Approx((measured - t) * slope / 1e-4).epsilon(1e-4)); // friction is regularized
  const double laplace = 1 / std::sqrt(1 / 1e-4 + slope * slope / 1e-4);
  CHECK(0.01 * std::sqrt(mode.covariance(0, 0)) == Approx(laplace).epsilon(1e-5));
  // The exact posterior is not normal: by quadrature, its mean lies 1.01 % of its sd above the mode, and its sd is 0.20 %
  // less than Laplace's. In log τ the mean is met to 6e-5.
  double sum = 0, first = 0, second = 0;
  for (int k = -4000; k <= 4000; ++k) {
    const double x = k * 2e-5, z = x / 0.01, r = (measured - panel_latch_time(1 + x, 1)) / 0.01;
    const double w = std::exp(-0.5 * (z * z + r * r));
    sum += w, first += w * x, second += w * x * x;
  }
  const double mean = first / sum, sd = std::sqrt(second / sum - mean * mean);
  CHECK((1 + mean - s) / sd == Approx(0.0101).margin(5e-4));
  CHECK(laplace / sd - 1 == Approx(0.0020).margin(3e-4));
  CHECK(std::abs(std::log(2 * s) - std::log(2 * (1 + mean))) < 1e-4);
}

TEST_CASE("starts that lead to one mode find it once, whichever start is the first") {
  TimerFit fit(2);
  const FitData data = data_of(fit.spec.tests);
  const auto point = [](double spring, double friction) {
    FitPoint at(2);
    at << spring, friction;
    return at;
  };
  const FitMode alone = find_modes(data, fit.runs, std::vector{point(0, 0)}).front();
  const FitPoint stalls = point(0, 20); // its mode is itself: no run near it latches
  for (const auto& starts : {std::vector{point(0, 0), point(1, -1), point(-2, 0.5)},
                             {point(-2, 0.5), stalls, point(1, -1), point(0, 0)}}) {
    const std::vector<FitMode> modes = find_modes(data, fit.runs, starts);
    REQUIRE(modes.size() == 1);
    CHECK(distance_of(alone, modes[0]) < 1e-3);
    CHECK(modes[0].log_posterior == Approx(alone.log_posterior).epsilon(1e-6));
  }
}

TEST_CASE("two modes are found, the higher one first; one of 30 nats less is none") {
  const auto modes_of = [](double mean, double std) {
    const Campaign campaign = campaign_of(two_mode_campaign(mean, std));
    const FitSpec spec = read_fit(two_mode_test(), "", ".", campaign);
    const ParameterSpace space(campaign, spec);
    ThreadEvaluator evaluator({.threads = 2}, never);
    TestRuns runs(spec.tests, spec.parameters, space, evaluator);
    std::vector<FitPoint> starts;
    for (const double rate : {-0.7, 0.75, -0.85, 0.9})
      starts.push_back(FitPoint::Constant(1, (rate - mean) / std));
    return find_modes(data_of(spec.tests), runs, starts);
  };
  const std::vector<FitMode> modes = modes_of(0.1, 0.5);
  REQUIRE(modes.size() == 2);
  CHECK(modes[0].at[0] == Approx(0.7 / 0.5).epsilon(2e-3));
  CHECK(modes[1].at[0] == Approx(-0.9 / 0.5).epsilon(2e-3));
  // the priors' difference, less what the modes give way by
  CHECK(modes[0].log_posterior - modes[1].log_posterior ==
        Approx((1.8 * 1.8 - 1.4 * 1.4) / 2).margin(5e-3));
  CHECK(modes_of(0.18, 0.1).size() == 2); // (9.8² − 6.2²)/2 = 28.8 nats
  CHECK(modes_of(0.2, 0.1).size() == 1);  // (10² − 6²)/2 = 32 nats
}

TEST_CASE("starts: the prior's median, then points of a design") {
  const auto points = first_points(3, 9, 1);
  REQUIRE(points.size() == 9);
  CHECK(points[0] == FitPoint::Zero(3));
  CHECK(points == first_points(3, 9, 1));
  for (Eigen::Index i = 0; i < 3; ++i) {
    int above = 0;
    for (std::size_t k = 1; k < 9; ++k) above += points[k][i] > 0;
    CHECK(above == 4); // Sobol' points: half of them on either side
  }
}

// The latch's shock is at another time in each run, so that a run far from the trace has no slope towards it.
TEST_CASE("where the starts asked for lead nowhere near a trace, more are tried") {
  Json json = panel_campaign(0.05, 0.3);
  json["integration"]["t_end"] = 3.2;
  json["outputs"] = {"latch_time"};
  const auto moments = [&](double spring, double friction) {
    Json truth = json;
    truth["scene"]["hinges"][0]["spring"]["scale"] = spring;
    truth["scene"]["hinges"][0]["friction"]["scale"] = friction;
    truth.erase("dispersions");
    const Campaign campaign = campaign_of(truth);
    const RunPlan plan(campaign, {}, SampledColumns{{3}, 0.02, 3.01});
    return Runner(plan).run(0).outputs;
  };
  const Campaign campaign = campaign_of(json);
  const Folder folder;
  // of the last two, a local mode is 7 and 4 σ from the trace
  for (const auto& [spring, friction, std] :
       {std::tuple(1.05, 0.74, "0.2"), {0.97, 1.3, "0.2"}, {0.97, 1.3, "3"}, {1.05, 0.74, "6"}}) {
    std::string text = "t,m\n";
    const std::vector<double> measured = moments(spring, friction);
    for (std::size_t k = 0; 2 * k < measured.size(); ++k)
      text += csv_cell(0.02 * static_cast<double>(k)) + "," + csv_cell(measured[2 * k]) + "\n";
    folder.write("m.csv", text);
    const FitSpec spec =
        read_fit(parse_json(R"({ "tests": [ { "name": "shock", "trace": { "file": "m.csv",
        "time": "t", "correlated": false, "columns": { "root.moment": { "column": "m", "std": )" +
                            std::string(std) + R"( } } } } ],
      "fit": { "parameters": ["spring", "friction"], "starts": 1, "samples": 300 } })"),
                 "", folder.path(), campaign);
    const FitResult result = fitted(campaign, spec);
    CAPTURE(spring, result.parameters[0].mode, result.parameters[1].mode);
    CHECK(result.channels.at(0).rms < 0.2); // the trace has no noise
    CHECK(result.parameters[0].mode == Approx(spring).margin(3 * result.parameters[0].std));
  }
}
