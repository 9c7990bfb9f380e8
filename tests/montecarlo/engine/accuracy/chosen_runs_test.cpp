#include "montecarlo/engine/accuracy/chosen_runs.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr const char* usual = "root>mid>tip";

/// A campaign whose rows are written by hand: run k latches root at 4 + k/100, mid at 5 + k/50, tip at 7 + 3k/100.
struct HandMade {
  Campaign campaign;
  ResultNames names = RunPlan(campaign).names();
  std::vector<ResultRow> rows;

  HandMade(const Json& json, long runs) : campaign(campaign_of(json)) {
    for (long k = 0; k < runs; ++k) {
      const auto t = static_cast<double>(k);
      rows.push_back({k,
                      Status::deployed,
                      std::vector<double>(names.draws.size(), 1),
                      std::vector<double>(names.outputs.size(), 0),
                      usual,
                      "",
                      {}});
      for (const char* hinge : {"root", "mid", "tip"})
        at(k, std::string(hinge) + ".latch_rate") = 1;
      at(k, "root.latch_time") = 4 + t / 100;
      at(k, "mid.latch_time") = 5 + t / 50;
      at(k, "tip.latch_time") = at(k, "deployment_time") = 7 + 3 * t / 100;
    }
  }

  double& at(long run, const std::string& output) {
    const auto found = std::ranges::find(names.outputs, output);
    REQUIRE(found != names.outputs.end());
    return rows[static_cast<std::size_t>(run)]
        .outputs[static_cast<std::size_t>(found - names.outputs.begin())];
  }
  ResultRow& row(long run) { return rows[static_cast<std::size_t>(run)]; }

  [[nodiscard]] std::vector<std::size_t> chosen(std::size_t count) const {
    Results results(names);
    for (const ResultRow& each : rows) results.append(each);
    return chosen_rows(campaign, results, count);
  }
};

Json latch_campaign() {
  Json json = quick_campaign(20);
  json["outputs"] = {"latch_time", "latch_rate"};
  return json;
}

} // namespace

TEST_CASE("runs are chosen by turns from lists of outcomes, edges and extremes", "[accuracy]") {
  Json json = latch_campaign();
  json["requirements"] = parse_json(
      R"([{"output": "root.latch_time", "max": 4.162, "probability": 0.5, "confidence": 0.5}])");
  HandMade made(json, 20);
  made.row(7).status = Status::stalled;
  made.row(7).latch_order = "root";
  for (const char* output :
       {"mid.latch_time", "mid.latch_rate", "tip.latch_time", "tip.latch_rate", "deployment_time"})
    made.at(7, output) = none;
  made.row(11).latch_order = "root>tip>mid";
  made.row(13).status = Status::timed_out;
  made.row(13).latch_order = "root>mid";
  for (const char* output : {"tip.latch_time", "tip.latch_rate", "deployment_time"})
    made.at(13, output) = none;
  made.row(15).status = Status::failed;
  made.row(16).status = Status::invalid; // nearest to the limit, were it a run
  made.at(9, "tip.latch_time") = made.at(9, "mid.latch_time") + 1e-9;
  made.at(12, "root.latch_rate") =
      -1e-4; // slowest, and of 18 the one that differs: 4.1 standard deviations
  made.at(5, "mid.latch_rate") = 9;                                      // of 17: 4.0
  made.at(18, "tip.latch_time") = made.at(18, "deployment_time") = 19.9; // less, among 16
  // Lists: status 0 7 13 1 …, order 0 7 11 13 …, limit 17 18 14 …, edges 9 12 18 0 0 19 …, extremes 12 5 …,
  // evenly 0 2 4 5 … First turn: 0, 7, 17, 9, 12, 2; second: 13, 11, 18, 19, 5, 4.
  CHECK(made.chosen(6) == std::vector<std::size_t>{0, 1, 7, 9, 12, 17});
  CHECK(made.chosen(12) == std::vector<std::size_t>{0, 2, 4, 5, 7, 9, 11, 12, 13, 17, 18, 19});
}

TEST_CASE("where there are peaks, the extremes are the largest of these", "[accuracy]") {
  Json json = latch_campaign();
  json["outputs"] = {"latch_time", "latch_rate", "peak_moment"};
  HandMade made(json, 40);
  for (long k = 0; k < 40; ++k) made.at(k, "mid.peak_moment") = 100 + static_cast<double>(k % 7);
  made.at(33, "mid.peak_moment") = 300;
  made.at(29, "mid.peak_moment") = -100; // as far off on the other side
  made.at(31, "root.latch_rate") = 900;  // no peak
  const std::vector<std::size_t> chosen = made.chosen(5);
  CHECK(std::ranges::count(chosen, 33U) == 1);
  CHECK(std::ranges::count(chosen, 29U) == 0);
  CHECK(std::ranges::count(chosen, 31U) == 0);
}

TEST_CASE("no more runs are chosen than there are, and none that failed or was invalid",
          "[accuracy]") {
  HandMade made(latch_campaign(), 5);
  made.row(1).status = Status::failed;
  made.row(3).status = Status::invalid;
  CHECK(made.chosen(24) == std::vector<std::size_t>{0, 2, 4});
  for (long k : {0, 2, 4}) made.row(k).status = Status::failed;
  CHECK(made.chosen(24).empty());
  CHECK(HandMade(latch_campaign(), 0).chosen(24).empty());
}
