#include "montecarlo/results/summary/compact_table.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/table.hpp"
#include "montecarlo/results/summary/warnings.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Results four_runs(const std::vector<PeaksFinal>& finals = {PeaksFinal::yes, PeaksFinal::no,
                                                           PeaksFinal::yes, PeaksFinal::unknown}) {
  Results results(ResultNames{{}, {"root.latch_rate"}, true});
  for (long run = 0; run < 4; ++run)
    results.append({run,
                    Status::deployed,
                    {},
                    {-1.25 - 0.25 * static_cast<double>(run)},
                    "",
                    "",
                    finals[static_cast<std::size_t>(run)]});
  return results;
}

} // namespace

TEST_CASE("what is to be warned of stands in the table and in summary.json") {
  const Results results = four_runs();
  Summary summary = summarize(results, {});
  summary.peaks = count_peaks_final(results);
  CHECK((summary.peaks->proven == 2 && summary.peaks->cut == 1 && summary.peaks->unknown == 1));
  summary.requirements = {judge({"", "root.latch_rate", 1.5, {}, .5, .5}, results)};
  const std::vector<std::string> expected{
      "in 1 of 4 runs t_end cut the peaks: they may still rise, and break every max on a peak; "
      "statistics and correlations are of the cut values. Lengthen t_end",
      "root.latch_rate ≤ 1.5 rad/s, 50 % at 50 %: every value of the runs that deployed (least -2 "
      "rad/s, largest -1.25 rad/s) is on the other side of zero from the limit; \"abs\": true "
      "limits the magnitude"};
  CHECK(warnings(summary) == expected);
  const Json json = summary_json(summary, {});
  CHECK(json["warnings"] == Json(expected));
  CHECK(json["peaks_final"] == Json{{"true", 2}, {"false", 1}, {"missing", 1}});
  CHECK(json["definitions"].contains("peaks_final"));
  CHECK_THAT(summary_table(summary, "four", ""), Catch::Contains(warning_lines(expected)));
}

TEST_CASE("values are compared with a limit in degrees in degrees") {
  const Results results = four_runs();
  Summary summary = summarize(results, {});
  const double degree = std::acos(-1) / 180;
  summary.requirements = {judge({"", "root.latch_rate", 60 * degree, {}, .5, .5}, results)};
  REQUIRE(warnings(summary).size() == 1);
  CHECK_THAT(warnings(summary).front(),
             Catch::Contains("60 deg/s") &&
                 Catch::Contains(fmt::format("least {:.5g} deg/s, largest {:.5g} deg/s",
                                             -2 / degree, -1.25 / degree)));
}

TEST_CASE("where nothing is wrong nothing is warned of") {
  const Results results = four_runs(std::vector<PeaksFinal>(4, PeaksFinal::yes));
  Summary summary = summarize(results, {});
  CHECK(warnings(summary).empty());
  summary.peaks = count_peaks_final(results);
  REQUIRE(summary.peaks);
  CHECK(warnings(summary).empty());
  summary.peaks = count_peaks_final(four_runs(std::vector<PeaksFinal>(4, PeaksFinal::unknown)));
  CHECK(warnings(summary).empty());
}

TEST_CASE("outputs that the tolerance does not decide are named") {
  Summary summary = summarize(four_runs(), {});
  summary.accuracy = Accuracy{};
  summary.accuracy->runs = 10;
  CHECK(warnings(summary).empty());
  summary.accuracy->moved = {3, 5};
  summary.accuracy->moved_outputs = {"root.final_angle"};
  CHECK_THAT(
      warnings(summary).at(0),
      Catch::StartsWith("in 2 of the 10 runs repeated at a tighter tolerance root.final_angle "
                        "moves by more than 1 %") &&
          Catch::Contains("smaller rtol and atol; if it moves still"));
  std::vector<std::string>& moved = summary.accuracy->moved_outputs;
  moved = {"a", "b", "c"};
  for (const char* named :
       {"a, b, c move by more", "a, b, c, d move by more", // not "1 more"
        "a, b, c and 2 more outputs move by more", "a, b, c and 3 more outputs move by more"}) {
    CHECK_THAT(warnings(summary).at(0), Catch::Contains(std::string("tolerance ") + named));
    moved.emplace_back(1, static_cast<char>('a' + moved.size()));
  }
}

TEST_CASE("a warning of several cases is told once, with its cases") {
  const auto of_case = [](const std::string& name, std::vector<LatchJump> jumps) {
    CaseSummary made{name, summarize(four_runs(), {})};
    made.summary.latch_jumps = std::move(jumps);
    return made;
  };
  const std::vector<CaseSummary> cases{of_case("cold", {{"panel_2", 6, 10}}),
                                       of_case("ambient", {{"panel_2", 9, 10}}),
                                       of_case("hot", {{"panel_3", 6, 10}})};
  const std::vector<std::string> found = warnings(cases);
  REQUIRE(found.size() == 2); // numbers may differ, hinges may not
  CHECK_THAT(found[0], Catch::Contains("of panel_2 (60 to 90 %): ") &&
                           Catch::EndsWith(" (cold 60, ambient 90)"));
  CHECK_THAT(found[1], Catch::Contains("of panel_3 (60 %): ") && Catch::EndsWith(" (hot)"));
  CHECK_THAT(warnings(std::span(cases).first(1)).at(0), Catch::EndsWith(" (every case)"));
  for (const std::string& table :
       {cases_table(cases, "t", "f"), compact_cases_table(cases, "t", "f")})
    CHECK_THAT(table, Catch::Contains(warning_lines(found)));
}

TEST_CASE("a warning of several cases has the number of each") {
  const auto of_case = [](const std::string& name, long cut) {
    CaseSummary made{name, summarize(four_runs(), {})};
    made.summary.peaks.emplace();
    made.summary.peaks->add(PeaksFinal::no, cut);
    return made;
  };
  const std::vector<CaseSummary> cases{of_case("cold", 4), of_case("hot", 1)};
  CHECK_THAT(warnings(cases).at(0),
             Catch::StartsWith("in 1 to 4 of 4 runs t_end cut the peaks: ") &&
                 Catch::EndsWith(" (every case: cold 4, hot 1)"));
  const std::vector<CaseSummary> alike{of_case("cold", 4), of_case("hot", 4)};
  CHECK_THAT(warnings(alike).at(0), Catch::StartsWith("in 4 of 4 runs t_end cut the peaks: ") &&
                                        Catch::EndsWith(" (every case)"));
}

TEST_CASE(
    "two requirements that differ in their limit alone are warned of apart, each with its cases") {
  const auto of_case = [](const std::string& name, const std::vector<double>& limits) {
    CaseSummary made{name, summarize(four_runs(), {})};
    for (const double limit : limits)
      made.summary.requirements.push_back(
          judge({"", "root.latch_rate", limit, {}, .5, .5}, four_runs()));
    return made;
  };
  const std::vector<CaseSummary> cases{of_case("cold", {2}), of_case("hot", {1, 2}),
                                       of_case("warm", {})};
  const std::vector<std::string> found = warnings(cases);
  REQUIRE(found.size() == 2);
  CHECK_THAT(found[0],
             Catch::StartsWith("root.latch_rate ≤ 2 rad/s") && Catch::EndsWith(" (cold, hot)"));
  CHECK_THAT(found[1], Catch::StartsWith("root.latch_rate ≤ 1 rad/s") && Catch::EndsWith(" (hot)"));
}

TEST_CASE("a warning of several cases has the least and the largest number, of any length") {
  std::mt19937_64 random(2);
  for (int k = 0; k < 50; ++k) {
    std::vector<CaseSummary> cases;
    long least = 4000, largest = 0;
    for (const char* name : {"cold", "ambient", "hot"}) {
      const long cut = 1 + static_cast<long>(std::pow(4000, uniform(random))); // 1 to 4 digits
      least = std::min(least, cut), largest = std::max(largest, cut);
      cases.push_back({name, summarize(four_runs(), {})});
      cases.back().summary.runs = 4001;
      cases.back().summary.peaks.emplace().add(PeaksFinal::no, cut);
    }
    const std::string range =
        least == largest ? fmt::format("{}", least) : fmt::format("{} to {}", least, largest);
    CHECK_THAT(warnings(cases).at(0),
               Catch::StartsWith("in " + range + " of 4001 runs t_end cut the peaks: "));
  }
}

TEST_CASE("peaks of one kind that t_end cut are named, and latches that may let go after it") {
  const Results results =
      four_runs({PeaksFinal::moments, PeaksFinal::moments, PeaksFinal::yes, PeaksFinal::yes});
  Summary summary = summarize(results, {});
  summary.peaks = count_peaks_final(results);
  CHECK_THAT(warnings(summary).at(0),
             Catch::StartsWith("in 2 of 4 runs t_end cut the peak forces: "));
  CHECK(summary_json(summary, {})["peaks_final"] ==
        Json{{"true", 2}, {"false", 2}, {"missing", 0}, {"moments_cut", 0}, {"forces_cut", 2}});
  summary.peaks->add(PeaksFinal::no);
  CHECK_THAT(warnings(summary).at(0),
             Catch::StartsWith("in 3 of 4 runs t_end cut peaks (moments in 1, forces in 3): "));

  Results open(ResultNames{{}, {"root.latch_rate"}});
  open.append({0, Status::deployed, {}, {-1.}, "", std::string(latches_may_let_go)});
  open.append({1, Status::deployed, {}, {-1.}, "", ""});
  CHECK(warnings(summarize(open, {})) == std::vector{warn_of_open_latches(1, 2, "")});
}

TEST_CASE("a nominal run whose peaks t_end cut is told") {
  Summary summary;
  const auto told = [&](PeaksFinal final) {
    summary.nominal = NominalRun{Status::deployed, "root", "", final};
    const std::vector<std::string> lines = warnings(summary);
    return lines.empty() ? "" : lines.front();
  };
  CHECK(told(PeaksFinal::yes).empty());
  CHECK(told(PeaksFinal::unknown).empty());
  for (const auto& [final, kind] : {std::pair(PeaksFinal::no, "the peaks:"),
                                    {PeaksFinal::moments, "the peak forces:"},
                                    {PeaksFinal::forces, "the peak moments:"}})
    CHECK_THAT(told(final), Catch::Contains("nominal run") && Catch::Contains(kind));
}

TEST_CASE("nothing is warned of where there is nothing, or it was not recorded") {
  Results results(ResultNames{{}, {"root.latch_rate"}});
  results.append({0, Status::deployed, {}, {-1.}, "", ""});
  const Summary summary = summarize(results, {});
  CHECK(warnings(summary).empty());
  CHECK_FALSE(summary_json(summary, {}).contains("warnings"));
  CHECK_FALSE(summary_json(summary, {}).contains("peaks_final"));
}

TEST_CASE("a group is told in the table and in summary.json") {
  const Results results = four_runs();
  Summary summary = summarize(results, {});
  std::vector<Requirement> both(2, {"", "root.latch_rate", 0, {}, .2, .4});
  both[0].group = both[1].group = "rates";
  summary.requirements = judge_all(both, results);
  CHECK_THAT(summary_table(summary, "four", ""),
             Catch::Contains("  group rates: pass: 2 of 2 pass, joint confidence 40 %\n"));
  const Json json = summary_json(summary, {});
  CHECK(json["groups"][0] == Json{{"group", "rates"},
                                  {"confidence", .4},
                                  {"requirements", 2},
                                  {"passed", 2},
                                  {"verdict", "pass"}});
  CHECK(json["requirements"][1]["confidence_alone"].get<double>() == Approx(.7).epsilon(1e-15));
  CHECK(json["definitions"].contains("groups"));
}
