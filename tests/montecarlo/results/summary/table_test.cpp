#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/results/summary/table.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

/// The text without the line breaks of a paragraph that starts in column 10.
std::string unwrapped(std::string text) {
  const std::string indent = "\n" + std::string(10, ' ');
  for (auto at = text.find(indent); at != std::string::npos; at = text.find(indent))
    text.replace(at, indent.size(), " ");
  return text;
}

/// A text with each line break and the blanks after it as one blank.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text)
    if (const char as = c == '\n' ? ' ' : c; as != ' ' || !line.ends_with(' ')) line += as;
  return line;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Results some_results() {
  Results results(ResultNames{{"k"},
                              {"root.latch_time", "root.rate_at.a_hinge_with_a_long_name",
                               "tip.peak_moment", "deployment_time"}});
  for (long run = 0; run < 100; ++run) {
    const bool stalls = run % 10 == 9;
    const double x = static_cast<double>(run);
    results.append({run,
                    stalls ? Status::stalled : Status::deployed,
                    {x},
                    {stalls ? none : 10 + x / 100, -1.23456e-7 * x, 1e6 + x, stalls ? none : 12},
                    stalls ? "" : "root>tip",
                    stalls ? "friction holds bodies.panel_1" : ""});
  }
  return results;
}

} // namespace

TEST_CASE("the table shows outcomes, reasons, latch orders, outputs by hinge, and the files") {
  const std::string table =
      summary_table(summarize(some_results(), {}), "three_panel, 100 runs", "out");
  for (const char* part : {"three_panel, 100 runs\n",
                           "OUTCOME",
                           "95 % bounds",
                           "deployed",
                           "timed out",
                           "90.000 %",
                           "82.378 – 95.100 %",
                           "friction holds bodies.panel_1",
                           "LATCH ORDER",
                           "root>tip",
                           "no latch",
                           "mean",
                           "std",
                           "1 %",
                           "median",
                           "99 %",
                           "\nroot\n  latch time",
                           "N·m",
                           "\ntip\n",
                           "\nwing\n",
                           "over the runs in which the output happened, of 100.",
                           "NO QUANTILE over all runs",
                           "without a value rank above every value.\n",
                           "deployment_time: 90 of 100 runs have a value; the others",
                           "99 % 12.000 s",
                           "FILES  out: runs.csv, summary.json, histograms.json, histograms.csv\n"})
    CHECK_THAT(table, Catch::Contains(part));
  CHECK_THAT(table, Catch::Contains("  stalled" + std::string(49, ' ') + "10    10.000 %"));
}

TEST_CASE("the table stays within its width and leaves no blanks behind") {
  StatisticsSpec spec;
  spec.quantiles = {0.00135, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.99865};
  Results results = some_results();
  results.append({100,
                  Status::failed,
                  {0},
                  {none, none, none, none},
                  "tip>root",
                  "it took more steps, one after the other, than anybody had thought of, and then "
                  "some more of them"});
  const std::string table = summary_table(summarize(results, spec), "a title", "");
  for (const std::string& line : lines(table)) {
    INFO(line);
    CHECK(count_characters(line) <= table_width);
    CHECK((line.empty() || line.back() != ' '));
  }
  CHECK(contains(table, "99.865 %"));
  CHECK_THAT(table, Catch::Contains("than anybody had thought of, and then\n" +
                                    std::string(22, ' ') + "some more of them\n"));
  CHECK_FALSE(contains(table, "FILES"));
}

TEST_CASE("no name is cut off: one that has no room has a line of its own") {
  const std::string order(120, 'o'), hinge(110, 'h');
  Results results(ResultNames{{}, {hinge + ".latch_time", "root.rate_at." + hinge}});
  results.append({0, Status::failed, {}, {1, 2}, order, std::string(90, 'r')});
  Summary summary = summarize(results, {});
  summary.requirements = judge_all(
      std::vector<Requirement>{{std::string(60, 'n'), hinge + ".latch_time", 3.0, {}, 0.9, 0.9}},
      results);
  const std::string table = summary_table(summary, std::string(150, 't'), "");
  CHECK_FALSE(contains(table, "…"));
  CHECK(contains(table, std::string(150, 't') + "\n"));
  CHECK(contains(table, "  " + order + "\n" + std::string(50, ' ') + "         1"));
  CHECK(contains(table, "\n" + hinge + "\n  latch time"));
  CHECK(contains(table, "  rate at " + hinge + "\n" + std::string(19, ' ') + "rad/s "));
  CHECK(contains(table, "  failed           1  " + std::string(90, 'r') + "\n"));
  CHECK(contains(table, "  " + std::string(60, 'n') + ": " + hinge +
                            ".latch_time ≤ 3 s, 90 % at 90 %\n" + std::string(46, ' ') + "fail"));
}

TEST_CASE("the nominal run stands beside the statistics") {
  Summary summary = summarize(some_results(), {});
  CHECK_FALSE(contains(summary_table(summary, "", ""), "nominal"));
  summary.nominal = NominalRun{Status::timed_out, "root", "t_end came first"};
  for (OutputSummary& output : summary.outputs) output.nominal = none;
  summary.outputs[0].nominal = 10.5;
  const std::string table = summary_table(summary, "", "");
  CHECK(contains(table, "\n  the nominal wing" + std::string(32, ' ') +
                            "timed out\n    t_end came first\n"));
  CHECK(contains(table, "OUTPUT             unit       runs    nominal       mean"));
  CHECK(contains(table, "  latch time       s            90     10.500     10.490"));
  CHECK(contains(table, "  deployment time  s            90          –     12.000"));
}

TEST_CASE("the table of nothing is still a table") {
  const std::string table = summary_table(summarize(Results(ResultNames{{}, {}}), {}), "none", "");
  CHECK(contains(table, "deployed"));
  CHECK_FALSE(contains(table, "nan"));
  CHECK_FALSE(contains(table, "OUTPUT"));
}

TEST_CASE("the table counts the latch orders and reasons that it leaves out") {
  Results results(ResultNames{{}, {}});
  for (long run = 0; run < 12; ++run)
    results.append({run,
                    Status::invalid,
                    {},
                    {},
                    "order" + std::to_string(run),
                    "reason" + std::to_string(run)});
  const std::string table = summary_table(summarize(results, {}), "", "");
  CHECK(contains(table, "and 4 other reasons, in summary.json"));
  CHECK(contains(table, "4 other orders" + std::string(43, ' ') + "4    33.333 %"));
  const std::string whole = summary_table(summarize(results, {}), "", "", true);
  CHECK_FALSE(contains(whole, "other"));
  for (long run = 0; run < 12; ++run)
    for (const char* name : {"  order", "  reason"})
      CHECK(contains(whole, name + std::to_string(run)));
}

TEST_CASE("the table shows what the campaign asks for, and which runs to look at") {
  const Results results = some_results();
  Summary summary = summarize(results, {});
  const Requirement peak{"", "tip.peak_moment", 2e6, {}, .8, .9},
      deploys{"", "deployed", {}, {}, .99, .9};
  summary.requirements = {judge(peak, results), judge(deploys, results)};
  summary.outputs[2].tolerance_limits = {{{.95, .9, Side::upper}, {{}, 1000098.}}};
  summary.until = {{WidthGoal{"deployed", {}, .01, false}, .127, false},
                   {DecisionGoal{"T-1"}, {}, true}};
  const std::string table = summary_table(summary, "t", "out");
  for (const char* part :
       {"  tip.peak_moment ≤ 2000000 N·m, 80 % at 90 % pass            10      14   1.0001e+06",
        "  deployed, 99 % at 90 %                      fail            10       –     90.000 %",
        "    10 of 100 runs break it: disproved\n",
        "    wingspread replay out --run 9   and 19, 29, 39, 49, 59, …\n",
        "  tip.peak_moment                           95 % at 90 %", "STOPPING GOAL, interval width",
        "  deployed 0.01",
        "  requirement T-1                                                      decided"})
    CHECK_THAT(table, Catch::Contains(part));
  for (const std::string& line : lines(table)) CHECK(count_characters(line) <= table_width);
  CHECK_THAT(table, !Catch::Contains("oint confidence"));
  summary.requirements[1] = summary.requirements[0];
  CHECK_THAT(summary_table(summary, "t", "out"),
             Catch::Contains("  Joint confidence of 2 requirements: at least 80 %.\n"));
}

TEST_CASE("a requirement's values have the unit of its limit") {
  Results results(ResultNames{{"k"}, {"tip.latch_rate"}});
  for (long run = 0; run < 100; ++run) {
    const double rate = static_cast<double>(run) * std::numbers::pi / 180; // run deg/s
    results.append({run, Status::deployed, {0.}, {rate}, "tip", ""});
  }
  Summary summary = summarize(results, {});
  const Requirement in_degrees{"", "tip.latch_rate", std::numbers::pi / 3, {}, .5, .9},
      in_radians{"", "tip.latch_rate", 1.5, {}, .5, .9};
  summary.requirements = {judge(in_degrees, results), judge(in_radians, results)};
  const std::string table = summary_table(summary, "t", "");
  // 60 runs keep to 60 deg/s. The largest of the lower half turns at 49 deg/s; by P(Bin(100, 1/2) ≤ 43) ≤ 0.1, 43 may be above
  CHECK_THAT(table,
             Catch::Contains("  tip.latch_rate ≤ 60 deg/s, 50 % at 90 %     pass            39"
                             "      43       49.000       56.000"));
  CHECK_THAT(table,
             Catch::Contains("  tip.latch_rate ≤ 1.5 rad/s, 50 % at 90 %    pass            14"
                             "      43      0.85521      0.97739"));
}

TEST_CASE("a guaranteed share never reads as more than it is, nor as short of what it shows") {
  Verdict verdict;
  verdict.requirement = {"", "deployed", {}, {}, .9973, .9};
  verdict.runs = 851;
  const auto shown = [&](double guaranteed, double required) {
    verdict.guaranteed_share = guaranteed, verdict.requirement.probability = required;
    return guaranteed_text(verdict);
  };
  CHECK(shown(0.99729792, .9973) == "99.729 %"); // not 99.73 %
  CHECK(shown(0.9973004, .9973) == "99.730 %");
  CHECK(shown(0.99999971, .9999966) == "99.9999 %"); // is enough, and reads so
  CHECK(shown(0.9999961, .9999966) == "99.999 %");
  CHECK(shown(undefined, .9973) == "–");
}

TEST_CASE("tolerance limits say by which rule runs rank, and why there is none") {
  Summary summary = summarize(some_results(), {});
  const auto table = [&] { return summary_table(summary, "t", "out"); };
  summary.outputs[2].tolerance_limits = {{{.95, .9, Side::lower}, {2., {}}}};
  CHECK_FALSE(contains(table(), "Limits are over all runs"));
  CHECK_THAT(table(), Catch::Contains("          2.0000\n")); // no mark for an upper limit
  summary.outputs[2].tolerance_limits = {{{.95, .9, Side::lower}, {}, 10},
                                         {{.95, .9, Side::upper}, {}, 10},
                                         {{.9999, .9, Side::upper}, {}, 10}};
  summary.outputs[0].tolerance_limits = {{{.95, .9, Side::upper}, {{}, 7.}, 1},
                                         {{.9999, .9, Side::upper}, {}, 1}};
  const std::string first = summary.outputs[0].name, third = summary.outputs[2].name;
  CHECK_THAT(table(),
             Catch::Contains("  –: 10 of 100 runs rank beyond every number; at most 1 may (" +
                             third + ")\n"));
  CHECK_THAT(table(), Catch::Contains("  –: 100 runs are too few: it takes 23025 (" + first + ", " +
                                      third + ")\n"));
  CHECK_THAT(table(), Catch::Contains("\n  Limits are over all runs") &&
                          Catch::Contains("worse than any value") && Catch::Contains("lower one"));
  for (const std::string& line : lines(table())) CHECK(count_characters(line) <= table_width);
}

TEST_CASE("without a standard error the integration's errors are compared with the values") {
  Results results(ResultNames{{}, {"root.latch_time", "base.peak_angle"}});
  for (long run = 0; run < 20; ++run) results.append({run, Status::deployed, {}, {4, 0}, "", ""});
  Summary summary = summarize(results, {});
  summary.accuracy =
      Accuracy{.runs = 10,
               .method = "auto",
               .rtol = 1e-8,
               .reference_method = "dopri5",
               .reference_rtol = 1e-10,
               .in_doubt = {},
               .moved = {},
               .outputs = {{"root.latch_time", 10, 8e-9, 4e-9}, {"base.peak_angle", 10, 0, 0}}};
  const auto line = [&] { return unwrapped(summary_table(summary, "t", "out")); };
  CHECK_THAT(line(), Catch::Contains("\nACCURACY  integration errors ≤ 2e-07 % of a value without "
                                     "standard error (it does not vary) in ≥ 74.1 %"));
  summary.accuracy->outputs[0].largest = 0; // all exact
  CHECK_THAT(line(), Catch::Contains("errors ≤ 0 % of a value without"));
  std::swap(summary.outputs[0].moments, summary.outputs[1].moments); // and where the value is 0
  summary.accuracy->outputs.resize(1);
  CHECK_THAT(line(), Catch::Contains("errors ≤ 0 % of a value without"));
  summary.outputs[0].moments.mean = -0.25; // of any sign and size
  summary.accuracy->outputs[0].largest = 5e-10;
  CHECK_THAT(line(), Catch::Contains("errors ≤ 2e-07 % of a value without"));
  std::swap(summary.outputs[0].moments, summary.outputs[1].moments);
  summary.outputs[1].moments.mean = 0;
  summary.accuracy->outputs = {{"root.latch_time", 10, 8e-9, 4e-9},
                               {"base.peak_angle", 10, 3e-12, 1e-12}};
  CHECK_THAT(line(), Catch::Contains("3e-12 rad of base.peak_angle, which is 0"));
  summary.one_run = true;
  CHECK_THAT(line(), Catch::Contains(" in all 20 runs\n"));
  summary.runs = 1, summary.accuracy->runs = 1;
  summary.outputs[0].mean_error = std::nan("");
  CHECK_THAT(line(), Catch::Contains("(a single run)") && Catch::Contains(" in the only run\n"));
}

TEST_CASE("the table says what the integration contributes") {
  Summary summary = summarize(some_results(), {});
  CHECK_FALSE(contains(summary_table(summary, "t", "out", true), "ACCURACY"));
  summary.outputs[0].mean_error = 0.02;
  summary.accuracy = Accuracy{.runs = 10,
                              .method = "auto",
                              .rtol = 1e-8,
                              .reference_method = "dopri5",
                              .reference_rtol = 1e-11,
                              .in_doubt = {},
                              .moved = {},
                              .unreached = 0,
                              .outputs = {{"root.latch_time", 9, 1.26e-9, 4e-10},
                                          {"root.rate_at.a_hinge_with_a_long_name", 0, none, none},
                                          {"tip.peak_moment", 10, 0, 0},
                                          {"deployment_time", 9, 0.5, 0.25}}};
  const std::vector<std::string> all = lines(summary_table(summary, "t", "out", true));
  const auto begin = std::ranges::find_if(
      all, [](const std::string& line) { return line.starts_with("ACCURACY"); });
  REQUIRE(all.end() - begin > 8);
  CHECK(begin[0] == "ACCURACY of the integration           unit   largest error     RMS error "
                    "std error of mean     ratio");
  const auto blanks = [](std::size_t count) { return std::string(count, ' '); };
  CHECK(begin[1] == "  root.latch_time" + blanks(21) + "s" + blanks(12) + "1.3e-09" + blanks(9) +
                        "4e-10" + blanks(14) + "0.02" + blanks(3) + "2e-06 %");
  CHECK(begin[3].starts_with(blanks(38) + "rad/s" + blanks(14) + "–"));
  const std::string table = summary_table(summary, "t", "out", true);
  CHECK(contains(table, "  10 of 100 runs, drawn at random, repeated by dopri5 at rtol 1e-11"));
  CHECK((contains(table, "25.89 %") && contains(table, "differs: none.")));
  summary.accuracy->in_doubt = {17, 40};
  summary.accuracy->moved = {5};
  summary.accuracy->unreached = 3;
  // Clopper and Pearson's upper bounds, one-sided: of 5 and of 6 in 13, with those in doubt and not finished
  CHECK_THAT(
      on_one_line(summary_table(summary, "t", "out", true)),
      Catch::Contains("by dopri5 at rtol 1e-11 (campaign: auto at 1e-08)") &&
          Catch::Contains("At most 64.53 % of all runs have an error beyond") &&
          Catch::Contains("at most 71.30 % an output that moves by more than 1 % (95 % conf") &&
          Catch::Contains("move so: 5. Runs") && Catch::Contains("differs: 17, 40.") &&
          Catch::Contains("could not finish 3 more."));
  summary.accuracy->moved.clear();
  // Without --all it is a line.
  const auto line = [&] { return summary_table(summary, "t", "out"); };
  CHECK_THAT(line(),
             Catch::Contains("\nACCURACY  integration errors ≤ 6e-06 % of a standard error, ≤ "));
  CHECK_THAT(line(), Catch::Contains("2 of 10 repeated end otherwise") &&
                         Catch::Contains("3 of 10 repeated"));
  summary.accuracy->in_doubt.clear();
  summary.accuracy->unreached = 0;
  summary.accuracy->outputs.resize(3);
  CHECK_THAT(line(), Catch::Contains(
                         "\nACCURACY  integration errors ≤ 6e-06 % of a standard error in ≥ 74.1 % "
                         "of runs (95 % confidence)\n"));
  summary.accuracy->outputs[0].largest = 0.0003;
  summary.accuracy->moved = {4};
  CHECK_THAT(line(), Catch::Contains("≤ 1 % of a standard error") ||
                         Catch::Contains("≤ 2 % of a standard error"));
  CHECK_THAT(line(), Catch::Contains("repeated moves by more than 1 %"));
  CHECK_FALSE(contains(line(), "largest error"));
}

TEST_CASE("outcomes that no run has share a line, and outputs that never vary") {
  Results results(
      ResultNames{{}, {"root.latch_time", "root.overtravel", "tip.overtravel", "tip.peak_moment"}});
  for (long run = 0; run < 20; ++run)
    results.append(
        {run, Status::deployed, {}, {10.0 + static_cast<double>(run), 0, 0.001, 7}, "root", ""});
  const Summary summary = summarize(results, {});
  const std::string table = summary_table(summary, "t", "");
  CHECK(contains(table, "\n  stalled, timed out, invalid, failed" + std::string(22, ' ') +
                            "0     0.000 %"));
  CHECK(contains(table,
                 "\n  overtravel (backwards, beyond stowed) of root, tip: at most 0.0573 deg\n"));
  CHECK(contains(table, "\n  the same in every run: tip.peak_moment = 7 N·m\n"));
  CHECK_FALSE(contains(table, "\ntip\n"));
  const std::string all = summary_table(summary, "t", "", true);
  CHECK(contains(all, "\n  timed out "));
  CHECK(contains(all, "\ntip\n  overtravel"));
  CHECK_FALSE(contains(all, "the same in every run"));
}
