#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/analyses/fit/fit_study.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <functional>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Mean and standard deviation of a density on a grid.
LawMoments moments_on_grid(double from, double to,
                           const std::function<double(double)>& log_density) {
  constexpr int n = 20000;
  double sum = 0, first = 0, second = 0, largest = -1e300;
  for (int k = 0; k <= n; ++k) largest = std::max(largest, log_density(from + (to - from) * k / n));
  for (int k = 0; k <= n; ++k) {
    const double x = from + (to - from) * k / n, w = std::exp(log_density(x) - largest);
    sum += w, first += w * x, second += w * x * x;
  }
  return {first / sum, std::sqrt(second / sum - first * first / sum / sum)};
}

FitSpec spec_of(const char* text, const std::filesystem::path& folder, const Campaign& campaign) {
  return read_fit(parse_json(text), "tests.json", folder, campaign);
}

constexpr const char* both_ways = R"({ "tests": [
    { "name": "one way", "trace": { "file": "t1.csv", "time": "t", "correlated": false,
               "columns": { "root.angle": { "column": "th", "std": 0.005 } } } },
    { "name": "both ways", "set": { "hinges.root.initial_rate": 0.8 },
      "trace": { "file": "t2.csv", "time": "t", "correlated": false,
               "columns": { "root.angle": { "column": "th", "std": 0.005 } } } } ],
  "fit": { "parameters": ["spring", "friction"], "samples": 800, "starts": 2 } })";

/// Covariance of spring s and friction f in u by traces with these initial rates: the inverse of Fisher's information and
/// the prior's, with slopes of the closed form.
Eigen::Matrix2d fisher_covariance(double s, double f, std::initializer_list<double> rates) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
  const double h = 1e-5;
  for (const double rate : rates)
    for (int k = 0; k <= 80; ++k) {
      const double t = 0.02 * k;
      const Eigen::Vector2d slope{
          0.05 * (panel_angle(t, s + h, f, rate) - panel_angle(t, s - h, f, rate)) / (2 * h),
          0.3 * (panel_angle(t, s, f + h, rate) - panel_angle(t, s, f - h, rate)) / (2 * h)};
      information += slope * slope.transpose() / (0.005 * 0.005);
    }
  return information.inverse();
}

} // namespace

TEST_CASE("the posterior of one torque from one latch time is that of Bayes' rule") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.01));
  const double measured = panel_latch_time(1.01, 1), std = 0.01;
  Json tests = parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 0, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "samples": 1000, "starts": 2 } })");
  tests["tests"][0]["values"][0]["value"] = measured;
  const FitResult result = fitted(campaign, read_fit(tests, "", folder.path(), campaign));
  REQUIRE(result.finished);
  const auto log_density = [&](double s) {
    return -0.5 * std::pow((s - 1) / 0.01, 2) -
           0.5 * std::pow((panel_latch_time(s, 1) - measured) / std, 2);
  };
  const LawMoments exact = moments_on_grid(0.94, 1.06, log_density);
  const FittedParameter& spring = result.parameters.at(0);
  const double error = exact.standard_deviation / std::sqrt(1000.0); // of the mean over the samples
  CHECK(std::abs(spring.mean - exact.mean) < 4 * error);
  CHECK(std::abs(spring.std - exact.standard_deviation) < 4 * error / std::sqrt(2.0));
  double mode = 1; // of the exact density, by bisection of its slope
  for (double step = 0.02; step > 1e-9; step /= 2)
    mode += log_density(mode + 1e-7) > log_density(mode - 1e-7) ? step : -step;
  CHECK(std::abs(spring.mode - mode) < 1e-3 * exact.standard_deviation);
  CHECK(result.channels.at(0).sigmas ==
        Approx((measured - panel_latch_time(mode, 1)) / std).margin(1e-3));
  CHECK(spring.prior_std == Approx(0.01).epsilon(1e-3));
  // the written rows: as many as asked for, and as widely spread as all samples
  REQUIRE(result.posterior.rows.size() == 1000);
  std::vector<double> springs;
  for (const std::vector<double>& row : result.posterior.rows) {
    REQUIRE(row.size() == 1);
    springs.push_back(row[0]);
  }
  const Moments of_rows = moments(springs);
  CHECK(std::abs(of_rows.mean - exact.mean) < 4 * error);
  CHECK(std::abs(of_rows.std - exact.standard_deviation) < 4 * error / std::sqrt(2.0));
}

TEST_CASE("one trace sees only the difference of spring and friction, and the fit says so") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  const Campaign campaign = campaign_of(panel_campaign());
  const FitResult result = fitted(campaign, spec_of(one_way, folder.path(), campaign));
  REQUIRE(result.finished);
  CHECK(result.correlation(0, 1) > 0.98);
  REQUIRE(result.directions.size() == 2);
  CHECK(result.directions[0].std_ratio == Approx(1).margin(0.1));
  CHECK(result.directions[1].std_ratio < 0.05);
  CHECK(describe(result.directions[0], {"spring", "friction"}, result.score_covariance,
                 result.prior_covariance)
            .starts_with("the tests tell spring and friction only by their difference"));
  CHECK(fit_text(result, spec_of(one_way, folder.path(), campaign)).find("IDENTIFIABILITY") !=
        std::string::npos);
  CHECK(result.channels.at(0).p_value > 0.01);
}

TEST_CASE("a test in both senses separates them, by as much as Fisher's information says") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  folder.write("t2.csv", panel_trace(1.02, 1.1, 0.8, 0.005, 2));
  const Campaign campaign = campaign_of(panel_campaign());
  const FitResult result = fitted(campaign, spec_of(both_ways, folder.path(), campaign));
  REQUIRE(result.finished);
  CHECK(std::abs(result.correlation(0, 1)) < 0.5);
  const Eigen::Matrix2d covariance =
      fisher_covariance(result.parameters[0].mode, result.parameters[1].mode, {0.0, 0.8});
  for (int i = 0; i < 2; ++i)
    CHECK(result.parameters[static_cast<std::size_t>(i)].score_std ==
          Approx(std::sqrt(covariance(i, i))).epsilon(0.1));
  CHECK(std::abs(result.parameters[0].mean - 1.02) < 4 * result.parameters[0].std);
  CHECK(std::abs(result.parameters[1].mean - 1.1) < 4 * result.parameters[1].std);
}

TEST_CASE("a candidate's expected information is what the test then gives") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  folder.write("t2.csv", panel_trace(1.02, 1.1, 0.8, 0.005, 2));
  const Campaign campaign = campaign_of(panel_campaign());
  Json with = parse_json(one_way);
  with["candidates"] = parse_json(R"([
    { "name": "again", "trace": { "times": { "to": 1.6, "step": "20 ms" },
                                  "columns": { "root.angle": { "std": 0.005 } } } },
    { "name": "both ways", "set": { "hinges.root.initial_rate": 0.8 },
      "trace": { "times": { "to": 1.6, "step": "20 ms" }, "columns": { "root.angle": { "std": 0.005 } } } },
    { "name": "torque test", "values": [ { "parameter": "hinges.root.friction.scale", "std": 0.03 } ] } ])");
  const FitResult before = fitted(campaign, read_fit(with, "", folder.path(), campaign));
  const FitResult after = fitted(campaign, spec_of(both_ways, folder.path(), campaign));
  REQUIRE(before.candidates.size() == 3);
  CHECK(before.candidates[0].information < before.candidates[1].information);
  CHECK(before.candidates[0].information < std::log(2.0)); // a repeat halves at most both variances
  CHECK(before.candidates[0].shrink[1] > 0.95);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(before.candidates[1].shrink[i] ==
          Approx(after.parameters[i].std / before.parameters[i].std).epsilon(0.15));
  // In u the friction's scale is 0.3 u: the test leaves 1/√(1/v + 0.3²/0.03²) of it.
  const double v =
      fisher_covariance(before.parameters[0].mode, before.parameters[1].mode, {0.0})(1, 1);
  CHECK(before.candidates[2].shrink[1] == Approx(std::sqrt(1 / (1 + v * 100))).epsilon(1e-4));
}

TEST_CASE("clock and sensor offsets, an unknown noise and parameters of one test's own are found") {
  const Folder folder;
  std::string late = "ms,th [deg]\n"; // the clock is 30 ms late, the encoder 1 deg off
  RandomStream random(3, 0, stream_name("late"));
  for (int k = 0; k <= 80; ++k) {
    const double z = inverse(Normal{}, tails_of_uniform(open_uniform(random())));
    const double angle = panel_angle(0.02 * k + 0.03, 1.02, 1.1);
    late += std::to_string(20 * k) + "," + csv_cell(angle * 180 / M_PI + 1 + 0.3 * z) + "\n";
  }
  folder.write("t1.csv", late);
  const Campaign campaign = campaign_of(panel_campaign(0.05, 0.01));
  const FitResult result =
      fitted(campaign, spec_of(R"({ "tests": [ { "name": "late", "own": ["friction"],
          "trace": { "file": "t1.csv", "time": { "column": "ms", "unit": "ms" }, "time_offset_std": "50 ms",
            "columns": { "root.angle": { "column": "th", "offset_std": "2 deg" } } } } ],
        "fit": { "parameters": ["spring", "friction"], "samples": 1000, "starts": 2 } })",
                               folder.path(), campaign));
  REQUIRE(result.finished);
  REQUIRE(result.parameters.size() == 4);
  CHECK(result.common == 1);
  CHECK(result.parameters[1].name == "friction of late");
  CHECK(result.parameters[2].name == "time offset of late");
  CHECK(result.parameters[3].name == "offset of root.angle of late");
  CHECK(result.parameters[2].mean == Approx(0.03).margin(4 * result.parameters[2].std));
  CHECK(result.parameters[3].mean == Approx(M_PI / 180).margin(4 * result.parameters[3].std));
  CHECK(result.parameters[3].std_ratio() < 0.5);
  CHECK(result.channels[0].rms * 180 / M_PI == Approx(0.3).epsilon(0.25)); // 81 numbers: 4 sd
}

TEST_CASE(
    "of two modes the study tells how far apart they are, and how much less the lower is worth") {
  const Campaign campaign = campaign_of(two_mode_campaign(0.1, 0.5));
  const FitSpec spec = read_fit(two_mode_test(), "", ".", campaign);
  const FitResult result = fitted(campaign, spec);
  REQUIRE(result.finished);
  REQUIRE(result.other_modes.size() == 1);
  const double latch_rate = std::sqrt(2 + 0.8 * 0.8), slope = 0.8 / latch_rate;
  const double sd = 1 / std::hypot(1 / 0.5, slope / 0.01); // of the initial rate, by the test
  CHECK(result.other_modes[0].distance == Approx(1.6 / sd).epsilon(5e-3));
  REQUIRE(result.other_modes[0].parameters.size() == 1);
  CHECK(result.other_modes[0].parameters[0] == Approx(-0.8).epsilon(2e-3));
  CHECK(result.other_modes[0].drop == Approx((1.8 * 1.8 - 1.4 * 1.4) / 2).margin(5e-3));
  CHECK(result.parameters.at(0).mode == Approx(0.8).epsilon(2e-3));
  long below = 0;
  for (const std::vector<double>& row : result.posterior.rows) below += row[0] < 0;
  const double share = 1 / (1 + std::exp(0.64)); // of the lower mode
  CHECK(static_cast<double>(below) / static_cast<double>(result.posterior.rows.size()) ==
        Approx(share).margin(4.5 * std::sqrt(share * (1 - share) / 400)));
}

TEST_CASE("a trace of another motion is told first") {
  const Folder folder;
  std::string wrong = "t,th\n";
  for (int k = 0; k <= 80; ++k)
    wrong += std::to_string(0.02 * k) + "," + csv_cell(std::sin(0.18 * k)) + "\n";
  folder.write("t1.csv", wrong);
  const Campaign campaign = campaign_of(panel_campaign());
  Json tests = parse_json(one_way);
  tests["fit"]["samples"] = 100;
  const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
  const FitResult result = fitted(campaign, spec);
  const auto findings = fit_findings(result, spec);
  REQUIRE_FALSE(findings.empty());
  CAPTURE(findings);
  CHECK(findings.front().starts_with("root.angle of \"one way\": the residuals are"));
  CHECK(fit_text(result, spec).starts_with("root.angle of"));
}

TEST_CASE("numbers that no run has, or that cannot be compared, are refused with their place") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign());
  const auto refused = [&](const Json& values) {
    Json tests = parse_json(R"({ "tests": [ { "name": "one" } ],
      "fit": { "parameters": ["spring"], "samples": 100, "starts": 2 } })");
    tests["tests"][0]["values"] = values;
    const FitSpec spec = read_fit(tests, "t.json", folder.path(), campaign);
    return message_of([&] {
      refuse_unpredictable(campaign, spec, {.pool = {.threads = 1}}, "t.json", never);
      return 0;
    });
  };
  const auto value = [](double measured, double std) {
    return Json{{"output", "root.latch_time"}, {"value", measured}, {"std", std}};
  };
  CHECK(refused(Json::array({value(2.3, 0.01)})).empty());
  CHECK(refused(Json::array({value(15, 0.01)})).empty()); // far off, and the findings say so
  CHECK_THAT(
      refused(Json::array({value(684, 0.6)})),
      Catch::StartsWith("t.json: /tests/0/values/0/value: found 684 s, beyond t_end = 20 s"));
  // numbers beyond t_end that are no times of outputs
  CHECK(refused(Json::array({{{"output", "root.peak_moment"}, {"value", 684}, {"std", 60}}}))
            .empty());
  CHECK(refused(
            Json::array({{{"parameter", "hinges.root.spring.scale"}, {"value", 684}, {"std", 60}}}))
            .empty());
  const std::string large = "found numbers too large to be compared with a run by their std";
  const Json spring{{"parameter", "hinges.root.spring.scale"}, {"value", 1e300}, {"std", 0.01}};
  CHECK_THAT(refused(Json::array({value(2.3, 0.01), spring})),
             Catch::StartsWith("t.json: /tests/0/values/1: " + large));
  CHECK_THAT(refused(Json::array({value(2.3, 1e-300)})),
             Catch::StartsWith("t.json: /tests/0/values/0: " + large));
  // what no fitted parameter changes tells nothing; what it changes does
  const Json coulomb{{"parameter", "hinges.root.friction.coulomb"}, {"value", 0.2}, {"std", 0.01}};
  CHECK_THAT(refused(Json::array({value(2.3, 0.01), coulomb})),
             Catch::StartsWith("t.json: /tests/0/values/1/parameter: ") &&
                 Catch::Contains("\"scale\""));
  const auto rate = [&](double measured) { // some -1.28 rad/s in all runs
    return refused(
        Json::array({{{"output", "root.latch_rate"}, {"value", measured}, {"std", 0.01}}}));
  };
  CHECK(rate(-1.3).empty());
  CHECK(rate(-2).empty()); // far off, and in no other unit
  CHECK_THAT(rate(1.28), Catch::StartsWith("t.json: /tests/0/values/0/value: ") &&
                             Catch::Contains("opposite sense"));
  for (const double factor : {180 / M_PI, -180 / M_PI, 1e3})
    CHECK_THAT(rate(-1.28 * factor),
               Catch::Contains("/tests/0/values/0/value: ") && Catch::Contains("with its unit") &&
                   Catch::Contains(fmt::format(", {:.4g} times too large", factor)));
  Json slow = panel_campaign();
  slow["integration"]["t_end"] = 0.5;
  const Campaign never_latches = campaign_of(slow);
  const FitSpec spec = read_fit(parse_json(R"({ "tests": [ { "name": "one", "values": [ { "output":
        "root.latch_time", "value": 0.4, "std": 0.1 } ] } ], "fit": { "parameters": ["spring"] } })"),
                                "t.json", folder.path(), never_latches);
  CHECK_THAT(message_of([&] {
               refuse_unpredictable(never_latches, spec, {.pool = {.threads = 1}}, "t.json", never);
               return 0;
             }),
             Catch::StartsWith("t.json: /tests/0/values/0: found root.latch_time, which none of 16 "
                               "runs of the prior has"));
}

TEST_CASE("chains that are not finished are no result") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  const Campaign campaign = campaign_of(panel_campaign());
  const FitSpec spec = spec_of(one_way, folder.path(), campaign);
  FitOptions few;
  few.most_runs = 4000;
  Json long_one = parse_json(one_way);
  long_one["fit"]["samples"] = 50000;
  const FitSpec wants = read_fit(long_one, "", folder.path(), campaign);
  const FitResult result = fitted(campaign, wants, few);
  CHECK_FALSE(result.finished);
  CHECK(fit_findings(result, wants).front().starts_with("not finished"));
  CHECK(fit_json(result, wants, Json::object())["finished"] == false);
}

TEST_CASE("threads and lanes do not change a bit") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  const Campaign campaign = campaign_of(panel_campaign());
  Json tests = parse_json(one_way);
  tests["fit"]["samples"] = 200;
  tests["tests"][0]["values"] =
      parse_json(R"([ { "output": "root.latch_time", "value": 2.3, "std": 0.1 } ])");
  const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
  FitOptions one, other;
  one.pool = {1, InstructionSet::scalar};
  other.pool.threads = 3;
  const FitResult a = fitted(campaign, spec, one), b = fitted(campaign, spec, other);
  CHECK(posterior_csv(a) == posterior_csv(b));
  CHECK(traces_csv(a, spec) == traces_csv(b, spec));
  CHECK(fit_json(a, spec, {}) == fit_json(b, spec, {}));
}

TEST_CASE("what is not fitted is held at its median, and told with the mean and sd of its law") {
  const double lower = 0.5, mode = 0.6, upper = 2.5; // skew: the median is far from the mean
  const Folder folder;
  Json json = panel_campaign();
  json["dispersions"][1]["distribution"] = {
      {"type", "triangular"}, {"lower", lower}, {"mode", mode}, {"upper", upper}};
  const Campaign campaign = campaign_of(json);
  const double median = upper - std::sqrt((upper - lower) * (upper - mode) / 2);
  Json tests = parse_json(R"({ "tests": [ { "name": "watch",
      "values": [ { "output": "root.latch_time", "value": 0, "std": 0.01 } ] } ],
    "fit": { "parameters": ["spring"], "samples": 200, "starts": 1 } })");
  tests["tests"][0]["values"][0]["value"] = panel_latch_time(1.02, median);
  const FitResult result = fitted(campaign, read_fit(tests, "tests.json", folder.path(), campaign));
  REQUIRE(result.held.size() == 1);
  CHECK(result.held[0].name == "friction");
  CHECK(result.held[0].median == Approx(median).epsilon(1e-9));
  CHECK(result.held[0].prior_mean == Approx((lower + mode + upper) / 3).epsilon(1e-9));
  // what is told is what the runs have: with friction at its median the watch gives this spring
  CHECK(result.parameters[0].mode == Approx(1.02).epsilon(2e-3));
}
