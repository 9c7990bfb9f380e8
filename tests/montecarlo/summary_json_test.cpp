#include "montecarlo/summary_json.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <random>
#include <sstream>

using namespace wingspread;
using Json = nlohmann::ordered_json;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Runs of which every third stalls; `never` never happens, `fixed` never varies.
Summary some_summary(int runs) {
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
  return summarize(results, {});
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
                                               "outputs", "correlations", "definitions"});
  CHECK(keys(json["status"]) ==
        std::vector<std::string>{"deployed", "stalled", "timed_out", "invalid", "failed"});
  CHECK(keys(json["outputs"]["root.latch_time"]) ==
        std::vector<std::string>{"unit", "count", "missing", "mean", "std", "min", "max",
                                 "skewness", "kurtosis", "quantiles"});
  CHECK(keys(json["correlations"]) == std::vector<std::string>{"k", "fixed"});
  CHECK(keys(json["correlations"]["k"]) ==
        std::vector<std::string>{"root.latch_time", "never", "deployed"});
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
  CHECK(output["quantiles"][1]["upper"] == *summary.outputs[0].quantiles[1].bounds.upper);
  CHECK(json["outputs"]["never"]["mean"].is_null());
  CHECK(json["correlations"]["fixed"]["deployed"]["pearson"].is_null());
  CHECK(json["correlations"]["k"]["root.latch_time"]["count"] == 200);
}

TEST_CASE("summary.json says why a bound is null") {
  const Json json = summary_json(some_summary(30), {});
  const Json& low = json["outputs"]["root.latch_time"]["quantiles"][0];
  CHECK(low["lower"].is_null());
  CHECK(low["note"] == "20 values are too few for every bound at a confidence of 0.95");
  CHECK_FALSE(json["outputs"]["root.latch_time"]["quantiles"][1].contains("note"));
  Results results(ResultNames{{}, {"t"}});
  for (long run = 0; run < 2; ++run) results.append({run, Status::deployed, {}, {1.5}, "", ""});
  const Json single = summary_json(summarize(results, {}, {1, {0, 0}}), {});
  CHECK(single["outputs"]["t"]["quantiles"][0]["note"] ==
        "no bounds: the draws of one replicate depend on each other; take two replicates or more");
  CHECK(single["definitions"]["rate_bounds"] == "Student's t over 1 independent replicates");
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

TEST_CASE("bytes that are not UTF-8 do not stop the summary") {
  CHECK(json_text(Json("a\xFFz")) == "\"a\xEF\xBF\xBDz\"\n");
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
