#include "montecarlo/runs/engine.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <numeric>
#include <stdexcept>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::atomic<bool> never = false;

/// All lines of a range, as they are handed on.
std::string lines(const RunPlan& plan, RunRange range, int threads) {
  std::string text;
  long next = range.first;
  const long made = make_runs(plan, range, threads, never, [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) CHECK(row.run == next++);
    text += batch.csv;
  });
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
    const long made = make_runs(plan, {0, 4000}, 3, stop, [&](const Batch& batch) {
      text += batch.csv;
      seen += std::ssize(batch.rows);
      if (seen >= after) stop = true;
    });
    CHECK(made == seen);
    CHECK(made >= after);
    CHECK(made < 4000);
    CHECK(whole.starts_with(text));
    CHECK(std::ranges::count(text, '\n') == made);
    CHECK(text + lines(plan, {made, 4000}, 2) == whole);
  }
}

TEST_CASE("what the sink throws comes out of the engine, and ends it", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(400));
  const RunPlan plan(campaign);
  int batches = 0;
  const auto full_disk = [&](const Batch&) {
    if (++batches == 3) throw std::runtime_error("the disk is full");
  };
  CHECK_THROWS_WITH(make_runs(plan, {0, 400}, 3, never, full_disk), "the disk is full");
  CHECK(batches == 3);
}

TEST_CASE("every run has a status, and a reason unless it deployed or timed out", "[parallel]") {
  Json json = full_campaign(80);
  json["integration"]["max_steps"] = 600;
  json["integration"]["method"] = "dopri5"; // others need fewer
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  std::map<Status, long> counts;
  (void)make_runs(plan, {0, 80}, 2, never, [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) {
      ++counts[row.status];
      const bool plain = row.status == Status::deployed || row.status == Status::timed_out;
      CHECK(row.reason.empty() == plain);
    }
  });
  long sum = 0;
  for (const auto& [status, count] : counts) sum += count;
  CHECK(sum == 80);
  CHECK(counts[Status::invalid] > 0);
  CHECK(counts[Status::failed] > 0);
}
