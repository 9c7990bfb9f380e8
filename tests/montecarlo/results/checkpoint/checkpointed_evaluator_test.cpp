#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/results/checkpoint/analysis_id.hpp"
#include "montecarlo/results/checkpoint/checkpointed_evaluator.hpp"
#include "montecarlo/results/checkpoint/row_records.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A study of three looks, each of which depends on what the one before came to: its rows, one behind the other.
class Study {
public:
  explicit Study(Json json) : json_(std::move(json)) {}

  /// @param stop_after rows that were made; what was logged does not count
  std::string run(const std::filesystem::path& log_file, long stop_after = 1'000'000,
                  const Json& about = {{"study", "three looks"}}) {
    std::atomic<bool> stop = false;
    ThreadEvaluator threads({.threads = 1}, stop);
    Checkpoint log(log_file, about);
    CheckpointedEvaluator evaluator(threads, log, stop);
    std::string lines;
    double scale = 1;
    for (int look = 0; look < 3; ++look) {
      Json json = json_;
      json["scene"]["hinges"][0]["spring"]["torque_latched"] = scale;
      const Campaign campaign = campaign_of(json);
      const RunPlan plan(campaign);
      const auto keep = [&](const Batch& batch) {
        lines += batch.csv;
        for (const ResultRow& row : batch.rows) scale += 1e-3 * std::abs(row.outputs.front());
        stop = static_cast<long>(std::ranges::count(lines, '\n')) - log.read() >= stop_after;
      };
      const RunRange range{0, campaign.sampling.runs};
      if (evaluator.make(plan, range, {keep, true}) < range.size()) break;
    }
    read_ = log.read();
    damaged_ = log.was_damaged();
    return lines;
  }

  [[nodiscard]] long read() const { return read_; }
  [[nodiscard]] bool damaged() const { return damaged_; }

private:
  Json json_;
  long read_ = 0;
  bool damaged_ = false;
};

} // namespace

TEST_CASE("rows come back from a record to the bit, whatever is in them") {
  const Campaign campaign = campaign_of(quick_campaign(10));
  const RunPlan plan(campaign);
  std::vector<ResultRow> rows;
  for (long run = 4; run < 8; ++run) rows.push_back(Runner(plan).run(run));
  rows[1].outputs[0] = std::numeric_limits<double>::infinity();
  rows[1].outputs[1] = -0.0;
  rows[2].status = Status::failed;
  rows[2].reason = std::string("a \"reason\",\n\0with all", 22);
  rows[2].latch_order.clear();
  rows[0].peaks_final = PeaksFinal::yes;
  rows[2].peaks_final = PeaksFinal::no;
  rows[3].peaks_final = PeaksFinal::unknown;
  std::vector<ResultRow> back;
  for_each_record(rows, [&](std::string_view record) {
    for (ResultRow& row : rows_of_record(record, plan, {4, 10}, "log")) back.push_back(row);
  });
  REQUIRE(back.size() == rows.size());
  const auto bits = [](const std::vector<double>& numbers) {
    std::vector<std::uint64_t> all;
    for (const double number : numbers) all.push_back(std::bit_cast<std::uint64_t>(number));
    return all;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(back[i].run == rows[i].run);
    CHECK(back[i].status == rows[i].status);
    CHECK(bits(back[i].draws) == bits(rows[i].draws));
    CHECK(bits(back[i].outputs) == bits(rows[i].outputs));
    CHECK(back[i].latch_order == rows[i].latch_order);
    CHECK(back[i].reason == rows[i].reason);
    CHECK(back[i].peaks_final == rows[i].peaks_final);
  }
}

TEST_CASE("long rows go into several records, so that a reader needs little memory") {
  const Campaign campaign = campaign_of(quick_campaign(10'000));
  const RunPlan plan(campaign);
  std::vector<ResultRow> rows(5000, Runner(plan).run(0));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].run = static_cast<long>(i);
    plan.draw(rows[i].run, rows[i].draws);
  }
  long records = 0, next = 0;
  for_each_record(rows, [&](std::string_view record) {
    CHECK(record.size() < 70'000);
    next += std::ssize(rows_of_record(record, plan, {next, 10'000}, "log"));
    ++records;
  });
  CHECK(next == 5000);
  CHECK(records > 5);
}

TEST_CASE("rows of other draws, of another place and of another length are refused") {
  const Campaign campaign = campaign_of(quick_campaign(10));
  Json json = quick_campaign(10);
  json["sampling"]["seed"] = 8;
  const Campaign other = campaign_of(json);
  const RunPlan plan(campaign), other_plan(other);
  const std::vector<ResultRow> rows{Runner(plan).run(3), Runner(plan).run(4)};
  for_each_record(rows, [&](std::string_view record) {
    CHECK(rows_of_record(record, plan, {3, 5}, "log").size() == 2);
    const auto refused = Catch::Contains("log: found rows with other draws from run 3 on");
    CHECK_THROWS_WITH(rows_of_record(record, other_plan, {3, 5}, "log"), refused);
    CHECK_THROWS_WITH(rows_of_record(record, plan, {3, 4}, "log"), refused);
    CHECK_THROWS_AS(rows_of_record(record, plan, {2, 5}, "log"), SpecError);
    CHECK_THROWS_WITH(rows_of_record(record.substr(0, record.size() - 1), plan, {3, 5}, "log"),
                      refused);
    CHECK_THROWS_WITH(rows_of_record(std::string(record) + 'x', plan, {3, 5}, "log"), refused);
  });
}

TEST_CASE("a study stopped at any run goes on from its log to the same rows") {
  const Folder folder;
  Study study(quick_campaign(40));
  const std::string whole = study.run(folder.path() / "whole");
  CHECK(std::ranges::count(whole, '\n') == 120);
  for (const long after : {1L, 20L, 39L, 40L, 41L, 75L, 95L}) {
    const auto log = folder.path() / std::to_string(after);
    const std::string part = study.run(log, after);
    CHECK(whole.starts_with(part));
    CHECK(part.size() < whole.size());
    CHECK(study.run(log, 3).starts_with(part)); // and is stopped once more
    CHECK(study.run(log) == whole);
    CHECK(study.read() >= after);
    CHECK(study.run(log) == whole); // all of it from the log
    CHECK(study.read() == 120);
  }
}

TEST_CASE("a log that was cut off or changed at any byte is believed up to there, and no further") {
  const Folder folder;
  Study study(quick_campaign(6));
  const auto log = folder.path() / "log";
  const std::string whole = study.run(log), bytes = bytes_of(log);
  const std::size_t header = bytes.find("look") + 6; // within the first record
  long most = 0;
  const auto stride = static_cast<std::size_t>(random_cases(7, 29));
  for (std::size_t size = bytes.size(); size-- > header + 20;) {
    if (size % stride != 0 && size + 40 < bytes.size())
      continue; // each byte takes two runs of the study
    CAPTURE(size);
    std::ofstream(log, std::ios::binary) << bytes.substr(0, size);
    REQUIRE(study.run(log) == whole);
    most = std::max(most, study.read());
    REQUIRE_FALSE(study.damaged());
    std::string changed = bytes;
    changed[size] = static_cast<char>(changed[size] ^ 4);
    std::ofstream(log, std::ios::binary) << changed;
    REQUIRE(study.run(log) == whole);
    REQUIRE(study.read() < 18);
  }
  CHECK(most == 17); // all but the last row
}

TEST_CASE("the log of another study is refused, with what differs") {
  const Folder folder;
  Study study(quick_campaign(6));
  const std::string log = folder.path() / "log";
  const Json ours =
      parse_json(R"({ "wingspread": { "version": "1", "seed": 7 }, "samples": 100 })");
  (void)study.run(log, 8, ours);
  const std::string before = bytes_of(log);
  Json other = ours;
  other["wingspread"]["seed"] = 8;
  other["samples"] = 200;
  CHECK_THROWS_WITH(study.run(log, 1, other),
                    log + ": /wingspread/seed: found 7, expected 8, to continue what is there\n" +
                        log + ": /samples: found 100, expected 200, to continue what is there");
  other = ours;
  other["event"] = "stalled"; // of another kind
  CHECK_THROWS_WITH(study.run(log, 1, other),
                    log + ": /event: found null, expected \"stalled\", to continue what is there");
  CHECK_THROWS_AS(study.run(log, 1, {{"samples", 100}}), SpecError);
  // the same by its words, and other runs all the same: as by another library of mathematics
  Json changed = quick_campaign(6);
  changed["dispersions"][0]["distribution"]["std"] = 0.06;
  CHECK_THROWS_WITH(Study(changed).run(log, 1, ours),
                    Catch::Contains(log + ": found analysis 1: campaign ") &&
                        Catch::Contains("what this study asks for"));
  CHECK(bytes_of(log) == before);
}

TEST_CASE("the folder of a study: new, gone on with, finished") {
  const Folder folder;
  const auto path = folder.path() / "s";
  const Json about{{"samples", 100}};
  Study study(quick_campaign(6));
  const auto open = [&](bool resume, const Json& whose) {
    return StudyFolder(path, whose, "last.json", resume).is_finished();
  };
  CHECK_FALSE(open(false, about));
  CHECK_FALSE(open(true, about)); // nothing was done, nothing is left
  CHECK_FALSE(std::filesystem::exists(path));
  std::filesystem::create_directory(path);
  const std::string whole = study.run(path / checkpoint_file, 8, about);
  CHECK_THROWS_WITH(open(false, about), path.string() +
                                            ": found an interrupted study, expected a new or an "
                                            "empty folder (--resume continues this one)");
  CHECK_FALSE(open(true, about));
  CHECK_THROWS_WITH(open(true, {{"samples", 200}}), Catch::Contains("/samples: found 100"));
  write_file(path / "last.json", about.dump());
  CHECK_FALSE(open(true, about)); // killed between its last file and the end of its checkpoint
  {
    StudyFolder own(path, about, "last.json", true);
    CHECK_THROWS_AS(open(true, about), MachineError); // one writer
    own.finish();
  }
  CHECK_FALSE(std::filesystem::exists(path / checkpoint_file));
  CHECK(open(true, about));
  CHECK_THROWS_WITH(open(true, {{"samples", 200}}),
                    Catch::Contains("last.json: /samples: found 100"));
  CHECK_THROWS_WITH(open(false, about), path.string() + ": found a folder with files in it, "
                                                        "expected a new or an empty folder");
  std::filesystem::remove(path / "last.json");
  write_file(path / "other.csv", "a\n");
  CHECK_THROWS_WITH(open(true, about), Catch::Contains("found no interrupted study"));
}

TEST_CASE(
    "an analysis is identified by its campaign, its runs and their draws, the first and the last") {
  const Campaign campaign = campaign_of(quick_campaign(10));
  const auto at_points = [&](long run, double first) { // so far only that run has another point
    return RunPlan(campaign, [run, first](long k, std::span<Tails> u) {
      std::ranges::fill(u, Tails{0.5, 0.5});
      if (k == run) u[0] = Tails{first, 1 - first};
    });
  };
  const std::string usual = analysis_id(at_points(0, 0.5), {2, 7});
  CHECK(analysis_id(at_points(0, 0.25), {2, 7}) == usual); // of a run that is not asked for
  CHECK(analysis_id(at_points(2, 0.25), {2, 7}) != usual);
  CHECK(analysis_id(at_points(6, 0.25), {2, 7}) != usual);
  CHECK(analysis_id(at_points(0, 0.5), {2, 8}) != usual);
  CHECK(analysis_id(at_points(0, 0.5), {1, 7}) != usual);
  const std::string nothing = analysis_id(at_points(0, 0.5), {2, 2});
  CHECK(analysis_id(at_points(2, 0.25), {2, 2}) == nothing); // no run, no draw
}

TEST_CASE("a study is the same as another with as many parts as it says, and no other number") {
  const Json there{{"samples", 100}, {"parts", {"a", "b", "c"}}};
  for (long parts = 0; parts < 6; ++parts) {
    const std::string told = message_of([&] {
      refuse_other_study("log", there, {{"samples", 100}, {"parts", parts}});
    });
    CHECK(told == (parts == 3 ? ""
                              : "log: /parts: found 3, expected " + std::to_string(parts) +
                                    ", to continue what is there"));
  }
}
