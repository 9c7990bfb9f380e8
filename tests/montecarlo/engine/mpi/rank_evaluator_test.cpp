#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/rare/rare_event.hpp"
#include "montecarlo/analyses/sensitivity/saltelli.hpp"
#include "montecarlo/engine/mpi/messages.hpp"
#include "montecarlo/engine/mpi/rank_evaluator.hpp"
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "tests/montecarlo/engine/mpi/memory_transport.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cstdint>
#include <deque>
#include <memory>
#include <stdexcept>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// All lines of a range, as they are handed on.
std::string lines(Evaluator& evaluator, const RunPlan& plan, RunRange range) {
  std::string text;
  long next = range.first;
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) CHECK(row.run == next++);
    text += batch.csv;
  };
  CHECK(evaluator.make(plan, range, {keep, true}) == range.size());
  return text;
}

std::string lines_of_threads(const RunPlan& plan, RunRange range) {
  ThreadEvaluator evaluator({.threads = 2}, never);
  return lines(evaluator, plan, range);
}

/// What the rows hold, beside their lines: every number bit by bit.
bool is_same(const Results& a, const Results& b) {
  const auto bits = [](const std::vector<Column>& one, const std::vector<Column>& other) {
    return std::ranges::equal(one, other, [](const Column& x, const Column& y) {
      return x.name == y.name && std::ranges::equal(x.values, y.values, [](double u, double v) {
               return std::bit_cast<std::uint64_t>(u) == std::bit_cast<std::uint64_t>(v);
             });
    });
  };
  return a.runs == b.runs && a.status == b.status && bits(a.draws, b.draws) &&
         bits(a.outputs, b.outputs) && a.peaks_final == b.peaks_final;
}

Results rows(Evaluator& evaluator, const RunPlan& plan, RunRange range) {
  Results results(plan.names());
  const auto keep = [&](const Batch& batch) {
    CHECK(batch.csv.empty());
    for (const ResultRow& row : batch.rows) results.append(row);
  };
  (void)evaluator.make(plan, range, {keep});
  return results;
}

} // namespace

TEST_CASE("rows and lines are the same whatever the number of ranks", "[parallel]") {
  const Campaign campaign = campaign_of(full_campaign(300));
  const RunPlan plan(campaign);
  const std::string whole = lines_of_threads(plan, {0, 300});
  const Results all = rows_of(plan, {0, 300});
  for (const int ranks : {1, 2, 3, 5})
    for (const int threads : {1, 2}) {
      Job job(ranks);
      RankEvaluator evaluator = job.evaluator(threads);
      CHECK(lines(evaluator, plan, {0, 300}) == whole);
      CHECK(is_same(rows(evaluator, plan, {0, 300}), all));
      CHECK(lines(evaluator, plan, {0, 2}) + lines(evaluator, plan, {2, 2}) +
                lines(evaluator, plan, {2, 300}) ==
            whole);
      CHECK(evaluator.occupancy().trial_steps > 0);
    }
}

TEST_CASE("a design's own points go with the chunks of runs", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(64));
  const RunPlan plan = saltelli_plan(campaign, 64);
  const RunRange all{0, saltelli_runs(64, campaign.dispersions.size())};
  Job job(3);
  RankEvaluator evaluator = job.evaluator(1);
  CHECK(lines(evaluator, plan, all) == lines_of_threads(plan, all));
}

TEST_CASE("a rare event is estimated by several ranks as by one", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(1));
  for (const RareEvent& event : {RareEvent{"deployment_time", 7.125, true},
                                 RareEvent{"mid.latch_rate", 0.5, true, true}, RareEvent{}}) {
    const RareOptions options{.event = event, .samples = 200, .repeats = 1};
    ThreadEvaluator threads({.threads = 2}, never);
    const RareResult expected =
        estimate_rare_event(campaign, options, threads, [](const StudyProgress&) {});
    Job job(3);
    RankEvaluator ranks = job.evaluator(1);
    const RareResult found =
        estimate_rare_event(campaign, options, ranks, [](const StudyProgress&) {});
    CHECK(found.estimate.probability == expected.estimate.probability);
    CHECK(found.statuses == expected.statuses);
    CHECK(found.estimate.evaluations == expected.estimate.evaluations);
  }
}

TEST_CASE("margins are found by several ranks as by one", "[parallel]") {
  const Campaign campaign = campaign_of(one_panel_margin(100));
  MarginResult found;
  Job job(3);
  RankEvaluator ranks = job.evaluator(1);
  find_margin(
      campaign, ranks, [](const StudyProgress&) {}, found);
  CHECK(margin_csv(campaign, found) == margin_csv(campaign, margin_of(campaign)));
}

TEST_CASE("a measure without a recipe is taken on rank 0 alone", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(40));
  const RunPlan plan(campaign, {}, {"t_end", goal_of({}), [](const Scene&, const Outcome& outcome) {
                                      return outcome.t_end;
                                    }});
  Job job(2);
  RankEvaluator evaluator = job.evaluator(1);
  CHECK(is_same(rows(evaluator, plan, {0, 40}), rows_of(plan, {0, 40})));
}

TEST_CASE("several ranks that are stopped hand on what is done without a gap", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(6000));
  const RunPlan plan(campaign);
  const std::string whole = lines_of_threads(plan, {0, 6000});
  for (const long after : {0L, 1L, 30L, 150L}) {
    std::atomic<bool> stop = after == 0;
    std::string text;
    long seen = 0;
    const auto keep = [&](const Batch& batch) {
      text += batch.csv;
      seen += std::ssize(batch.rows);
      if (seen >= after) stop = true;
    };
    Job job(3);
    const long made = job.evaluator(1, stop).make(plan, {0, 6000}, {keep, true});
    CHECK(made == seen);
    CHECK(made >= after);
    CHECK(made < 6000);
    CHECK(whole.starts_with(text));
    RankEvaluator again = job.evaluator(1);
    CHECK(text + lines(again, plan, {made, 6000}) == whole);
  }
}

TEST_CASE("a signal to another rank stops them all", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(6000));
  const RunPlan plan(campaign);
  std::atomic<bool> stop = false;
  long seen = 0;
  const auto keep = [&](const Batch& batch) {
    seen += std::ssize(batch.rows);
    stop = true;
  };
  Job job(2, stop);
  CHECK(job.evaluator(1).make(plan, {0, 6000}, {keep}) == seen);
  CHECK(seen < 6000);
}

TEST_CASE("what the sink throws ends the work of all ranks", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(6000));
  const RunPlan plan(campaign);
  int batches = 0;
  const auto full_disk = [&](const Batch&) {
    if (++batches == 3) throw std::runtime_error("the disk is full");
  };
  Job job(3);
  RankEvaluator evaluator = job.evaluator(1);
  CHECK_THROWS_WITH(evaluator.make(plan, {0, 6000}, {full_disk}), "the disk is full");
  CHECK(batches == 3);
  CHECK(lines(evaluator, plan, {0, 60}) == lines_of_threads(plan, {0, 60})); // and they can go on
}

TEST_CASE("what goes wrong on another rank reaches rank 0, with its rank", "[parallel]") {
  Campaign campaign = campaign_of(quick_campaign(6000));
  campaign.resolved["scene"]["hinges"] = Json::array(); // what the others will read of it
  const RunPlan plan(campaign);
  Job job(2);
  RankEvaluator evaluator = job.evaluator(1);
  try {
    (void)evaluator.make(plan, {0, 6000}, {[](const Batch&) {}});
    FAIL("nothing was thrown");
  } catch (const MachineError& error) {
    CHECK_THAT(error.what(), Catch::StartsWith("rank 1: "));
    CHECK_THAT(error.what(), Catch::Contains("hinges"));
  }
}

// A run's trial steps do not depend on where it is made.
TEST_CASE("the occupancy counts the trial steps of all ranks", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(300));
  const RunPlan plan(campaign);
  const auto steps = [](const Evaluator& evaluator) {
    return evaluator.occupancy().busy + evaluator.occupancy().scalar;
  };
  ThreadEvaluator alone({.threads = 1}, never);
  (void)lines(alone, plan, {0, 300});
  for (const int ranks : {2, 4}) {
    Job job(ranks);
    RankEvaluator evaluator = job.evaluator(1);
    (void)lines(evaluator, plan, {0, 300});
    CHECK(steps(evaluator) == steps(alone));
  }
}

namespace {

/// Two other ranks that fail as soon as they are sent a plan, the first one first.
class FailingRanks final : public Transport {
public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int size() const override { return 3; }
  void send(int to, std::string) override {
    if (to != 2 || answered_) return; // by then both have the plan
    answered_ = true;
    for (const int from : {1, 2})
      waiting_.push_back({from, closed_message({{}, "fault " + std::to_string(10 * from)})});
  }
  [[nodiscard]] std::optional<Message> receive() override {
    if (waiting_.empty()) return std::nullopt;
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }

private:
  bool answered_ = false;
  std::deque<Message> waiting_;
};

} // namespace

TEST_CASE("of several ranks that fail the first is told: the others may fail because of it",
          "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(8));
  RankEvaluator evaluator(std::make_unique<FailingRanks>(), {.threads = 1}, never);
  CHECK_THROWS_WITH(evaluator.make(RunPlan(campaign), {0, 8}, {[](const Batch&) {}}),
                    "rank 1: fault 10");
}
