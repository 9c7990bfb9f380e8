#include "montecarlo/report/data/output_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

#include <numeric>

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
      CHECK(quantile.contains("note") == quantile["value"].is_null());
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

TEST_CASE("a histogram has no more bins than the page has room for", "[page]") {
  Json json = quick_campaign(100);
  json["statistics"] = {{"bins", 150}};
  PageDetail detail;
  const auto source = made(json);
  CHECK(outputs_json(*source, detail, 1)[0]["histogram"]["counts"].size() == 80);
  detail.bins = 200;
  CHECK(outputs_json(*source, detail, 1)[0]["histogram"]["counts"].size() == 150);
}
