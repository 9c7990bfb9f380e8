#include "montecarlo/report/data/causes_json.hpp"
#include "montecarlo/report/data/output_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/set_json.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

#include <numeric>
#include <random>
#include <tuple>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("an output's blocks agree with each other and with the summary", "[page]") {
  Json json = full_campaign(120); // some time out, some are invalid
  json["requirements"] = parse_json(
      R"([ { "output": "deployed", "probability": 0.2, "confidence": 0.5 },
           { "output": "mid.peak_moment", "max": 100, "probability": 0.2, "confidence": 0.5 } ])");
  const auto source = made(json);
  const Json outputs = outputs_json(*source, {}, 2);
  CHECK(outputs == outputs_json(*source, {}, 1));
  REQUIRE(outputs.size() == source->results.outputs.size());
  long missing = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Json& output = outputs[i];
    const OutputSummary& summary = source->summary.outputs[i];
    CAPTURE(output["name"]);
    CHECK(output["count"].get<long>() + output["missing"].get<long>() == 120);
    missing += output["missing"].get<long>();
    CHECK(output["mean"] == page_number(summary.moments.mean));
    CHECK(output["nominal"] == page_number(summary.nominal));
    const auto counts = output["histogram"]["counts"].get<std::vector<long>>();
    CHECK(std::accumulate(counts.begin(), counts.end(), 0L) == output["count"]);
    CHECK(output["histogram"]["edges"].size() == counts.size() + 1);
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      long sum = 0;
      for (const Json& order : output["histogram"]["by_order"]) sum += order[bin].get<long>();
      CHECK(sum == counts[bin]);
    }
    CHECK(output["curve"]["x"].size() == output["curve"]["upper"].size());
    for (const Json& quantile : output["quantiles"]) {
      CHECK(quantile.contains("among") == (output["missing"] > 0 && output["count"] > 0));
      const auto lacks = [&](const char* key) { return quantile[key].is_null(); };
      CHECK(quantile.contains("note") == (lacks("value") || (lacks("lower") && lacks("upper"))));
    }
    if (output["count"] > 0) {
      CHECK(output["curve"]["x"].back() == page_number(summary.moments.max));
      CHECK(output["convergence"]["mean"].back() == page_number(summary.moments.mean));
      CHECK(output["convergence"]["quantile"].back() ==
            page_number(summary.quantiles.back().all.value));
    }
    CHECK(output["limits"] == (output["name"] == "mid.peak_moment" ? Json{1} : Json::array()));
  }
  CHECK(missing > 0);
}

TEST_CASE("one replicate is the reason why quantiles have no bounds", "[page]") {
  for (const int replicates : {1, 4}) {
    Json json = quick_campaign(64);
    json["sampling"]["design"] = "latin_hypercube", json["sampling"]["replicates"] = replicates;
    const auto source = made(json);
    for (const Json& output : outputs_json(*source, {}, 1))
      for (const Json& quantile : output["quantiles"]) {
        REQUIRE_FALSE(quantile["value"].is_null());
        CHECK((quantile.value("note", "") == one_replicate) == (replicates == 1));
        CHECK((quantile["lower"].is_null() || replicates > 1));
      }
  }
}

TEST_CASE("an output that never happened has empty blocks", "[page]") {
  Json json = quick_campaign(3);
  json["integration"]["t_end"] = 0.5; // nothing latches
  const Json outputs = outputs_json(*made(json), {}, 1);
  CHECK(outputs[0]["count"] == 0);
  CHECK(outputs[0]["mean"].is_null());
  CHECK(outputs[0]["histogram"]["counts"].empty());
  CHECK(outputs[0]["curve"]["x"].empty());
  CHECK(outputs[0]["convergence"]["mean"] == Json{nullptr});
}

TEST_CASE("edges of values that differ in their last digits differ on the page", "[page]") {
  const auto source = made(quick_campaign(20));
  Column& column = source->results.outputs.front();
  for (std::size_t k = 0; k < column.values.size(); ++k)
    column.values[k] = 1e6 + 1e-8 * static_cast<double>(k);
  source->summary = stored_summary(source->stored, source->results, 1);
  const auto edges =
      outputs_json(*source, {}, 1)[0]["histogram"]["edges"].get<std::vector<double>>();
  REQUIRE(edges.size() > 2);
  CHECK(std::ranges::adjacent_find(edges, std::ranges::greater_equal{}) == edges.end());
}

TEST_CASE("values of a tiny spread have the digits that tell them apart", "[page]") {
  const auto source = made(quick_campaign(20));
  Column& column = source->results.outputs.front();
  for (std::size_t k = 0; k < column.values.size(); ++k)
    column.values[k] = 2.5 + 1e-10 * static_cast<double>(k);
  source->summary = stored_summary(source->stored, source->results, 1);
  const Json output = outputs_json(*source, {}, 1)[0];
  CHECK(output["max"].get<double>() - output["min"].get<double>() == Approx(1.9e-9).epsilon(0.01));
  CHECK(output["mean"].get<double>() - 2.5 == Approx(0.95e-9).epsilon(0.01));
  const auto x = output["curve"]["x"].get<std::vector<double>>();
  CHECK(x.size() == 20);
  CHECK(std::ranges::adjacent_find(x, std::ranges::greater_equal{}) == x.end());
  CHECK(output["curve"]["steps"] == true);
  CHECK(output["quantiles"][0]["value"] < output["quantiles"].back()["value"]);
  const auto means = output["convergence"]["mean"].get<std::vector<double>>(); // of rising values
  CHECK(std::ranges::adjacent_find(means, std::ranges::greater_equal{}) == means.end());
  CHECK(output["convergence"]["lower"].back() < output["convergence"]["mean"].back());
}

TEST_CASE("points, verdicts and latch times of a tiny spread have the digits that tell them apart",
          "[page]") {
  Json json = quick_campaign(40);
  json["dispersions"][0]["distribution"]["std"] = 1e-6;
  json["dispersions"][1]["distribution"] =
      parse_json(R"({ "type": "uniform", "lower": 10, "upper": 10.00001 })");
  json["integration"]["rtol"] = 1e-9;
  json["requirements"] = parse_json(
      R"([ { "output": "root.latch_time", "max": 1, "probability": 0.5, "confidence": 0.5 } ])");
  const auto source = made(json);
  const auto& values = source->results.outputs[0].values; // root.latch_time
  const std::vector<double> times = sorted_present(values);
  const double spread = times.back() - times.front();
  REQUIRE((spread > 0 && spread < 1e-5 * times.front()));
  const Json set = set_json(*source, {}, 1), &one = set["requirements"][0];
  CHECK(one["observed_value"].get<double>() ==
        Approx(source->summary.requirements[0].observed.value()).epsilon(0).margin(1e-3 * spread));
  CHECK(
      one["guaranteed_value"].get<double>() ==
      Approx(source->summary.requirements[0].guaranteed.value()).epsilon(0).margin(1e-3 * spread));
  CHECK(one["worst"]["value"].get<double>() ==
        Approx(times.back()).epsilon(0).margin(1e-2 * spread));
  CHECK(set["envelopes"]["latch_times"][0].back().get<double>() ==
        Approx(times.back()).epsilon(0).margin(1e-2 * spread));
  REQUIRE_FALSE(set["scatters"].empty());
  for (const Json& pair : set["scatters"])
    for (const char* axis : {"x", "y"}) {
      auto points = pair["points"][axis].get<std::vector<double>>();
      std::ranges::sort(points);
      points.erase(std::unique(points.begin(), points.end()), points.end());
      CHECK(points.size() > 30);
    }
}

TEST_CASE("of too many outputs those with a requirement are shown first, in the columns' order",
          "[page]") {
  Json json = quick_campaign(20);
  json["requirements"] = parse_json(
      R"([ { "output": "tip.latch_rate", "min": -9, "probability": 0.2, "confidence": 0.5 },
           { "output": "mid.latch_time", "max": 9, "probability": 0.2, "confidence": 0.5 } ])");
  const auto source = made(json);
  PageDetail detail;
  detail.outputs = 3;
  std::vector<std::string> names;
  for (const std::size_t i : shown_outputs(*source, detail))
    names.push_back(source->results.outputs[i].name);
  std::vector<std::string> expected{source->results.outputs.front().name, "mid.latch_time",
                                    "tip.latch_rate"};
  REQUIRE(expected[0] != expected[1]);
  CHECK(names == expected);
  const Json outputs = outputs_json(*source, detail, 2);
  REQUIRE(outputs.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) CHECK(outputs[k]["name"] == expected[k]);
  CHECK(outputs[2]["limits"] == Json{0});
  const Json correlations = correlations_json(*source, detail);
  CHECK(correlations["outputs"] == Json(expected));
  REQUIRE(correlations["spearman"][0].size() == 3);
  const std::size_t row = source->results.outputs.size() + 1;
  for (std::size_t d = 0; d < correlations["draws"].size(); ++d)
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(correlations["spearman"][d][k] ==
            page_number(source->summary.correlations[d * row + shown_outputs(*source, detail)[k]]
                            .value.spearman,
                        3));
  const Json effects = effects_json(*source, detail);
  for (const Json& effect : effects["effects"])
    CHECK(std::ranges::find(expected, effect["output"].get<std::string>()) != expected.end());
  CHECK(std::ranges::any_of(effects["effects"],
                            [](const Json& one) { return one["output"] == "tip.latch_rate"; }));
}

TEST_CASE("a histogram has no more bins than the page has room for", "[page]") {
  Json json = quick_campaign(100);
  json["statistics"] = {{"bins", 150}};
  PageDetail detail;
  const auto source = made(json);
  CHECK(outputs_json(*source, detail, 1)[0]["histogram"]["counts"].size() == 80);
  detail.bins = 200;
  CHECK(outputs_json(*source, detail, 1)[0]["histogram"]["counts"].size() == 150);
}

TEST_CASE(
    "an output's numbers stand under their names: moments, quantiles, tolerance limits, curves",
    "[page]") {
  Json json = full_campaign(120);
  json["statistics"] = parse_json(R"({ "quantiles": [0.05, 0.9], "confidence": 0.8,
    "tolerance": [ { "probability": 0.9, "confidence": 0.75, "side": "upper" },
                   { "probability": 0.8, "confidence": 0.95, "side": "both" },
                   { "probability": 0.7, "confidence": 0.6, "side": "lower" } ] })");
  const auto source = made(json);
  const Json outputs = outputs_json(*source, {}, 1);
  const auto same_bounds = [](const Json& shown, const Bounds& bounds) {
    CHECK(shown["lower"] == page_number(bounds.lower));
    CHECK(shown["upper"] == page_number(bounds.upper));
  };
  int limited = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Json& shown = outputs[i];
    const OutputSummary& summary = source->summary.outputs[i];
    const Moments& moments = summary.moments;
    CAPTURE(summary.name);
    CHECK(shown["name"] == summary.name);
    for (const auto& [key, value] : {std::pair("mean_error", summary.mean_error),
                                     {"std", moments.std},
                                     {"min", moments.min},
                                     {"max", moments.max},
                                     {"skewness", moments.skewness},
                                     {"kurtosis", moments.kurtosis}})
      CHECK(shown[key] == page_number(value));
    REQUIRE(shown["quantiles"].size() == 2);
    for (std::size_t q = 0; q < 2; ++q) {
      const Json& quantile = shown["quantiles"][q];
      CHECK(quantile["p"] == (q == 0 ? 0.05 : 0.9));
      CHECK(quantile["value"] == page_number(summary.quantiles[q].all.value));
      same_bounds(quantile, summary.quantiles[q].all.bounds);
      if (!summary.quantiles[q].among) continue;
      CHECK(quantile["among"]["value"] == page_number(summary.quantiles[q].among->value));
      same_bounds(quantile["among"], summary.quantiles[q].among->bounds);
    }
    const Json& limits = shown["tolerance_limits"];
    REQUIRE(limits.size() == 3);
    CHECK(limits[0]["text"] == "90 % at 75 %, upper");
    CHECK(limits[1]["text"] == "80 % at 95 %, both");
    CHECK(limits[2]["text"] == "70 % at 60 %, lower");
    for (std::size_t k = 0; k < 3; ++k) {
      const Bounds& bounds = summary.tolerance_limits[k].limits;
      same_bounds(limits[k], bounds);
      limited += bounds.lower || bounds.upper ? 1 : 0;
    }
    const Json& curve = shown["curve"];
    for (std::size_t k = 0; k < curve["x"].size(); ++k) {
      if (!curve["lower"][k].is_null()) CHECK(curve["lower"][k] <= curve["p"][k]);
      if (!curve["upper"][k].is_null()) CHECK(curve["upper"][k] >= curve["p"][k]);
      if (k > 0) CHECK((curve["x"][k] >= curve["x"][k - 1] && curve["p"][k] >= curve["p"][k - 1]));
    }
    const Json& way = shown["convergence"];
    CHECK(way["quantile_p"] == 0.9);
    for (const auto& [value, lower, upper] :
         {std::tuple("mean", "lower", "upper"), {"quantile", "quantile_lower", "quantile_upper"}})
      for (std::size_t k = 0; k < way["runs"].size(); ++k) {
        if (way[value][k].is_null()) continue;
        if (!way[lower][k].is_null()) CHECK(way[lower][k] <= way[value][k]);
        if (!way[upper][k].is_null()) CHECK(way[upper][k] >= way[value][k]);
      }
  }
  CHECK(limited > 10);
}

TEST_CASE("without rows a histogram keeps its ends and its runs, however many bins the page has",
          "[page]") {
  std::mt19937_64 random(5);
  Json json = quick_campaign(400);
  for (int k = 0; k < 5; ++k) {
    json["statistics"] = {{"bins", 20 + k}};
    const auto source = made(json);
    const Campaign& campaign = source->stored.campaign;
    source->streaming =
        std::make_unique<StreamingStatistics>(campaign, RunPlan(campaign).names(), source->results);
    for (std::size_t row = 0; row < source->results.size(); ++row)
      (void)source->streaming->add(source->results.row(row), {});
    PageDetail detail;
    detail.bins = 1 + static_cast<std::size_t>(random() % 19);
    const Json outputs = outputs_json(*source, detail, 1);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const Histogram& own = source->summary.outputs[i].histogram;
      const auto edges = outputs[i]["histogram"]["edges"].get<std::vector<double>>();
      const auto counts = outputs[i]["histogram"]["counts"].get<std::vector<long>>();
      REQUIRE(edges.size() == counts.size() + 1);
      CHECK(counts.size() <= detail.bins);
      CHECK(edges.front() == Approx(own.edges.front()).epsilon(1e-9));
      CHECK(edges.back() == Approx(own.edges.back()).epsilon(1e-9));
      for (std::size_t bin = 0; bin < counts.size(); ++bin) { // as many values as between its edges
        long within = 0;
        for (std::size_t fine = 0; fine < own.counts.size(); ++fine) {
          const double middle = (own.edges[fine] + own.edges[fine + 1]) / 2;
          within += edges[bin] < middle && middle < edges[bin + 1] ? own.counts[fine] : 0;
        }
        CHECK(counts[bin] == within);
      }
    }
  }
}
