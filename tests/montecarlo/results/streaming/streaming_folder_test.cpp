#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Counts the runs that are made.
class CountingEvaluator final : public Evaluator {
public:
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override {
    const long made = inner_.make(plan, range, sink);
    made_ += made;
    return made;
  }
  [[nodiscard]] const Occupancy& occupancy() const override { return inner_.occupancy(); }
  [[nodiscard]] long made() const { return made_; }

private:
  std::atomic<bool> stop_ = false;
  ThreadEvaluator inner_{{.threads = 1}, stop_};
  long made_ = 0;
};

} // namespace

TEST_CASE("without rows: a folder makes each of its runs once, those of the pilot too") {
  const Folder place;
  const Campaign campaign = campaign_of(quick_campaign(5000));
  const RunPlan plan(campaign);
  const auto [shard, own, made] = GENERATE(table<std::optional<Shard>, long, long>(
      {{std::nullopt, 5000, 5000}, {Shard{2, 2}, 2500, 5000}, {Shard{1, 5}, 1000, 4096}}));
  CountingEvaluator evaluator;
  StreamingFolder folder(place.path() / "r", plan, shard, false);
  REQUIRE(folder.begin(evaluator));
  CHECK(evaluator.made() == grid_pilot_runs);
  CHECK(folder.count() == std::min(own, grid_pilot_runs - folder.stored().runs().first));
  const auto add = [&](const Batch& batch) { folder.add(batch); };
  (void)evaluator.make(plan, folder.remaining(), {add});
  folder.finish();
  CHECK(folder.count() == own);
  CHECK(folder.resumed() == 0);
  CHECK(evaluator.made() == made);
}

TEST_CASE(
    "without rows: the broken runs that are read are those whose lines end within the bytes told") {
  const Folder place;
  const Campaign campaign = campaign_of(full_campaign(300));
  const RunPlan plan(campaign);
  ThreadEvaluator evaluator({.threads = 2}, never);
  StreamingFolder folder(place.path() / "r", plan, std::nullopt, false);
  REQUIRE(folder.begin(evaluator));
  folder.finish();
  const StoredCampaign stored = read_stored_campaign(place.path() / "r");
  const std::string text = read_text(stored.folder / broken_runs_file).value();
  REQUIRE(std::ranges::count(text, '\n') > 5);
  std::vector<long> expected;
  for (const Results all = rows_of(plan, {0, 300}); const long run : all.runs)
    if (all.status[static_cast<std::size_t>(run)] != Status::deployed) expected.push_back(run);
  std::size_t rows = 0;
  for (std::size_t end = text.find('\n') + 1; true; end = text.find('\n', end) + 1, ++rows) {
    CAPTURE(rows);
    const Results read = read_broken_runs(stored, end);
    CHECK(std::ranges::equal(read.runs, std::span(expected).first(rows)));
    if (end == text.size()) break;
    CHECK(read_broken_runs(stored, text.find('\n', end)).size() ==
          rows); // a byte of the next is missing
  }
  CHECK(rows == expected.size());
}
