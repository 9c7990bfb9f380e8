#include "montecarlo/analyses/run/campaign_run.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A caller of run_campaign: keeps what the callbacks are given, and stops the runs where it is told to.
struct Caller {
  long stop_after = -1; ///< runs of all cases; −1: never
  bool wants_statistics = true;
  std::vector<RunCounts> tallies{};
  std::vector<RunsKept> kept{};
  std::atomic<bool> stop = false;

  CampaignResults run(const RunRequest& request) {
    return run_campaign(request, {[&]() -> const std::atomic<bool>& { return stop; },
                                  [&](const RunCounts& counts) {
                                    tallies.push_back(counts);
                                    stop = stop_after >= 0 && counts.done >= stop_after;
                                  },
                                  [&](const RunsKept& runs) {
                                    kept.push_back(runs);
                                    return wants_statistics;
                                  }});
  }
};

Json two_cases(int runs) {
  Json json = quick_campaign(runs);
  json["cases"] = parse_json(R"([ { "name": "hot", "scale": { "hinges.*.spring.scale": 1.2 } },
                                  { "name": "cold", "scale": { "hinges.*.spring.scale": 0.8 } } ])");
  return json;
}

} // namespace

TEST_CASE("a campaign's runs and statistics are in its folder", "[parallel]") {
  const Folder folder;
  const Campaign campaign = campaign_of(full_campaign(60));
  Caller caller;
  const CampaignResults results =
      caller.run({.campaign = campaign, .out = folder.path() / "r", .pool = {.threads = 2}});
  (void)run_into(folder.path() / "expected", campaign);
  CHECK(contents(folder.path() / "r") == contents(folder.path() / "expected"));
  CHECK_FALSE(results.interrupted);
  CHECK_FALSE(results.whole);
  REQUIRE(results.folders.size() == 1);
  CHECK(results.folders[0].summary.runs == 60);
  const Json timing = parse_json_file(folder.path() / "r" / timing_file);
  CHECK(timing["runs"] == 60);
  CHECK(timing["runs_before"] == 0);
  CHECK(timing["interrupted"] == false);
  CHECK((timing["threads"] == 2 && timing["ranks"] == 1));
  const double seconds = timing["seconds"], per_second = timing["runs_per_second"];
  CHECK(seconds > 0);
  CHECK(per_second * seconds == Approx(60));
  if (timing["lanes"] > 1) {
    double outside = 0;
    for (const auto& [cause, share] : timing["outside_lanes"].items()) {
      CHECK(share >= 0);
      outside += share.get<double>();
    }
    CHECK(timing["outside_lanes"].contains("event"));
    CHECK(outside > 0);
    CHECK(outside < 1);
  }
  CHECK(caller.tallies.back().done == 60);
  CHECK(caller.tallies.back().timed_out ==
        std::ranges::count(read_stored_results(results.folders[0].stored).results.status,
                           Status::timed_out));
}

TEST_CASE("a run that is stopped keeps its runs, and resuming completes the folder", "[parallel]") {
  const Folder folder;
  const RunRequest request{.campaign = campaign_of(quick_campaign(600)),
                           .out = folder.path() / "r",
                           .pool = {.threads = 2}};
  Caller stopping{.stop_after = 100};
  const CampaignResults part = stopping.run(request);
  REQUIRE(part.interrupted);
  CHECK(part.interrupted->kept >= 100);
  REQUIRE(part.interrupted->kept < 600);
  CHECK(part.folders.at(0).summary.runs == part.interrupted->kept);
  Caller unasked; // who does not ask to resume gets no runs of another session
  CHECK_THROWS_AS(unasked.run(request), SpecError);
  RunRequest again = request;
  again.resume = true;
  Caller caller;
  CHECK_FALSE(caller.run(again).interrupted);
  CHECK(caller.tallies.front().before == part.interrupted->kept);
  (void)run_into(folder.path() / "expected", request.campaign);
  CHECK(contents(folder.path() / "r") == contents(folder.path() / "expected"));
}

TEST_CASE("who resumes a folder is told at once what its runs ended as, with rows and without") {
  const Folder folder;
  Json json = full_campaign(300);
  json["dispersions"][0]["distribution"]["std"] = 0.6; // some springs are weaker than friction
  json["scene"]["hinges"][0]["friction"] = {{"model", "exact"}, {"coulomb", 0.3}};
  json["integration"]["t_end"] = 12;
  for (const bool streaming : {false, true}) {
    CAPTURE(streaming);
    RunRequest request{.campaign = campaign_of(json),
                       .out = folder.path() / (streaming ? "s" : "r"),
                       .pool = {.threads = 2},
                       .streaming = streaming};
    Caller first;
    const CampaignResults made = first.run(request);
    const Summary& summary = made.folders.at(0).summary;
    const auto counts = [](const RunCounts& of) {
      return std::array{of.done, of.total, of.invalid, of.failed, of.stalled, of.timed_out};
    };
    const auto count = [&](Status status) {
      return summary.statuses[static_cast<std::size_t>(status)].count;
    };
    const std::array expected{300L,
                              300L,
                              count(Status::invalid),
                              count(Status::failed),
                              count(Status::stalled),
                              count(Status::timed_out)};
    CHECK((expected[2] > 0 && expected[4] > 0 && expected[5] > 0));
    CHECK(std::set{expected[2], expected[3], expected[4], expected[5]}.size() == 4);
    CHECK(counts(first.tallies.back()) == expected);
    CHECK(first.tallies.back().before == 0);
    request.resume = true;
    Caller again;
    (void)again.run(request);
    CHECK(counts(again.tallies.front()) == expected);
    CHECK(again.tallies.front().before == 300);
  }
}

TEST_CASE("statistics that the caller does not want are left for later") {
  const Folder folder;
  Caller caller{.wants_statistics = false};
  const CampaignResults results =
      caller.run({.campaign = campaign_of(quick_campaign(8)), .out = folder.path() / "r"});
  CHECK(results.folders.empty());
  REQUIRE(results.interrupted);
  CHECK(results.interrupted->kept == 8);
  CHECK_FALSE(results.interrupted->interrupted);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "r" / summary_file));
}

TEST_CASE("cases are run one after the other, and their progress adds up", "[cases]") {
  const Folder folder;
  Caller caller;
  const CampaignResults results =
      caller.run({.campaign = campaign_of(two_cases(40)), .out = folder.path() / "r"});
  REQUIRE(results.whole);
  CHECK(results.folders.size() == 2);
  CHECK(results.cases.size() == 2);
  CHECK(std::filesystem::exists(folder.path() / "r" / cases_file));
  CHECK(caller.kept.at(1).of_case == "cold");
  CHECK(caller.tallies.back().done == 80);
  CHECK(std::ranges::is_sorted(caller.tallies, {}, &RunCounts::done));
  CHECK(std::ranges::all_of(caller.tallies,
                            [](const RunCounts& counts) { return counts.total == 80; }));
}

TEST_CASE("runs that a case leaves out, as it has reached its goal, are no longer in the total",
          "[cases]") {
  Json json = two_cases(1010);
  json["outputs"] = {"latch_time"};
  json["until"] = parse_json(R"([{ "output": "deployed", "width": 0.5 }])"); // reached after 1000
  const Folder folder;
  Caller caller;
  (void)caller.run({.campaign = campaign_of(json), .out = folder.path() / "r"});
  CHECK(caller.tallies.front().total == 2020);
  CHECK((caller.tallies.back().done == 2000 && caller.tallies.back().total == 2010));
}

TEST_CASE("cases that are stopped have no comparison, and one case alone can be run", "[cases]") {
  const Folder folder;
  const RunRequest request{.campaign = campaign_of(two_cases(400)), .out = folder.path() / "r"};
  Caller stopping{.stop_after = 450};
  const CampaignResults part = stopping.run(request);
  REQUIRE(part.interrupted);
  CHECK(part.interrupted->of_case == "cold");
  CHECK(part.folders.size() == 2);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "r" / cases_file));
  RunRequest cold = request;
  cold.cases = {"cold"};
  cold.resume = true;
  Caller caller;
  const CampaignResults rest = caller.run(cold);
  CHECK(rest.folders.size() == 1);
  CHECK(rest.cases.size() == 2);
  cold.cases = {"warm"};
  CHECK(message_of([&] { (void)caller.run(cold); }).find("warm") != std::string::npos);
}

TEST_CASE("streaming keeps statistics and no rows") {
  const Folder folder;
  Caller caller;
  const CampaignResults results = caller.run(
      {.campaign = campaign_of(quick_campaign(40)), .out = folder.path() / "r", .streaming = true});
  CHECK(results.folders.at(0).summary.runs == 40);
  CHECK(is_streaming_folder(folder.path() / "r"));
  CHECK(caller.tallies.back().done == 40);
}

TEST_CASE("rows in memory are the campaign's, up to where it stops") {
  Campaign campaign = campaign_of(quick_campaign(30));
  Stamp stamp = stamp_of(campaign, {});
  const StoredCampaign stored{{}, std::move(campaign), std::move(stamp)};
  const RunPlan plan(stored.campaign);
  const Results rows = run_in_memory(stored, plan, {.threads = 2}, never);
  const Results expected = rows_of(plan, {0, 30});
  CHECK(std::ranges::equal(rows.runs, expected.runs));
  CHECK(std::ranges::equal(rows.outputs.at(0).values, expected.outputs.at(0).values));
  const std::atomic<bool> now = true;
  CHECK(run_in_memory(stored, plan, {}, now).size() == 0);
}

TEST_CASE("the number of runs that are kept is told in words") {
  CHECK(describe(RunsKept{.of_case = "", .kept = 500, .total = 2000}) ==
        "500 of 2000 runs are kept");
  CHECK(describe(RunsKept{.of_case = "hot", .kept = 0, .total = 1}) ==
        "0 of 1 run of case hot is kept");
}

TEST_CASE("timing.json counts a session's own runs, and those of earlier sessions beside",
          "[parallel]") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(200));
  const auto path = folder.path() / "r";
  const long before = run_into(path, campaign, {.stop_after = 20});
  REQUIRE(before < 200);
  Caller caller;
  (void)caller.run({.campaign = campaign, .out = path, .pool = {.threads = 2}, .resume = true});
  const Json timing = parse_json_file(path / timing_file);
  CHECK(timing["runs_before"] == before);
  CHECK(timing["runs"] == 200 - before);
  const double seconds = timing["seconds"], per_second = timing["runs_per_second"];
  CHECK(per_second * seconds == Approx(200 - before));
}
