// Every number that a fit writes or prints, against the result that it is given.
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <sstream>

using namespace wingspread;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<double> numbers_of(oracle::Draws& draws, std::size_t count) {
  std::vector<double> numbers(count);
  for (double& number : numbers) number = draws.sign() * draws.log_uniform(1e-3, 1e3);
  return numbers;
}

/// Two tests: two traces, of known and of unknown noise, and a value.
FitSpec spec_of(oracle::Draws& draws) {
  FitSpec spec;
  spec.samples = 70;
  spec.tests.resize(2);
  spec.tests[0].name = "air, 20 °C", spec.tests[1].name = "vacuum";
  spec.tests[0].times = {0, 0.25, 0.5, 1};
  spec.tests[0].columns.resize(2);
  for (FitColumn& column : spec.tests[0].columns) column.measured = numbers_of(draws, 4);
  spec.tests[0].campaign.scene.name = "wing";
  spec.tests[1].values = {{"root.latch_time", "s", std::nullopt, 4.25, 0.1}};
  return spec;
}

FittedChannel fitted_trace(oracle::Draws& draws, std::size_t column, std::optional<double> std) {
  FittedChannel fitted;
  fitted.channel = {.test = 0, .column = column, .count = 4, .std = std, .offset_std = 0.5};
  fitted.channel.effective = draws.uniform(2.5, 4);
  fitted.name = column == 0 ? "root.angle" : "tip.rate";
  fitted.rms = std ? draws.uniform(0.5, 2) * *std : draws.uniform(1, 2);
  fitted.chi_squared = std ? draws.uniform(1, 9) : not_a_number;
  fitted.p_value = std ? draws.uniform(0.1, 0.9) : not_a_number;
  fitted.offset = draws.uniform(1, 2);
  fitted.mode = numbers_of(draws, 4);
  fitted.lower = numbers_of(draws, 4), fitted.upper = numbers_of(draws, 4);
  return fitted;
}

/// Three parameters, the last one of a test alone. Nothing of it is a finding.
FitResult result_of(oracle::Draws& draws) {
  FitResult result;
  result.finished = true, result.common = 2, result.runs = 12345;
  for (const char* name : {"spring", "\"friction\", all", "time offset of vacuum"}) {
    const auto n = numbers_of(draws, 7);
    result.parameters.push_back({.name = name,
                                 .unit = "",
                                 .prior_mean = n[0],
                                 .prior_std = n[1],
                                 .mode = n[2],
                                 .mean = n[3],
                                 .std = draws.uniform(0.1, 0.8) * n[1],
                                 .lower = n[5],
                                 .upper = n[6],
                                 .score_std = 0.5,
                                 .prior_lower = n[0] - 3 * n[1],
                                 .prior_upper = n[0] + 2 * n[1]});
  }
  result.parameters[2].unit = "s";
  result.correlation = Eigen::MatrixXd::Identity(3, 3);
  for (const auto& [i, j] : {std::pair(0, 1), {0, 2}, {1, 2}})
    result.correlation(i, j) = result.correlation(j, i) = draws.uniform(-1, 1);
  result.score_covariance = result.prior_covariance = Eigen::MatrixXd::Identity(2, 2);
  result.directions = {{Eigen::Vector2d(0.99, -0.14), 0.95}, {Eigen::Vector2d(0.14, 0.99), 0.2}};
  result.channels = {fitted_trace(draws, 0, 0.3), fitted_trace(draws, 1, std::nullopt)};
  FittedChannel& value = result.channels.emplace_back();
  value.channel = {.test = 1, .count = 1, .std = 0.1, .effective = 1};
  value.name = "root.latch_time";
  value.measured = 4.25, value.fitted = 4.125, value.sigmas = 1.25, value.p_value = 0.375;
  result.sampler = {.evaluations = 4321, .acceptance = 0.625, .ess = 71.5, .r_hat = 1.03125};
  for (std::size_t k = 0; k < 2; ++k) result.posterior.names.push_back(result.parameters[k].name);
  for (int row = 0; row < 5; ++row) result.posterior.rows.push_back(numbers_of(draws, 2));
  result.candidates = {{"less", 0.5, {0.9, 0.7, 0.8}}, {"more", 2.25, {0.4, 0.6, 1}}};
  result.prediction = {{0.75, 0.875},
                       {{"tip.latch_time", {1.5, 2.5, 3.5}, {1.75, 2.25, not_a_number}}}};
  return result;
}

using Records = std::vector<std::vector<std::string>>;
Records records_of(const std::string& text) {
  std::istringstream in(text);
  CsvReader reader(in, "some.csv");
  Records records;
  while (reader.next()) {
    records.push_back(reader.cells());
    CHECK(reader.terminated());
  }
  return records;
}

/// The numbers of a line after its first column; signs and powers as the text has them.
std::vector<double> printed_after(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("\n  " + name + ' ');
  REQUIRE(at != std::string::npos);
  const std::size_t from = at + 3 + name.size();
  std::istringstream words(text.substr(from, text.find('\n', from) - from));
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (*end == '\0') numbers.push_back(number);
  }
  return numbers;
}

void check_printed(const std::vector<double>& got, const std::vector<double>& wanted,
                   double share = 5.01e-3) { // half a unit of the third digit of a number 1…
  REQUIRE(got.size() == wanted.size());
  for (std::size_t k = 0; k < got.size(); ++k)
    CHECK(std::abs(got[k] - wanted[k]) <= share * std::abs(wanted[k]));
}

} // namespace

TEST_CASE("a fit's tables have every number of the result, in its row and column") {
  oracle::Draws draws(11);
  const FitSpec spec = spec_of(draws);
  const FitResult result = result_of(draws);
  const Records rows = records_of(posterior_csv(result));
  REQUIRE(rows.size() == 1 + result.posterior.rows.size());
  CHECK(rows[0] == std::vector<std::string>{"spring", "\"friction\", all"});
  for (std::size_t k = 0; k < result.posterior.rows.size(); ++k) {
    REQUIRE(rows[k + 1].size() == 2);
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(std::stod(rows[k + 1][i]) == result.posterior.rows[k][i]);
  }
  const Records traces = records_of(traces_csv(result, spec));
  REQUIRE(traces.size() == 1 + 2 * 4);
  CHECK(traces[0] ==
        std::vector<std::string>{"test", "column", "t", "measured", "fitted", "lower", "upper"});
  for (std::size_t k = 0; k < 8; ++k) {
    const FittedChannel& fitted = result.channels[k / 4];
    const std::vector<std::string>& row = traces[k + 1];
    const std::size_t i = k % 4;
    REQUIRE(row.size() == 7);
    CHECK(row[0] == spec.tests[0].name);
    CHECK(row[1] == fitted.name);
    CHECK(std::stod(row[2]) == spec.tests[0].times[i]);
    CHECK(std::stod(row[3]) == spec.tests[0].columns[k / 4].measured[i]);
    CHECK(std::stod(row[4]) == fitted.mode[i] + fitted.offset);
    CHECK(std::stod(row[5]) == fitted.lower[i] + fitted.offset);
    CHECK(std::stod(row[6]) == fitted.upper[i] + fitted.offset);
  }
}

TEST_CASE("fit.json has every number of the result under its key") {
  oracle::Draws draws(12);
  const FitSpec spec = spec_of(draws);
  FitResult result = result_of(draws);
  result.other_modes = {{1.5, 0.5, {1, 2, 3}}, {2.5, 4.5, {4, 5, 6}}};
  const Json json = fit_json(result, spec, {{"about", 1}});
  CHECK(json["about"] == 1);
  CHECK((json["scene"] == "wing" && json["confidence"] == fit_confidence));
  CHECK(json["finished"] == true);
  CHECK(json["findings"] == Json::array());
  CHECK(json["parameters"].size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const FittedParameter& one = result.parameters[i];
    Json wanted{{"prior",
                 {{"mean", one.prior_mean},
                  {"std", one.prior_std},
                  {"lower", one.prior_lower},
                  {"upper", one.prior_upper}}},
                {"mode", one.mode},
                {"mean", one.mean},
                {"std", one.std},
                {"lower", one.lower},
                {"upper", one.upper},
                {"std_ratio", one.std / one.prior_std}};
    if (i == 2) wanted["unit"] = "s";
    CHECK(json["parameters"][one.name] == wanted);
    for (std::size_t j = 0; j < 3; ++j)
      CHECK(json["correlation"][one.name][result.parameters[j].name] ==
            result.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }
  CHECK(json["sampler"] ==
        Json{{"ess", 71.5}, {"r_hat", 1.03125}, {"acceptance", 0.625}, {"runs", 4321}});
  // of two directions one is unseen, and of its weights one is large
  CHECK(json["prior_decides"] == Json::array());
  REQUIRE(json["unseen"].size() == 1);
  CHECK(json["unseen"][0]["direction"] == Json{{"spring", 0.99}});
  CHECK(json["unseen"][0]["std_ratio"] == 0.95);
  for (const std::size_t k : {0, 1}) {
    const OtherMode& mode = result.other_modes[k];
    CHECK(json["other_modes"][k]["distance"] == mode.distance);
    CHECK(json["other_modes"][k]["log_posterior_below_best"] == mode.drop);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(json["other_modes"][k]["parameters"][result.parameters[i].name] == mode.parameters[i]);
  }
  REQUIRE(json["tests"].size() == 2);
  const FittedChannel &known = result.channels[0], &unknown = result.channels[1];
  CHECK(json["tests"][0]["name"] == "air, 20 °C");
  CHECK(json["tests"][0]["values"] == Json::object());
  CHECK(json["tests"][0]["traces"]["root.angle"] == Json{{"rms", known.rms},
                                                         {"chi_squared", known.chi_squared},
                                                         {"n", 4},
                                                         {"n_effective", known.channel.effective},
                                                         {"p_value", known.p_value},
                                                         {"offset", known.offset}});
  CHECK(json["tests"][0]["traces"]["tip.rate"] == Json{{"rms", unknown.rms},
                                                       {"chi_squared", nullptr},
                                                       {"n", 4},
                                                       {"n_effective", unknown.channel.effective},
                                                       {"p_value", nullptr},
                                                       {"estimated_std", unknown.rms}});
  CHECK(json["tests"][1]["values"]["root.latch_time"] == Json{{"unit", "s"},
                                                              {"measured", 4.25},
                                                              {"fitted", 4.125},
                                                              {"sigmas", 1.25},
                                                              {"p_value", 0.375}});
  REQUIRE(json["candidates"].size() == 2);
  CHECK(json["candidates"][1]["name"] == "more");
  CHECK(json["candidates"][1]["information"] == 2.25);
  CHECK(json["candidates"][1]["std_ratio"]["time offset of vacuum"] == 1);
  CHECK(json["prediction"]["tip.latch_time"]["before"] == Json{1.5, 2.5, 3.5});
  CHECK(json["prediction"]["tip.latch_time"]["after"] == Json{1.75, 2.25, nullptr});
  CHECK(json["predicted_deployed"] == Json{{"before", 0.75}, {"after", 0.875}});
  result.parameters[1].score_std = 0.95;
  CHECK(fit_json(result, spec, {})["prior_decides"] == Json{result.parameters[1].name});
}

TEST_CASE("the text of a fit prints the numbers of the result") {
  oracle::Draws draws(13);
  const FitSpec spec = spec_of(draws);
  const FitResult result = result_of(draws);
  const std::string text = fit_text(result, spec);
  CHECK(text.starts_with("PARAMETER"));
  for (const FittedParameter& one : result.parameters)
    check_printed(printed_after(text, one.name),
                  {one.prior_mean, one.prior_std, one.mean, one.std, one.lower, one.upper,
                   100 * one.std / one.prior_std},
                  0.05); // of 10 % and more, without decimals
  CHECK(text.find("the tests do not see spring") != std::string::npos);
  CHECK(text.find("the prior decides") == std::string::npos);
  // the most informative candidate first, with the parameter that it tells most of
  CHECK(text.find("\n  more") < text.find("\n  less"));
  check_printed(printed_after(text, "more"), {2.25, 40});
  check_printed(printed_after(text, "less"), {0.5, 70});
  CHECK(text.find("nats   spring to 40 %") != std::string::npos);
  CHECK(text.find("nats   \"friction\", all to 70 %") != std::string::npos);
  const auto predicted = printed_after(text, "tip.latch_time");
  REQUIRE(predicted.size() == 5);
  check_printed(predicted, {1.5, 2.5, 3.5, 1.75, 2.25});
  CHECK(text.find("2.25  none\n") != std::string::npos); // too many runs lack the output
  CHECK(text.find("75.0 %") < text.find("87.5 %"));      // deployed, before and after
  CHECK(text.ends_with("\n12345 runs; effective sample size 72, split R-hat 1.0312, 62 % of the "
                       "moves accepted\n"));
}

TEST_CASE("each finding of a fit is told on its side of its limit, and not on the other") {
  oracle::Draws draws(14);
  const FitSpec spec = spec_of(draws);
  const FitResult sound = result_of(draws);
  REQUIRE(fit_findings(sound, spec).empty());
  const auto told = [&](const auto& change) {
    FitResult result = sound;
    change(result);
    const auto findings = fit_findings(result, spec);
    CAPTURE(findings);
    CHECK(findings.size() <= 1);
    return findings.empty() ? "" : findings[0];
  };
  using Catch::Contains;
  const auto rms = [&](double sigmas) {
    return told([&](FitResult& result) { result.channels[0].rms = sigmas * 0.3; });
  };
  CHECK_THAT(rms(10.1), Contains("root.angle of \"air, 20 °C\": the residuals are 10 σ"));
  CHECK(rms(9.9).empty());
  CHECK_THAT(rms(0.19), Contains("the residuals are 0.19 σ"));
  CHECK(rms(0.21).empty());
  const auto p_value = [&](std::size_t channel, double p) {
    return told([&](FitResult& result) { result.channels[channel].p_value = p; });
  };
  CHECK_THAT(p_value(0, 0.009), Contains("does not fit root.angle") && Contains("for 4 numbers"));
  CHECK_THAT(p_value(2, 0.009), Contains("1.2 σ from the fitted 4.125"));
  CHECK(p_value(0, 0.011).empty());
  CHECK(p_value(2, 0.011).empty());
  const auto conflict = [&](double sigmas) {
    return told([&](FitResult& result) { result.parameters[1].prior_sigmas = sigmas; });
  };
  CHECK_THAT(conflict(4.1), Contains("\"friction\", all lies 4.1 standard deviations"));
  CHECK(conflict(3.9).empty());
  CHECK_THAT(told([](FitResult& result) { result.finished = false; }),
             Contains("effective sample size 72 of 70, split R-hat 1.031 after 4321 runs"));
  const auto mode = [&](double distance) {
    return told([&](FitResult& result) { result.other_modes = {{distance, 1.5, {7.5, 2, 3}}}; });
  };
  CHECK_THAT(mode(3.1), Contains("3.1 sd away, 1.5 nats below") && Contains("spring 7.5 (best "));
  CHECK(mode(2.9).empty());
  const auto cut = [&](long runs) {
    return told([&](FitResult& result) { result.prediction.outputs[0].cut = runs; });
  };
  CHECK_THAT(cut(7), Contains("the predicted peaks of tip.latch_time in up to 7 of 2000 runs"));
  CHECK(cut(0).empty());
  const auto effective = [&](double numbers) {
    return told([&](FitResult& result) { result.channels[1].channel.effective = numbers; });
  };
  CHECK_THAT(told([](FitResult& result) { result.beside_cases = true; }),
             Contains("without any of its cases"));
  CHECK(
      told([](FitResult& result) { result.beside_cases = true, result.prediction = {}; }).empty());
  CHECK_THAT(effective(1.9),
             Contains("tip.rate of \"air, 20 °C\" depend") && Contains("4 numbers count as 2"));
  CHECK(effective(2.1).empty());
}
