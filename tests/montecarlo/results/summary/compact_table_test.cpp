#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/results/summary/compact_table.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Twenty runs of a wing whose root latches later by `delay`, and whose overtravel is the same everywhere.
CaseSummary compact_case(const std::string& name, double delay, double overtravel = 0) {
  Results results(ResultNames{{}, {"root.latch_time", "root.peak_moment", "root.overtravel"}});
  for (long run = 0; run < 20; ++run)
    results.append({run,
                    run == 3 && delay > 0 ? Status::stalled : Status::deployed,
                    {},
                    {5 + delay + 0.01 * static_cast<double>(run), 100, overtravel},
                    "root",
                    ""});
  CaseSummary made{name, summarize(results, {})};
  made.summary.requirements =
      judge_all(std::vector<Requirement>{{"T-1", "root.latch_time", 8.0, {}, 0.8, 0.9}}, results);
  return made;
}

} // namespace

TEST_CASE("cases have a line for each output, with its outermost quantiles, and for each verdict") {
  const std::string table =
      compact_cases_table({compact_case("hot", 0), compact_case("cold", 4, 0.001)}, "title", "out");
  CHECK(table ==
        "title\n"
        "\nOUTCOME                                                  hot                cold\n"
        "  runs                                                    20                  20\n"
        "  deployed                                         100.000 %            95.000 %\n"
        "  stalled                                            0.000 %             5.000 %\n"
        "  timed out, invalid, failed                               0                   0\n"
        "  the nominal wing                                         –                   –\n"
        "\nOUTPUT, 1 % and 99 %                                     hot                cold\n"
        "  root.latch_time               s                5      5.19         9      9.19\n"
        "\nREQUIREMENT, broken / allowed                            hot                cold\n"
        "  T-1: root.latch_time ≤ 8 s, 80 % at 90 %\n"
        "                                                  pass 0 / 1         fail 20 / 1\n"
        "\n  overtravel (backwards, beyond stowed) of root: at most 0.0573 deg\n"
        "  the same in every run: root.peak_moment = 100 N·m\n"
        "\nFILES  out: cases.json, and a results folder for each case; --all prints every "
        "statistic\n");
}

TEST_CASE(
    "an output that is constant in each case, but not the same or not there in all, has its line") {
  const auto made = [](const char* name, double peak) {
    Results results(ResultNames{{}, {"root.latch_time", "root.peak_moment"}});
    for (long run = 0; run < 20; ++run)
      results.append({run, Status::deployed, {}, {5, peak}, "root", ""});
    return CaseSummary{name, summarize(results, {})};
  };
  const auto table_with = [&](double peak) {
    return compact_cases_table({made("soft", peak), made("stiff", 100)}, "title", "out");
  };
  CHECK_THAT(table_with(100),
             Catch::Contains("every run: root.latch_time = 5 s, root.peak_moment = 100 N·m\n"));
  for (const double peak : {50.0, std::nan("")}) {
    const std::string table = table_with(peak);
    CAPTURE(table);
    CHECK_THAT(table, Catch::Contains("every run: root.latch_time = 5 s\n"));
    CHECK_THAT(table, Catch::Contains("\n  root.peak_moment"));
  }
}

TEST_CASE("a nominal wing that does not deploy has its case and its reason") {
  std::vector<CaseSummary> cases{compact_case("hot", 0), compact_case("cold", 4)};
  for (CaseSummary& each : cases) each.summary.nominal = NominalRun{Status::deployed, "root", ""};
  cases[1].summary.nominal = NominalRun{Status::stalled, "", "root was never released"};
  CHECK_THAT(compact_cases_table(cases, "title", "out"),
             Catch::Contains("deployed             stalled\n    cold: root was never released\n"));
}

TEST_CASE("the accuracy of cases is that of the worst one") {
  std::vector<CaseSummary> cases{compact_case("hot", 0), compact_case("cold", 4)};
  CHECK(compact_cases_table(cases, "title", "out").find("ACCURACY") == std::string::npos);
  const auto with_error = [](double largest) {
    Accuracy made;
    made.runs = 10;
    made.outputs.assign(3, {"root.latch_time", 10, largest, largest});
    return made;
  };
  for (CaseSummary& each : cases)
    for (OutputSummary& output : each.summary.outputs) output.mean_error = 1e-3;
  cases[0].summary.accuracy = with_error(1e-6), cases[1].summary.accuracy = with_error(3e-6);
  CHECK_THAT(compact_cases_table(cases, "title", "out"),
             Catch::Contains("\nACCURACY  cold: integration errors ≤ 0.3 % of a standard error"));
}

TEST_CASE("an output is shown if it varies in any case, and lines keep within the width") {
  std::vector<CaseSummary> cases{compact_case("hot", 0), compact_case("cold", 0, 0.02)};
  cases[0].partial = true;
  while (cases.size() < 7) cases.push_back(compact_case("a_long_name_of_a_case", 1));
  const std::string table = compact_cases_table(cases, "title", "out");
  CHECK_THAT(table, Catch::Contains("\n  root.overtravel "));
  CHECK_THAT(table, Catch::Contains("\nhot lacks runs of the campaign\n"));
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) {
    INFO(line);
    CHECK(count_characters(line) <= table_width + 6); // names of cases stand as they are
  }
}

TEST_CASE("an output that varies in any one case has its line in every block of cases") {
  const auto count = [](const std::string& text, const std::string& part) {
    long found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  for (std::size_t varied = 0; varied < 9; ++varied) {
    std::vector<CaseSummary> cases;
    for (std::size_t k = 0; k < 9; ++k)
      cases.push_back(compact_case("case_" + std::to_string(k), 0, k == varied ? 0.02 : 0));
    const std::string table = compact_cases_table(cases, "title", "out");
    const long blocks = count(table, "\nOUTPUT, ");
    CHECK(blocks > 1);
    CHECK(count(table, "\n  root.overtravel ") == blocks);
    cases[varied] = compact_case("case", 0, 0);
    CHECK(count(compact_cases_table(cases, "title", "out"), "\n  root.overtravel ") == 0);
  }
}

TEST_CASE("without a standard error the accuracy says why") {
  CaseSummary made = compact_case("hot", 0);
  Summary& summary = made.summary;
  summary.accuracy.emplace().runs = 10;
  summary.accuracy->outputs.assign(3, {"root.latch_time", 10, 1e-6, 1e-6});
  for (OutputSummary& output : summary.outputs) output.mean_error = none;
  summary.replicates = 1;
  CHECK_THAT(accuracy_text(summary, false), Catch::Contains("one replicate") &&
                                                Catch::Contains("two or more") &&
                                                !Catch::Contains("does not vary"));
  summary.replicates = 0;
  CHECK_THAT(accuracy_text(summary, false), Catch::Contains("does not vary"));
}

TEST_CASE("runs without a value are said to rank once, with the outputs of each end") {
  const auto text = [](const std::vector<MissingRank>& ends) {
    std::vector<OutputSummary> outputs;
    for (const MissingRank end : ends) {
      outputs.emplace_back();
      outputs.back().name = "o" + std::to_string(outputs.size());
      outputs.back().missing = 1, outputs.back().missing_end = end;
    }
    return missing_ranks(outputs);
  };
  using enum MissingRank;
  CHECK(text({}) == "");
  CHECK(text({above}) == "Runs without a value rank above every value");
  CHECK(text({below}) == "Runs without a value rank below every value in o1");
  for (const auto& ends :
       std::vector<std::vector<MissingRank>>{{either}, {above, either}, {below, either, above}}) {
    const std::string said = text(ends);
    CAPTURE(said);
    CHECK(said.find("above every value") == said.rfind("above every value"));
    const auto place = std::ranges::find(ends, either) - ends.begin() + 1;
    CHECK(said.find("in o" + std::to_string(place) + " bounds hold for both ends") !=
          std::string::npos);
    CHECK((said.find("below every value in o1") != std::string::npos) == (ends.size() == 3));
  }
}

TEST_CASE("an integration error that no reference could measure is said to be unknown") {
  std::vector<CaseSummary> cases{compact_case("hot", 0), compact_case("cold", 0)};
  for (CaseSummary& each : cases) each.summary.accuracy.emplace().runs = 10;
  Accuracy& unknown = cases[1].summary.accuracy.emplace();
  unknown.unreached = 3;
  for (const bool all : {true, false})
    CHECK_THAT(accuracy_text(cases[1].summary, all),
               Catch::Contains("ACCURACY  unknown") &&
                   Catch::Contains(": 3 runs without a reference"));
  CHECK_THAT(compact_cases_table(cases, "title", "out"),
             Catch::Contains("\nACCURACY  cold: unknown"));
}
