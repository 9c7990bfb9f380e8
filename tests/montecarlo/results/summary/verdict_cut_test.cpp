#include "montecarlo/results/summary/verdict.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;
using namespace wingspread::test;

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
