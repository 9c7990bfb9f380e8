#include "montecarlo/engine/runs/evaluator.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>
#include <stdexcept>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// All lines of a range, as they are handed on.
std::string lines(const RunPlan& plan, RunRange range, int threads) {
  std::string text;
  long next = range.first;
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) CHECK(row.run == next++);
    text += batch.csv;
  };
  const long made = ThreadEvaluator({.threads = threads}, never).make(plan, range, {keep, true});
  CHECK(made == range.size());
  return text;
}

} // namespace

TEST_CASE("the rows are the same whatever the number of threads", "[parallel]") {
  const Campaign campaign = campaign_of(full_campaign(60));
  const RunPlan plan(campaign);
  const std::string one = lines(plan, {0, 60}, 1);
  for (const int threads : {2, 3, 7}) CHECK(lines(plan, {0, 60}, threads) == one);
}

TEST_CASE("any part of the runs is that part of the whole", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(50));
  const RunPlan plan(campaign);
  const std::string whole = lines(plan, {0, 50}, 2);
  CHECK(lines(plan, {0, 17}, 2) + lines(plan, {17, 17}, 2) + lines(plan, {17, 50}, 3) == whole);
}

TEST_CASE("stopping hands on what is done without a gap", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(4000));
  const RunPlan plan(campaign);
  const std::string whole = lines(plan, {0, 4000}, 2);
  for (const long after : {0L, 1L, 30L, 150L}) {
    std::atomic<bool> stop = after == 0;
    std::string text;
    long seen = 0;
    const auto keep = [&](const Batch& batch) {
      text += batch.csv;
      seen += std::ssize(batch.rows);
      if (seen >= after) stop = true;
    };
    const long made = ThreadEvaluator({.threads = 3}, stop).make(plan, {0, 4000}, {keep, true});
    CHECK(made == seen);
    CHECK(made >= after);
    CHECK(made < 4000);
    CHECK(whole.starts_with(text));
    CHECK(std::ranges::count(text, '\n') == made);
    CHECK(whole.starts_with(text + lines(plan, {made, std::min(made + 300, 4000L)}, 2)));
  }
}

TEST_CASE("what the sink throws comes out of the evaluator, and ends it", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(400));
  const RunPlan plan(campaign);
  int batches = 0;
  const auto full_disk = [&](const Batch&) {
    if (++batches == 3) throw std::runtime_error("the disk is full");
  };
  ThreadEvaluator evaluator({.threads = 3}, never);
  CHECK_THROWS_WITH(evaluator.make(plan, {0, 400}, {full_disk}), "the disk is full");
  CHECK(batches == 3);
}

TEST_CASE("every run has a status, and a reason unless it deployed or timed out", "[parallel]") {
  Json json = full_campaign(80);
  json["integration"]["max_steps"] = 300;
  json["integration"]["method"] = "dopri5"; // others need fewer
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  std::map<Status, long> counts;
  const Results results = rows_of(plan, {0, 80});
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Status status = results.status[i];
    ++counts[status];
    CHECK(results.reason[i].empty() == (status == Status::deployed || status == Status::timed_out));
  }
  long sum = 0;
  for (const auto& [status, count] : counts) sum += count;
  CHECK(sum == 80);
  CHECK(counts[Status::invalid] > 0);
  CHECK(counts[Status::failed] > 0);
}

TEST_CASE("lines are made where they are wanted, and rows of a measure hold it alone",
          "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(40));
  Goal goal = goal_of({});
  const Measure mass_and_time{"mass_and_time", goal,
                              [](const Scene& scene, const Outcome& outcome) {
                                return scene.bodies[0].mass + outcome.t_end;
                              }};
  const RunPlan own(campaign), measured(campaign, {}, mass_and_time);
  const Results rows = rows_of(own, {0, 40}), values = rows_of(measured, {0, 40});
  REQUIRE(values.outputs.size() == 1);
  CHECK(values.outputs[0].name == "mass_and_time");
  for (std::size_t i = 0; i < 40; ++i) {
    CHECK(values.draws[1].values[i] == rows.draws[1].values[i]); // of panel_1's mass
    const double t_end = Runner(own).replay(static_cast<long>(i), {}).outcome.t_end;
    CHECK(values.outputs[0].values[i] == rows.draws[1].values[i] + t_end);
  }
  const auto keep = [](const Batch& batch) { CHECK(batch.csv.empty()); };
  CHECK(ThreadEvaluator({}, never).make(own, {0, 40}, {keep}) == 40);
}
