#include "montecarlo/results/summary/compact_table.hpp"
#include "montecarlo/results/summary/comparison.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

using namespace wingspread;

namespace {

/// Twenty runs of which so many are late, and one requirement on that.
CaseSummary case_of(const std::string& name, long late) {
  Results results(ResultNames{{}, {"deployment_time"}});
  for (long run = 0; run < 20; ++run)
    results.append({run, Status::deployed, {}, {run < late ? 9.0 : 5.0}, "root", ""});
  CaseSummary its{name, summarize(results, {})};
  its.summary.requirements =
      judge_all(std::vector<Requirement>{{"T-1", "deployment_time", 8.0, {}, 0.8, 0.9}}, results);
  return its;
}

/// The same requirement, decided otherwise.
CaseSummary decided(const std::string& name, Decision decision, std::optional<double> margin) {
  CaseSummary its = case_of(name, 0);
  its.summary.requirements[0].decision = decision;
  its.summary.requirements[0].margin = margin;
  return its;
}

} // namespace

TEST_CASE("a share beside 0 or 100 % shows its distance", "[comparison]") {
  CHECK(share_text(7.5e-8) == "0.0000075 %");
  CHECK(share_text(0.999999925) == "99.9999925 %");
  CHECK(share_text(0) == "0.000 %");
  CHECK(share_text(1) == "100.000 %");
  CHECK(share_text(0.5) == "50.000 %");
  CHECK(share_text(2e-5) == "0.002 %");
}

TEST_CASE("the worst case fails, or has the least margin", "[comparison]") {
  const CaseSummary pass = decided("a", Decision::pass, 1),
                    tight = decided("b", Decision::pass, 0.1),
                    open = decided("c", Decision::undecided, {}),
                    fail = decided("d", Decision::fail, -1);
  CHECK(worst_case({pass, tight}, 0) == 1);
  CHECK(worst_case({pass, open, tight}, 0) == 1);
  CHECK(worst_case({open, fail, pass}, 0) == 1);
  CHECK(worst_case({fail, decided("e", Decision::fail, {})}, 0) == 1); // beyond any number
  CHECK(worst_case({pass, decided("e", Decision::pass, 1)}, 0) == 0);
  // two of three allowed failures are worse than none, whatever the margins
  CaseSummary used = decided("f", Decision::pass, 2);
  used.summary.requirements[0].allowed = 3;
  used.summary.requirements[0].broken = {4, 7};
  CHECK(worst_case({tight, used, pass}, 0) == 1);
  // where no number may be proven: of 20 runs a fifth, so that three are more than two of three
  CaseSummary unproven = decided("g", Decision::pass, 2);
  unproven.summary.requirements[0].allowed.reset();
  unproven.summary.requirements[0].broken = {1, 2, 3};
  CHECK(worst_case({used, unproven}, 0) == 1);
  unproven.summary.requirements[0].broken = {1, 2};
  CHECK(worst_case({used, unproven}, 0) == 0);
  used.summary.requirements[0].broken = {4}; // and one of three too
  CHECK(worst_case({tight, used, pass}, 0) == 1);
}

TEST_CASE("a quantile that no case, or one case, lacks is shown among runs with a value",
          "[comparison]") {
  Results results(ResultNames{{}, {"deployment_time"}});
  for (long run = 0; run < 20; ++run)
    results.append({run, Status::stalled, {}, {run < 2 ? std::nan("") : 7.25}, "root", ""});
  CaseSummary stalls{"cold", summarize(results, {})};
  stalls.summary.requirements = case_of("cold", 0).summary.requirements;
  const std::string without = cases_table({case_of("hot", 0), case_of("warm", 3)}, "", "");
  CHECK_THAT(without, !Catch::Contains("among runs with a value"));
  const std::string with = cases_table({case_of("hot", 0), stalls}, "", "");
  const auto line = [&](const std::string& begin) {
    const std::size_t at = with.find('\n' + begin) + 1;
    return with.substr(at, with.find('\n', at) - at);
  };
  CHECK_THAT(line("  99 %  "), Catch::EndsWith("5.0000            –"));
  CHECK_THAT(line("  99 % among runs with a value"), Catch::EndsWith("5.0000       7.2500"));
  CHECK_THAT(with, !Catch::Contains("  1 % among"));
  const std::string note =
      "Quantiles are over all runs. Runs without a value rank above every value";
  CHECK_THAT(without, !Catch::Contains("Runs without a value"));
  CHECK_THAT(with, Catch::Contains(note + ".\n"));
  stalls.summary.outputs[0].missing_end = MissingRank::below;
  const std::string compact = compact_cases_table({stalls}, "", "");
  CHECK_THAT(compact, Catch::Contains("Runs without a value rank below every value") &&
                          Catch::Contains("in deployment_time. –:"));
}

TEST_CASE("cases.json has every requirement with its worst case, and every output by case",
          "[comparison]") {
  const Json json = cases_json({case_of("hot", 0), case_of("cold", 20)}, "about");
  CHECK(json["wingspread"] == "about");
  const Json& requirement = json["requirements"][0];
  CHECK(requirement["name"] == "T-1");
  CHECK(requirement["max"] == 8.0);
  CHECK(requirement["worst"] == "cold");
  CHECK(requirement["verdict"] == "fail");
  CHECK(requirement["cases"]["hot"]["verdict"] == "pass");
  CHECK(requirement["cases"]["cold"]["failures"]["seen"] == 20);
  CHECK(json["outputs"]["deployment_time"]["cold"]["mean"] == 9.0);
  CHECK(json["outputs"]["deployment_time"]["hot"]["mean"] == 5.0);
  CHECK(json["joint_confidence"] == Approx(0.8).epsilon(1e-15));
  CHECK(json["cases"]["cold"]["status"]["deployed"]["count"] == 20);
  CHECK_FALSE(json["cases"]["cold"].contains("partial"));
}

TEST_CASE("a group's members share its risk in every case", "[comparison]") {
  const auto grouped = [](const std::string& name, std::vector<Requirement> requirements) {
    Results results(ResultNames{{}, {"deployment_time"}});
    for (long run = 0; run < 200; ++run)
      results.append({run, Status::deployed, {}, {5.0 + 1e-3 * double(run)}, "root", ""});
    CaseSummary its{name, summarize(results, {})};
    its.summary.requirements = judge_all(requirements, results);
    return its;
  };
  std::vector<Requirement> requirements{{"T-1", "deployment_time", 8.0, {}, 0.8, 0.9},
                                        {"T-2", "deployment_time", 9.0, {}, 0.8, 0.9},
                                        {"T-3", "deployment_time", {}, 4.0, 0.9, 0.99}};
  const auto joint = [&](std::size_t count) {
    std::vector<CaseSummary> cases;
    for (std::size_t k = 0; k < count; ++k)
      cases.push_back(grouped("case " + std::to_string(k), requirements));
    const double own = joint_confidence(cases.front().summary.requirements);
    const double of_all = cases_json(cases, "about")["joint_confidence"].get<double>();
    CHECK(of_all == Approx(1 - static_cast<double>(count) * (1 - own)).epsilon(1e-12));
    return of_all;
  };
  CHECK(joint(1) == Approx(1 - 0.1 - 0.1 - 0.01).epsilon(1e-12));
  CHECK(joint(3) == Approx(1 - 3 * 0.21).epsilon(1e-12));
  requirements[0].group = requirements[1].group = "timing"; // 90 % for both together
  CHECK(joint(1) == Approx(1 - 0.1 - 0.01).epsilon(1e-12));
  CHECK(joint(3) == Approx(1 - 3 * 0.11).epsilon(1e-12));
}

TEST_CASE("cases.json and the table have each case's verdict on a group", "[comparison]") {
  std::vector<CaseSummary> cases{case_of("cold", 20), case_of("hot", 0)};
  std::vector<Verdict> verdicts{cases[0].summary.requirements[0], cases[1].summary.requirements[0]};
  for (Verdict& each : verdicts) each.requirement.group = "timing";
  cases[0].summary.requirements = {verdicts[0], verdicts[1]}; // one of two fails
  cases[1].summary.requirements = {verdicts[1], verdicts[1]};
  for (Verdict& each : cases[0].summary.requirements) each.requirement.group = "timing";
  const Json json = cases_json(cases, "about")["cases"];
  CHECK(json["cold"]["groups"][0]["verdict"] == "fail");
  CHECK(json["hot"]["groups"][0]["verdict"] == "pass");
  const std::string table = cases_table(cases, "title", "folder");
  const auto line = table.substr(table.find("  group timing, 90 %"), 100);
  CHECK(line.find("fail") < line.find("pass"));
  CHECK(line.find("pass") < line.find('\n'));
}

TEST_CASE("cases stand side by side", "[comparison]") {
  std::vector<CaseSummary> cases{case_of("hot", 0), case_of("cold", 20)};
  cases[1].summary.nominal = NominalRun{Status::deployed, "root", ""};
  cases[1].summary.outputs[0].nominal = 7.5;
  CHECK(cases_table(cases, "title", "out") ==
        "title\n"
        "\nOUTCOME                                                 hot         cold\n"
        "  runs                                                   20           20\n"
        "  deployed                                        100.000 %    100.000 %\n"
        "  stalled                                           0.000 %      0.000 %\n"
        "  timed out                                         0.000 %      0.000 %\n"
        "  invalid                                           0.000 %      0.000 %\n"
        "  failed                                            0.000 %      0.000 %\n"
        "  the nominal wing                                        –     deployed\n"
        "\nOUTPUT                                                  hot         cold\n"
        "deployment_time, s\n"
        "  nominal                                                 –       7.5000\n"
        "  mean                                               5.0000       9.0000\n"
        "  1 %                                                5.0000       9.0000\n"
        "  99 %                                               5.0000       9.0000\n"
        "\nREQUIREMENT, runs that break it / allowed               hot         cold\n"
        "T-1: deployment_time ≤ 8 s, 80 % at 90 %\n"
        "  worst: cold                                          pass         fail\n"
        "                                                      0 / 1       20 / 1\n"
        "\nFILES  out: cases.json, and a results folder for each case\n");
  cases[0].partial = true;
  cases[0].name = "a_case_with_a_long_name";
  while (cases.size() < 5) cases.push_back(cases[1]);
  const std::string more = cases_table(cases, "title", "out");
  const auto cells = [&](const std::string& begin) { // in all lines that begin so
    std::size_t count = 0;
    std::istringstream in(more);
    for (std::string line; std::getline(in, line);)
      if (std::istringstream words(line.substr(std::min(begin.size(), line.size())));
          line.starts_with(begin))
        count += std::distance(std::istream_iterator<std::string>(words), {});
    return count;
  };
  CHECK(cells("OUTCOME") == 5); // each case once, in two blocks
  CHECK(cells("  runs ") == 5);
  CHECK_THAT(more, Catch::Contains(" a_case_with_a_long_name"));
  CHECK_THAT(more, Catch::Contains("\na_case_with_a_long_name lacks runs of the campaign\n"));
}
