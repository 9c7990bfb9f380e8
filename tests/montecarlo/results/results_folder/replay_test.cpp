#include "montecarlo/results/results_folder/replay.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("every replayed run is the recorded one, to the last bit", "[parallel]") {
  const Folder folder;
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign_of(full_campaign(24)), {.threads = 2});
  const StoredCampaign stored = read_stored_campaign(path);
  std::set<Status> seen;
  for (long k = 0; k < 24; ++k) {
    const Replayed replayed = ReplayRequest(stored, k).replay({});
    CHECK(replayed.recorded);
    CHECK(replayed.differences == std::vector<std::string>{});
    seen.insert(replayed.row.status);
  }
  CHECK(seen.contains(Status::timed_out));
}

TEST_CASE("a run that is not recorded can be replayed, one that does not exist cannot") {
  const Folder folder;
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign_of(quick_campaign(10)), {.shard = Shard{1, 2}});
  const StoredCampaign stored = read_stored_campaign(path);
  const Replayed replayed = ReplayRequest(stored, 7).replay({});
  CHECK_FALSE(replayed.recorded);
  CHECK(replayed.row.run == 7);
  for (const long run : {-1L, 10L})
    CHECK(message_of([&] { return ReplayRequest(stored, run); }) ==
          path.string() + ": found no run " + std::to_string(run) + ", expected a run from 0 to 9");
}

TEST_CASE("a row is found wherever it stands in a long file, and what is not there is not") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(10'000));
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign, {.stop_after = 1});
  const StoredCampaign stored = read_stored_campaign(path);
  ResultRow row = Runner(RunPlan(campaign)).run(0);
  std::string csv;
  append_header(csv, RunPlan(campaign).names());
  for (row.run = 0; row.run < 10'000; ++row.run) { // 3 MB
    row.draws[0] = static_cast<double>(row.run);
    if (row.run % 10 != 3) append_row(csv, row);
  }
  std::ofstream(path / runs_file, std::ios::binary) << csv;
  for (long run = 0; run < 10'000; run += run < 20 || run > 9980 ? 1 : 97) {
    CAPTURE(run);
    const auto found = find_stored_row(stored, run);
    REQUIRE(found.has_value() == (run % 10 != 3));
    if (found) CHECK(found->draws[0] == static_cast<double>(run));
  }
  CHECK_FALSE(find_stored_row(stored, 10'000).has_value());
}

TEST_CASE("a broken file is refused with its line, wherever the search began") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(2000));
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign);
  const auto file = path / runs_file;
  std::string text = read_text(file).value();
  text.insert(text.find("\n1500,") + 6, ",x");
  std::ofstream(file, std::ios::binary) << text;
  const StoredCampaign stored = read_stored_campaign(path);
  CHECK_THAT(message_of([&] { return find_stored_row(stored, 1500).has_value(); }),
             Catch::StartsWith(file.string() + ": line 1502: "));
  CHECK(find_stored_row(stored, 1200).has_value());
}

TEST_CASE("every difference is named with its column") {
  const ResultNames names{{"k"}, {"a", "b", "c"}};
  const ResultRow row{4, Status::deployed, {1}, {2, none, 0.0}, "root", ""};
  CHECK(differences(names, row, row).empty());
  const ResultRow other{4, Status::failed, {1.5}, {none, none, -0.0}, "", "why"};
  CHECK(differences(names, row, other) ==
        std::vector<std::string>{
            "run 4, column status: recorded as \"deployed\", computed as \"failed\"",
            "run 4, column k: recorded as 1, computed as 1.5",
            "run 4, column a: recorded as 2, computed as nothing",
            "run 4, column c: recorded as 0, computed as -0",
            "run 4, column latch_order: recorded as \"root\", computed as \"\"",
            "run 4, column reason: recorded as \"\", computed as \"why\""});
}

TEST_CASE("a difference in any one column of a row is found, and named with the column alone") {
  const Campaign campaign = campaign_of(full_campaign(4));
  const RunPlan plan(campaign);
  const ResultNames& names = plan.names();
  REQUIRE(names.peaks_final);
  const ResultRow row = Runner(plan).run(0);
  std::vector<ResultRow> others;
  std::vector<std::string> columns;
  const auto other = [&](const std::string& column) -> ResultRow& {
    columns.push_back(column);
    return others.emplace_back(row);
  };
  other("status").status = row.status == Status::failed ? Status::invalid : Status::failed;
  for (std::size_t i = 0; i < names.draws.size(); ++i) other(names.draws[i]).draws[i] = 1e300;
  for (std::size_t i = 0; i < names.outputs.size(); ++i) other(names.outputs[i]).outputs[i] = 1e300;
  other("peaks_final").peaks_final =
      row.peaks_final == PeaksFinal::yes ? PeaksFinal::no : PeaksFinal::yes;
  other("latch_order").latch_order += ">x";
  other("reason").reason += "x";
  CHECK(columns.size() + 1 == header_cells(names).size()); // `run` tells which row it is
  for (std::size_t k = 0; k < others.size(); ++k) {
    const std::vector<std::string> found = differences(names, others[k], row);
    CAPTURE(columns[k]);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found.front(), Catch::Contains(", column " + columns[k] + ": "));
  }
}
