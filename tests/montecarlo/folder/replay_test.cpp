#include "montecarlo/folder/replay.hpp"
#include "tests/montecarlo/campaign_support.hpp"

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

TEST_CASE("every difference is named with its column") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
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
