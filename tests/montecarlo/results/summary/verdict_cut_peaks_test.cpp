// Verdicts on outputs without a value, and on peaks that t_end cut.
#include "montecarlo/results/summary/broken_runs.hpp"
#include "montecarlo/results/summary/verdict.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a run whose peak t_end cut is beyond every number for a limit of the peak") {
  Results results(ResultNames{{}, {"root.peak_moment", "root.latch_time"}, true});
  for (long run = 0; run < 59; ++run)
    results.append({run,
                    Status::deployed,
                    {},
                    {1.0 + static_cast<double>(run), 5},
                    "",
                    "",
                    run == 7 ? PeaksFinal::no : PeaksFinal::yes});
  const RankedOutput peak(results, results.outputs[0]), time(results, results.outputs[1]);
  CHECK((peak.beyond() == 1 && time.beyond() == 0));
  CHECK_FALSE(output_limits(peak, {.95, .95, Side::upper}).upper);
  CHECK(output_limits(time, {.95, .95, Side::upper}).upper == 5);
}

TEST_CASE("evidence counts the runs that break an output's limit for they have no value") {
  Results results(ResultNames{{}, {"root.latch_time"}, true});
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (long run = 0; run < 1000; ++run) {
    const Status status = run < 2 ? Status::stalled : Status::deployed;
    const double value = run < 3 ? none : static_cast<double>(run);
    results.append({run, status, {}, {value}, "", "", PeaksFinal::yes});
  }
  const Requirement late{"", "root.latch_time", 998.5, {}, .99, .9};
  CHECK(judge(late, results).absent == 3);
  CHECK(evidence(judge(late, results)) ==
        "4 of 1000 runs break it (3 of them because they did not deploy or have no value); at most "
        "5 may");
  const Requirement deployed{"", "deployed", {}, {}, .99, .9}; // says so itself
  CHECK((judge(deployed, results).failures() == 2 && judge(deployed, results).absent == 0));
}

TEST_CASE("a peak that t_end cut breaks every max on it, whatever it had come to") {
  Results results(ResultNames{{}, {"root.peak_moment", "root.latch_time"}, true});
  for (long run = 0; run < 1000; ++run) {
    const auto value = static_cast<double>(run + 1);
    results.append({run,
                    Status::deployed,
                    {},
                    {value, value},
                    "",
                    "",
                    run < 3 ? PeaksFinal::no : PeaksFinal::yes});
  }
  Requirement peak{"", "root.peak_moment", 1001, {}, .99, .9};
  const Verdict verdict = judge(peak, results);
  CHECK(verdict.broken == std::vector<long>{0, 1, 2});
  CHECK(verdict.cut == 3);
  CHECK(evidence(verdict) ==
        "3 of 1000 runs break it (3 of them because t_end cut their peaks); at most "
        "5 may");
  peak.max.reset();
  peak.min = 0; // it can only rise
  CHECK((judge(peak, results).broken.empty() && judge(peak, results).cut == 0));
  peak.output = "root.latch_time"; // that one stands, wherever the run ends
  CHECK((judge(peak, results).broken.empty() && judge(peak, results).cut == 0));
  const RankedOutput ranks(results, results.outputs[0]);
  CHECK((ranks.numbers().size() == 997 && std::isinf(ranks.worst_above().back())));
}

// A cut peak below the limit may still rise or stay: it is no evidence against the requirement.
TEST_CASE("cut peaks below the limit disprove nothing, and only what is known makes a fail") {
  std::mt19937_64 random(5);
  const auto below = [&](long most) {
    return static_cast<long>(uniform(random) * static_cast<double>(most + 1));
  };
  for (int k = 0; k < 300; ++k) {
    const long n = 1 + below(200), cut = below(n), beyond = below(n - cut) / 4;
    Results open(ResultNames{{}, {"root.peak_moment"}, true}), known = open;
    for (long run = 0; run < n; ++run) {
      ResultRow row{run, Status::deployed, {}, {run < cut + beyond ? 1.0 : 0.5}, "", ""};
      row.peaks_final = run < cut ? PeaksFinal::no : PeaksFinal::yes;
      if (run < cut) row.outputs[0] = 0.5;
      open.append(row);
      row.peaks_final = PeaksFinal::yes;
      known.append(row);
    }
    const Requirement requirement{"", "root.peak_moment", 0.75, {}, 0.9, 0.9};
    const Verdict verdict = judge(requirement, open), other = judge(requirement, known);
    CAPTURE(n, cut, beyond);
    CHECK(verdict.failures() == cut + beyond);
    CHECK(verdict.disproved == other.disproved);
    CHECK((verdict.decision == Decision::fail) == (other.decision == Decision::fail));
  }
}

TEST_CASE("the runs that break a requirement are counted in each earlier analysis, known or not") {
  std::mt19937_64 random(6);
  const InterimAnalyses interim{1, {8, 20, 33}};
  for (int k = 0; k < 50; ++k) {
    Results results(ResultNames{{}, {"root.peak_moment"}, true});
    std::vector<long> failed(3, 0), surely(3, 0);
    for (long run = 0; run < 60; ++run) {
      const bool is_cut = uniform(random) < 0.3, is_beyond = uniform(random) < 0.3;
      ResultRow row{run, Status::deployed, {}, {is_beyond ? 1.0 : 0.5}, "", ""};
      row.peaks_final = is_cut ? PeaksFinal::no : PeaksFinal::yes;
      results.append(row);
      for (std::size_t n = 0; n < 3; ++n) {
        failed[n] += run < interim.before[n] && (is_cut || is_beyond);
        surely[n] += run < interim.before[n] && is_beyond;
      }
    }
    const Requirement requirement{"", "root.peak_moment", 0.75, {}, 0.6, 0.9};
    const Verdict verdict = judge(requirement, results, interim);
    CHECK(verdict.failed_before == failed);
    CHECK(verdict.surely_before == surely);
    CHECK(verdict.allowed == passing_rule(interim, 60, 0.6, 0.9, failed).allowed);
    CHECK(verdict.disproved ==
          is_disproved(interim, 60, 0.6, 0.9, verdict.failures() - verdict.open, surely));
  }
}

// The same with the peak turned round: what t_end cut below a min may still rise to it, and shows nothing.
TEST_CASE("a cut peak meets a min that it has reached, and disproves none that it has not") {
  std::mt19937_64 random(6);
  for (int k = 0; k < 300; ++k) {
    Results results(ResultNames{{}, {"root.peak_moment"}, true});
    const long n = 1 + static_cast<long>(uniform(random) * 200);
    long broken = 0, cut = 0, known = 0;
    for (long run = 0; run < n; ++run) {
      const double value = uniform(random);
      const bool is_cut = uniform(random) < 0.5;
      ResultRow row{run, Status::deployed, {}, {value}, "", ""};
      row.peaks_final = is_cut ? PeaksFinal::no : PeaksFinal::yes;
      results.append(row);
      if (value >= 0.05) continue;
      ++broken, ++(is_cut ? cut : known);
    }
    const Requirement least{"", "root.peak_moment", {}, 0.05, 0.9, 0.9};
    const Verdict verdict = judge(least, results);
    CAPTURE(n, broken, cut);
    CHECK((verdict.failures() == broken && verdict.cut == cut && verdict.open == cut));
    CHECK(broken_runs(verdict, results, 9).cut == cut);
    CHECK(broken_runs(verdict, results, 9).beyond == known);
    if (!verdict.allowed) continue;
    CHECK((verdict.decision == Decision::pass) == (broken <= *verdict.allowed));
    CHECK((verdict.decision == Decision::fail) == (known > *verdict.allowed));
    if (verdict.decision == Decision::undecided)
      CHECK_THAT(evidence(verdict), Catch::Contains("may still rise to the limit"));
    const RankedOutput ranks(results, results.outputs[0]);
    const auto lower = output_limits(ranks, {0.9, 0.9, Side::lower}).lower;
    CHECK((lower && *lower >= 0.05) == (verdict.decision == Decision::pass));
    CHECK(ranks.beyond(Side::lower) == 0);
  }
}
