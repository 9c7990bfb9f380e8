#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <random>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;
namespace {

/// Runs of which every third stalls; `never` never happens, `fixed` never varies.
Summary some_summary(int runs, int threads = 0) {
  std::mt19937_64 random(12);
  Results results(ResultNames{{"k", "fixed"}, {"root.latch_time", "never"}});
  for (long run = 0; run < runs; ++run) {
    const bool stalls = run % 3 == 2;
    results.append({run,
                    stalls ? Status::stalled : Status::deployed,
                    {uniform(random), 1},
                    {stalls ? none : 10 + uniform(random), none},
                    stalls ? "" : "root>tip",
                    stalls ? "friction" : ""});
  }
  return summarize(results, {}, {}, threads);
}

void check_no_number_is_lost(const Json& json) {
  if (json.is_number_float()) CHECK(std::isfinite(json.get<double>()));
  if (json.is_structured())
    for (const Json& each : json) check_no_number_is_lost(each);
}

/// Strict: it parses again, to the same, without NaN or Infinity.
void check_strict(const Json& json) {
  check_no_number_is_lost(json);
  const std::string text = json_text(json);
  CHECK(Json::parse(text) == json);
  CHECK(text.back() == '\n');
  CHECK(text.find("nan") == std::string::npos);
}

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> names;
  for (const auto& item : json.items()) names.push_back(item.key());
  return names;
}

} // namespace

TEST_CASE("summary.json: its keys, in order") {
  const Json json = summary_json(some_summary(300), {{"version", "1"}});
  CHECK(keys(json) == std::vector<std::string>{"wingspread", "runs", "confidence", "status",
                                               "reasons", "reasons_omitted", "latch_order",
                                               "latch_order_omitted", "latch_order_missing",
                                               "outputs", "correlations", "requirements",
                                               "definitions"});
  CHECK(keys(json["status"]) ==
        std::vector<std::string>{"deployed", "stalled", "timed_out", "invalid", "failed"});
  CHECK(keys(json["outputs"]["root.latch_time"]) ==
        std::vector<std::string>{"unit", "count", "missing", "mean", "mean_error", "std", "min",
                                 "max", "skewness", "kurtosis", "quantiles", "missing_ranks"});
  CHECK(keys(json["correlations"]) == std::vector<std::string>{"k", "fixed"});
  CHECK(keys(json["correlations"]["k"]) ==
        std::vector<std::string>{"root.latch_time", "never", "deployed"});
}

TEST_CASE("summary.json: a quantile from counts says how far its rank and value may be off") {
  Summary summary = some_summary(300);
  OutputSummary& output = summary.outputs[0];
  REQUIRE(output.quantiles.size() > 1);
  output.quantiles[0].all = {2.5, {2.25, 2.75}, QuantileError{7, 2.375, 2.625}};
  output.quantiles[0].among = {3.5, {3.25, 3.75}, QuantileError{9, 3.375, 3.625}};
  output.quantiles[1].all.error.reset();
  const Json quantiles = summary_json(summary, {})["outputs"][output.name]["quantiles"];
  const auto has = [](const Json& json, double value, long rank, double below, double above) {
    CHECK(json["value"] == value);
    CHECK(json["lower"] == value - 0.25);
    CHECK(json["upper"] == value + 0.25);
    CHECK(json["rank_error"] == rank);
    CHECK(json["within"] == Json{below, above});
  };
  has(quantiles[0], 2.5, 7, 2.375, 2.625);
  has(quantiles[0]["among_runs_with_value"], 3.5, 9, 3.375, 3.625);
  CHECK_FALSE(quantiles[1].contains("rank_error"));
  CHECK_FALSE(quantiles[1].contains("within"));
}

TEST_CASE("summary.json: values, and null for what is not") {
  const Summary summary = some_summary(300);
  const Json json = summary_json(summary, {{"version", "1"}});
  CHECK(json["wingspread"]["version"] == "1");
  CHECK(json["runs"] == 300);
  CHECK(json["status"]["stalled"]["count"] == 100);
  CHECK(json["status"]["stalled"]["rate"] == 100.0 / 300);
  CHECK(json["status"]["stalled"]["lower"] == clopper_pearson(100, 300, 0.95).lower);
  CHECK(json["reasons"] ==
        Json::parse(R"([{"status": "stalled", "reason": "friction", "count": 100}])"));
  CHECK(json["latch_order"] == Json::parse(R"({"root>tip": 200})"));
  CHECK(json["latch_order_missing"] == 100);
  const Json& output = json["outputs"]["root.latch_time"];
  CHECK((output["unit"] == "s" && output["count"] == 200 && output["missing"] == 100));
  CHECK(output["mean"] == summary.outputs[0].moments.mean);
  CHECK(output["quantiles"][1]["p"] == 0.5);
  CHECK(output["quantiles"][1]["upper"] == *summary.outputs[0].quantiles[1].all.bounds.upper);
  CHECK(json["outputs"]["never"]["mean"].is_null());
  CHECK(json["correlations"]["fixed"]["deployed"]["pearson"].is_null());
  CHECK(json["correlations"]["k"]["root.latch_time"]["count"] == 200);
}

TEST_CASE("summary.json says why the nominal run does not deploy") {
  Summary summary = some_summary(3);
  for (OutputSummary& output : summary.outputs) output.nominal = none;
  summary.nominal = NominalRun{Status::deployed, "root>tip", ""};
  CHECK(summary_json(summary, {})["nominal"] ==
        Json{{"status", "deployed"}, {"latch_order", "root>tip"}});
  summary.nominal = NominalRun{Status::stalled, "root", "friction"};
  CHECK(summary_json(summary, {})["nominal"] ==
        Json{{"status", "stalled"}, {"latch_order", "root"}, {"reason", "friction"}});
  summary.nominal = NominalRun{Status::deployed, "root", "", PeaksFinal::forces};
  CHECK(summary_json(summary, {})["nominal"]["peaks_final"] == "peak_force");
  CHECK(summary_json(summary, {})["definitions"]["nominal"] ==
        "of the run with every dispersion at the median of its law, tables included");
}

TEST_CASE("summary.json says why a bound is null") {
  const Json json = summary_json(some_summary(30), {});
  const Json& low = json["outputs"]["root.latch_time"]["quantiles"][0];
  CHECK(low["lower"].is_null());
  CHECK(low["note"] ==
        "30 runs, 10 of them without a value, are too few for every bound at a confidence of 0.95");
  CHECK(json["outputs"]["root.latch_time"]["quantiles"][1]["upper"].is_null()); // X_(21) of 30
  Summary extended = some_summary(30);
  extended.interim.before = {10}; // its bounds are at 1 − 0.05/2
  CHECK_THAT(summary_json(extended, {})["outputs"]["root.latch_time"]["quantiles"][0]["note"]
                 .get<std::string>(),
             Catch::EndsWith("at a confidence of 0.975"));
  Results results(ResultNames{{}, {"t"}});
  for (long run = 0; run < 2; ++run) results.append({run, Status::deployed, {}, {1.5}, "", ""});
  const Json single = summary_json(summarize(results, {}, {1, {0, 0}}), {});
  CHECK(single["outputs"]["t"]["quantiles"][0]["note"] ==
        "no bounds: the draws of one replicate depend on each other; take two replicates or more");
  for (const char* bounds : {"rate_bounds", "quantile_bounds", "mean_error"})
    CHECK(single["definitions"][bounds] == single["outputs"]["t"]["quantiles"][0]["note"]);
  CHECK(single["status"]["deployed"]["note"] == single["definitions"]["rate_bounds"]);
  CHECK(single["outputs"]["t"]["mean_error"].is_null());
}

TEST_CASE(
    "summary.json: a quantile that does not exist is null, with the reason and its stand-in") {
  const Summary summary = some_summary(300);
  const Json json = summary_json(summary, {});
  const Json& latch_time = json["outputs"]["root.latch_time"]["quantiles"];
  const Json &median = latch_time[1], &high = latch_time[2];
  CHECK((median["value"].is_number() && !median.contains("note")));
  CHECK(high["value"].is_null());
  CHECK(high["note"] == "200 of 300 runs have a value; the others rank above every value");
  for (const Json& each : {median, high}) CHECK(each["among_runs_with_value"]["value"].is_number());
  CHECK(median["among_runs_with_value"]["value"] < median["value"]);
  CHECK(high["among_runs_with_value"]["value"] == summary.outputs[0].quantiles[2].among->value);
  CHECK(json["definitions"].contains("quantile_missing"));
  CHECK(json["outputs"]["root.latch_time"]["missing_ranks"] == "above every value");
  const Json& never = json["outputs"]["never"]["quantiles"][0];
  CHECK((never["value"].is_null() && never["note"] == "no run has a value"));
  CHECK_FALSE(never.contains("among_runs_with_value"));
}

TEST_CASE("summary.json has bounds from replicates, and says where they agree too well") {
  Results results(ResultNames{{}, {"t"}});
  for (long run = 0; run < 40; ++run)
    results.append({run,
                    run % 7 == 0 ? Status::stalled : Status::deployed,
                    {},
                    {static_cast<double>(run * run % 11)},
                    "",
                    ""});
  Replication halves{2, {}};
  for (int run = 0; run < 40; ++run) halves.of_row.push_back(run < 20 ? 0 : 1);
  const Json json = summary_json(summarize(results, {{0.5, 0.999}, 0.5, AutoBins{}}, halves), {});
  CHECK(json["status"]["failed"]["note"] ==
        "no bounds: all replicates agree, which says nothing about the error");
  CHECK(json["status"]["failed"]["upper"].is_null());
  CHECK(json["outputs"]["t"]["mean_error"].is_number());
  CHECK(json["definitions"]["mean_error"] == "spread of the means of 2 independent replicates");
  CHECK(json["definitions"]["quantile_bounds"] ==
        "Woodruff: inverse of the pooled distribution, Student's t over 2 independent replicates");
  CHECK(json["outputs"]["t"]["quantiles"].size() == 2);
  CHECK(json["outputs"]["t"]["quantiles"][1]["note"] ==
        "40 values in 2 replicates are too few, or agree too well, for every bound at a confidence "
        "of 0.5");
  CHECK(json["definitions"]["requirements"] == "none: the draws depend on each other");
}

TEST_CASE("the files are strict JSON, whatever did not happen") {
  for (const int runs : {0, 1, 2, 3, 50}) {
    const Summary summary = some_summary(runs);
    check_strict(summary_json(summary, Json::object()));
    check_strict(histograms_json(summary));
  }
}

TEST_CASE("the same results give the same bytes") {
  CHECK(json_text(summary_json(some_summary(100), {})) ==
        json_text(summary_json(some_summary(100), {})));
}

TEST_CASE("many reasons and latch orders are cut, and the rest counted") {
  Results results(ResultNames{{}, {}});
  for (long run = 0; run < 1500; ++run)
    results.append({run,
                    Status::invalid,
                    {},
                    {},
                    "order " + std::to_string(run % 1200),
                    "reason_" + std::to_string(run % 120)});
  const Json json = summary_json(summarize(results, {}), {});
  CHECK(json["reasons"].size() == most_reasons);
  CHECK(json["latch_order"].size() == most_latch_orders);
  long reasons = json["reasons_omitted"], orders = json["latch_order_omitted"];
  for (const Json& reason : json["reasons"]) reasons += reason["count"].get<long>();
  for (const Json& order : json["latch_order"]) orders += order.get<long>();
  CHECK((reasons == 1500 && orders == 1500));
}

TEST_CASE("a summary has the same bytes for any number of threads", "[parallel]") {
  for (const int runs :
       {500, 50'000, 100'000}) { // from 50'000 on columns lie in files, the last are a team's
    const auto text = [&](int threads) {
      const Summary summary = some_summary(runs, threads);
      return json_text(summary_json(summary, {})) + histograms_csv(summary);
    };
    const std::string alone = text(1);
    CHECK(text(2) == alone);
    CHECK(text(5) == alone);
  }
}

TEST_CASE("histograms.json and histograms.csv hold the same histograms") {
  const Summary summary = some_summary(300);
  const Json json = histograms_json(summary)["root.latch_time"];
  CHECK((json["unit"] == "s" && json["count"] == 200 && json["missing"] == 100));
  std::istringstream csv(histograms_csv(summary));
  CsvReader reader(csv, "histograms.csv");
  REQUIRE(reader.next());
  CHECK(reader.cells() == std::vector<std::string>{"output", "lower", "upper", "count", "density"});
  for (std::size_t i = 0; i < json["counts"].size(); ++i) {
    REQUIRE(reader.next());
    const auto& cells = reader.cells();
    CHECK(cells[0] == "root.latch_time");
    CHECK(std::stod(cells[1]) == json["edges"][i]);
    CHECK(std::stod(cells[2]) == json["edges"][i + 1]);
    CHECK(std::stol(cells[3]) == json["counts"][i]);
    CHECK(std::stod(cells[4]) == json["density"][i]);
  }
  CHECK_FALSE(reader.next()); // `never` has no bins
}

TEST_CASE("summary.json: requirements with their evidence, and the runs to be seen again") {
  Summary summary = some_summary(300);
  Results results(ResultNames{{}, {"root.latch_time"}});
  for (long run = 0; run < 3000; ++run)
    results.append({run, run < 1200 ? Status::stalled : Status::deployed, {}, {12}, "", ""});
  const Requirement time{"T-1", "root.latch_time", 11.5, {}, .9, .95};
  summary.requirements = {judge(time, results), judge({"", "deployed", {}, {}, .5, .9}, results),
                          judge({"", "deployed", {}, {}, .9999, .9}, results)};
  const Json whole = summary_json(summary, {}), json = whole["requirements"];
  double risk = 0;
  for (const Verdict& verdict : summary.requirements) risk += 1 - verdict.requirement.confidence;
  CHECK(whole["joint_confidence"].get<double>() == Approx(1 - risk).epsilon(1e-14));
  CHECK(whole["definitions"].contains("joint_confidence"));
  Summary single = summary;
  single.requirements.resize(1);
  CHECK_FALSE(summary_json(single, {}).contains("joint_confidence"));
  REQUIRE(json.size() == 3);
  CHECK(json[0]["name"] == "T-1");
  CHECK(json[0]["verdict"] == "fail");
  CHECK(json[0]["failures"] ==
        Json::parse(R"({"seen": 3000, "allowed": 272, "without_value": 1200})"));
  CHECK((json[0]["margin"].is_null() && json[0]["guaranteed"]["value"].is_null()));
  CHECK((json[0]["broken"].size() == most_broken && json[0]["broken_omitted"] == 2000));
  CHECK(json[0]["replay"] == "wingspread replay DIR --run 0");
  CHECK(json[1]["verdict"] == "pass");
  CHECK(json[1]["observed"] == Json::parse(R"({"share": 0.6})"));
  CHECK(json[1]["margin"] > 0);
  CHECK(json[2]["verdict"] == "fail"); // too few to show it, and enough to disprove it
  CHECK(json[2]["failures"]["allowed"].is_null());
  CHECK(json[2]["least_runs"] == 23025);
  CHECK_FALSE(json[0].contains("least_runs")); // there are enough
  check_strict(json);
}

TEST_CASE("summary.json: tolerance limits, or why there is none") {
  Summary summary = some_summary(300);
  summary.outputs[0].tolerance_limits = {{{.95, .95, Side::both}, {1.5, 2.5}},
                                         {{.95, .95, Side::upper}, {}, 12},
                                         {{.999, .95, Side::lower}, {}}};
  const Json json = summary_json(summary, {})["outputs"]["root.latch_time"]["tolerance"];
  CHECK(json[0].dump() ==
        R"({"probability":0.95,"confidence":0.95,"side":"both","lower":1.5,"upper":2.5})");
  CHECK(json[1]["note"] == "12 of 300 runs rank beyond every number; at most 8 may");
  CHECK(json[1]["beyond_every_number"] == 12);
  CHECK_THAT(summary_json(summary, {})["definitions"]["tolerance"].get<std::string>(),
             Catch::Contains("a peak that t_end cut is beyond_every_number"));
  CHECK_FALSE(json[1].contains("lower"));
  CHECK(json[2]["note"] == "300 runs are too few: it takes 2995");
  CHECK(json[2]["lower"].is_null());
}

TEST_CASE("summary.json: when a campaign stops, and what that does to its bounds") {
  Summary summary = some_summary(300);
  CHECK_FALSE(summary_json(summary, {}).contains("until"));
  summary.until = {{WidthGoal{"root.latch_time", .5, .01, true}, .05, false}};
  summary.interim.planned = 5;
  const Json json = summary_json(summary, {});
  CHECK(json["until"].dump() ==
        R"({"stopped":false,"checkpoints":5,"widths":[{"output":"root.latch_time",)"
        R"("quantile":0.5,"relative_width":0.01,"found":0.05,"met":false}]})");
  CHECK(json["definitions"]["rate_bounds"] ==
        "Clopper-Pearson, two-sided, at a confidence of 0.99 each, to hold at whichever of 5 "
        "analyses the campaign stops");
}

TEST_CASE("summary.json says what the integration contributes, where that was measured") {
  Summary summary = some_summary(300);
  CHECK(accuracy_json(summary).is_null());
  summary.accuracy =
      Accuracy{.runs = 24,
               .method = "auto",
               .rtol = 1e-8,
               .reference_method = "dopri5",
               .reference_rtol = 1e-11,
               .in_doubt = {},
               .moved = {},
               .unreached = 0,
               .outputs = {{"root.latch_time", 20, 2e-9, 1e-9}, {"never", 0, none, none}}};
  const Json json = summary_json(summary, {});
  check_strict(json);
  CHECK(keys(json["accuracy"]) ==
        std::vector<std::string>{"runs", "method", "rtol", "reference_method", "reference_rtol",
                                 "order_in_doubt", "beyond_largest", "moved", "outputs"});
  CHECK(json["accuracy"]["moved"]["runs"] == 0);
  CHECK(json["accuracy"] == accuracy_json(summary));
  CHECK(json["accuracy"]["order_in_doubt"] == 0);
  const Json& output = json["accuracy"]["outputs"][0];
  CHECK(output == Json{{"output", "root.latch_time"},
                       {"largest", 2e-9},
                       {"rms", 1e-9},
                       {"standard_error", summary.outputs[0].mean_error}});
  CHECK(json["accuracy"]["outputs"][1]["largest"].is_null());
  CHECK(json["definitions"].contains("accuracy"));
  summary.accuracy->in_doubt = {3, 8};
  summary.accuracy->unreached = 1;
  CHECK(accuracy_json(summary)["order_in_doubt"] == 2);
  CHECK(accuracy_json(summary)["in_doubt"] == Json{3, 8});
  CHECK(accuracy_json(summary)["unreached"] == 1);
  summary.accuracy->moved = {5};
  const Json moved = accuracy_json(summary)["moved"];
  CHECK(moved["runs"] == 1);
  CHECK(moved["which"] == Json{5});
  CHECK(moved["share_at_most"] == share_at_most(*summary.accuracy, 1, summary.confidence));
  summary.interim.before = {50, 100}; // bounds of the second extension share the risk
  CHECK(accuracy_json(summary)["moved"]["share_at_most"] ==
        share_at_most(*summary.accuracy, 1, summary.interim.confidence_of_bound(0.95)));
  CHECK(accuracy_json(summary)["moved"]["share_at_most"] > moved["share_at_most"]);
}
