#include "montecarlo/results/summary/broken_runs.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Ten runs: values 3, 7, 5, 9, 8; two that stalled, one without a value, one cut by t_end, one that timed out.
Results ten() {
  Results results(ResultNames{{}, {"root.peak_moment"}, true});
  long run = 0;
  const auto add = [&](Status status, double value, const char* order, PeaksFinal final) {
    results.append({run++, status, {}, {value}, order, "", final});
  };
  for (const double value : {3., 7., 5., 9., 8.})
    add(Status::deployed, value, "a>b>c", PeaksFinal::yes);
  add(Status::stalled, 100, "a>b", PeaksFinal::yes);
  add(Status::stalled, 100, "a", PeaksFinal::yes);
  add(Status::deployed, nothing, "a>b>c", PeaksFinal::yes);
  add(Status::deployed, 4, "a>b>c", PeaksFinal::no);
  add(Status::timed_out, 100, "", PeaksFinal::unknown);
  return results;
}

BrokenRuns of(const Requirement& requirement, std::size_t most = 5) {
  const Results results = ten();
  const Verdict verdict = judge(requirement, results);
  BrokenRuns broken = broken_runs(verdict, results, most);
  CHECK(broken.not_deployed + broken.without_value + broken.cut + broken.beyond ==
        verdict.failures());
  return broken;
}

} // namespace

TEST_CASE("runs break a requirement by four causes, counted by hand") {
  const BrokenRuns broken = of({"", "root.peak_moment", 6, {}, .5, .5});
  CHECK(broken.not_deployed == 3);
  CHECK(broken.without_value == 1);
  CHECK(broken.cut == 1);
  CHECK(broken.beyond == 3);
  CHECK((broken.worst->run == 3 && broken.worst->value == 9));
  REQUIRE(broken.beyond_runs.size() == 3);
  CHECK((broken.beyond_runs[0].run == 3 && broken.beyond_runs[1].run == 4 &&
         broken.beyond_runs[2].run == 1));
  REQUIRE(broken.not_deployed_runs.size() == 3); // the fewest latched hinges first
  CHECK((broken.not_deployed_runs[0].run == 9 && broken.not_deployed_runs[0].latched == 0));
  CHECK((broken.not_deployed_runs[1].run == 6 && broken.not_deployed_runs[1].latched == 1));
  CHECK((broken.not_deployed_runs[2].run == 5 && broken.not_deployed_runs[2].latched == 2));
}

TEST_CASE("where no value is beyond the limit the worst is the nearest to it") {
  const BrokenRuns above = of({"", "root.peak_moment", 20, {}, .5, .5});
  CHECK(above.beyond == 0);
  CHECK(above.beyond_runs.empty());
  CHECK((above.worst->run == 3 && above.worst->value == 9));
  const BrokenRuns below = of({"", "root.peak_moment", {}, 1, .5, .5}); // a minimum
  CHECK(below.beyond == 0);
  CHECK((below.worst->run == 0 && below.worst->value == 3));
}

TEST_CASE("lists of broken runs are as long as wanted, ties by run") {
  CHECK(of({"", "root.peak_moment", 6, {}, .5, .5}, 2).beyond_runs.size() == 2);
  CHECK(of({"", "root.peak_moment", 6, {}, .5, .5}, 0).not_deployed_runs.empty());
  const Results results = ten();
  const auto stalled = fewest_latched(results, Status::stalled, 1);
  REQUIRE(stalled.size() == 1);
  CHECK(stalled[0].run == 6);
  CHECK(fewest_latched(results, Status::deployed, 2)[1].run == 1); // all have three
}

TEST_CASE("a run breaks `deployed` only by not deploying") {
  const BrokenRuns broken = of({"", "deployed", {}, {}, .5, .5});
  CHECK(broken.not_deployed == 3);
  CHECK(broken.beyond == 0);
  CHECK_FALSE(broken.worst);
}

TEST_CASE(
    "a limit of the magnitude has the broken runs of the magnitudes, and a minimum those of the "
    "mirror image's maximum") {
  std::mt19937_64 random(6);
  for (int k = 0; k < 50; ++k) {
    const ResultNames names{{}, {"root.latch_rate"}};
    Results plain(names), sizes(names), mirrored(names);
    for (long run = 0; run < 40; ++run) {
      const auto status = uniform(random) < 0.9 ? Status::deployed : Status::stalled;
      const double value = uniform(random) < 0.9 ? 2 * uniform(random) - 1 : nothing;
      plain.append({run, status, {}, {value}, "a", ""});
      sizes.append({run, status, {}, {std::abs(value)}, "a", ""});
      mirrored.append({run, status, {}, {-value}, "a", ""});
    }
    const double limit = 0.2 + 0.6 * uniform(random);
    const auto of = [](Requirement requirement, const Results& results, double sign = 1) {
      const Verdict verdict = judge(requirement, results);
      const BrokenRuns found = broken_runs(verdict, results, 100);
      CHECK(found.not_deployed + found.without_value + found.beyond == verdict.failures());
      std::vector<std::pair<long, double>> listed{{found.worst->run, sign * found.worst->value}};
      for (const JudgedRun& each : found.beyond_runs)
        listed.emplace_back(each.run, sign * each.value);
      CHECK(std::ssize(listed) == found.beyond + 1);
      return listed;
    };
    for (const bool upper : {true, false}) {
      Requirement requirement{"", "root.latch_rate", {}, {}, .5, .5};
      (upper ? requirement.max : requirement.min) = limit;
      const auto expected = of(requirement, sizes);
      requirement.absolute = true;
      CHECK(of(requirement, plain) == expected);
      CHECK(of(requirement, mirrored) == expected);
    }
    const Requirement least{"", "root.latch_rate", {}, -limit, .5, .5},
        most{"", "root.latch_rate", limit, {}, .5, .5};
    CHECK(of(least, plain) == of(most, mirrored, -1));
  }
}
