#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/results/summary/verdict.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Runs 0, 1, … whose output "x" is 1, 2, …; all deployed.
Results counting(long runs) {
  Results results(ResultNames{{}, {"x"}});
  for (long run = 0; run < runs; ++run)
    results.append({run, Status::deployed, {}, {static_cast<double>(run + 1)}, "", ""});
  return results;
}

Requirement at_most(double max, double p, double c) { return {"", "x", max, {}, p, c}; }
Requirement at_least(double min, double p, double c) { return {"", "x", {}, min, p, c}; }
Requirement deploys(double p, double c) { return {"", "deployed", {}, {}, p, c}; }

} // namespace

// scipy 1.10.1, stats.binom.cdf: of 10000, 86 may break .99/.90 and 19 may break .9973/.90.
TEST_CASE("a requirement passes up to the number of failures that the table allows") {
  const Results results = counting(10000);
  for (const auto& [p, allowed] : {std::pair{.99, 86L}, std::pair{.9973, 19L}}) {
    const double last = static_cast<double>(10000 - allowed); // so many lie above
    const Verdict pass = judge(at_most(last, p, .9), results);
    CHECK(pass.decision == Decision::pass);
    CHECK(pass.allowed == allowed);
    CHECK(std::ssize(pass.broken) == allowed);
    CHECK(pass.broken.front() == 9999); // the worst
    CHECK(pass.guaranteed == last);
    CHECK(pass.margin == 0);
    CHECK(pass.observed == 10000 * p);
    CHECK(pass.guaranteed_share >= p);
    const Verdict fail = judge(at_most(last - 1, p, .9), results);
    CHECK(fail.decision == Decision::fail);
    CHECK(fail.margin == -1);
    CHECK(fail.guaranteed_share < p);
    CHECK(evidence(pass) == std::to_string(allowed) + " of 10000 runs break it; at most " +
                                std::to_string(allowed) + " may");
    CHECK(evidence(fail) == std::to_string(allowed + 1) + " of 10000 runs break it; at most " +
                                std::to_string(allowed) +
                                " may: not shown, and not disproved either");
  }
}

TEST_CASE("a limit from below is judged as one from above") {
  const Results results = counting(10000);
  const Verdict pass = judge(at_least(87, .99, .9), results); // 86 lie below
  CHECK((pass.decision == Decision::pass && pass.guaranteed == 87 && pass.margin == 0));
  CHECK((pass.broken.front() == 0 && pass.broken.back() == 85));
  CHECK(pass.observed == 101); // the mirror image of X_(9900)
  const Verdict fail = judge(at_least(90, .99, .9), results);
  CHECK((fail.decision == Decision::fail && fail.margin == -3));
}

// scipy, as above: with 1000, .99865/.90 cannot pass at all.
TEST_CASE("what the runs cannot decide is undecided, and says what it takes") {
  const Verdict verdict = judge(at_most(5000, .99865, .9), counting(1000));
  CHECK(verdict.decision == Decision::undecided);
  CHECK_FALSE(verdict.allowed);
  CHECK_FALSE(verdict.guaranteed);
  CHECK_FALSE(verdict.margin);
  CHECK(verdict.observed == 999);
  CHECK(verdict.least_runs == 1705);
  CHECK(evidence(verdict) ==
        "1000 runs cannot show it, even if none breaks it: it takes 1705 (0 of "
        "1000 runs break it)");
  CHECK(judge(at_most(997, .99865, .9), counting(1000)).decision == Decision::undecided);
  const Verdict disproved = judge(at_most(996, .99865, .9), counting(1000)); // 4 break it
  CHECK(disproved.decision == Decision::fail);
  CHECK(evidence(disproved) == "4 of 1000 runs break it: disproved");
  CHECK(judge(at_most(1, .5, .5), counting(0)).decision == Decision::undecided);
  const Verdict after_few =
      judge(at_most(50, .9, .9), counting(25), {1, {20}}); // 22 would do alone
  CHECK((after_few.decision == Decision::undecided && !after_few.least_runs));
  CHECK(evidence(after_few).find("after the analyses of 20 runs") != std::string::npos);
  const Verdict too_few = judge(at_most(50, .9, .9), counting(21), {1, {10}});
  CHECK(too_few.least_runs == 22);
  CHECK(evidence(too_few).find("it takes 22") != std::string::npos);
}

TEST_CASE("runs that did not deploy count against every requirement, whatever their values") {
  for (const Status status :
       {Status::stalled, Status::timed_out, Status::failed, Status::invalid}) {
    Results results = counting(10000);
    // Within every limit, had they counted by their values; the last is without one.
    for (long run = 10000; run < 10100; ++run)
      results.append({run, status, {}, {run < 10099 ? 5000.0 : none}, "", "held"});
    const Verdict max = judge(at_most(20000, .99, .9), results);
    CHECK((max.decision == Decision::fail && max.broken.size() == 100));
    CHECK((max.broken.front() == 10000 && max.allowed == 87));
    CHECK_FALSE(max.guaranteed); // above every finite value
    CHECK_FALSE(max.margin);
    const Verdict min = judge(at_least(-1, .99, .9), results);
    CHECK((min.decision == Decision::fail && min.broken.size() == 100 && !min.guaranteed));
    const Verdict deployed = judge(deploys(.99, .9), results);
    CHECK((deployed.decision == Decision::fail && deployed.broken.size() == 100));
    CHECK(deployed.share == Approx(10000. / 10100));
    // The same values without those runs would pass: dropping them would flatter.
    CHECK(judge(at_most(20000, .99, .9), counting(10000)).decision == Decision::pass);
    CHECK(judge(at_most(20000, .98, .9), results).decision == Decision::pass);
    CHECK(judge(at_most(20000, .98, .9), results).guaranteed < 10000);
  }
}

TEST_CASE("an output that did not happen in a deployed run counts against it too") {
  Results results = counting(229);
  results.append({229, Status::deployed, {}, {none}, "", ""});
  const Verdict verdict = judge(at_most(1000, .99, .9), results);
  CHECK(verdict.decision == Decision::fail);
  CHECK(verdict.broken == std::vector<long>{229});
  CHECK(judge(deploys(.99, .9), results).decision == Decision::pass);
}

TEST_CASE("deployment is judged by its share") {
  Results results = counting(3000);
  results.append({3000, Status::stalled, {}, {none}, "", "held"});
  const Verdict pass = judge(deploys(.998, .9), results);
  CHECK((pass.decision == Decision::pass && pass.allowed == 2));
  CHECK(pass.broken == std::vector<long>{3000});
  CHECK(pass.guaranteed_share == clopper_pearson_lower(3000, 3001, .9));
  CHECK(pass.margin == Approx(pass.guaranteed_share - .998));
  CHECK(judge(deploys(.999, .9), results).decision == Decision::fail);
  CHECK(replay_command("results/x", 3000) == "wingspread replay results/x --run 3000");
  CHECK(replay_command("a b&c", 1) == "wingspread replay 'a b&c' --run 1");
}

TEST_CASE("a campaign that may have stopped earlier has to show more") {
  const Results results = counting(10000);
  const Verdict verdict = judge(at_most(9914, .99, .9), results, {5});
  CHECK(verdict.confidence == Approx(.98));
  CHECK(verdict.allowed == allowed_failures(10000, .99, .98));
  CHECK(*verdict.allowed < 86);
  CHECK(verdict.decision == Decision::fail);
}

TEST_CASE("tolerance limits of an output put runs that did not deploy beyond every number") {
  Results results = counting(59);
  const auto limits = [&](Side side) {
    return output_limits(RankedOutput(results, results.outputs[0]), {.95, .95, side});
  };
  CHECK(limits(Side::upper).upper == 59);
  CHECK(limits(Side::lower).lower == 1);
  results.status[30] = Status::timed_out;
  CHECK_FALSE(limits(Side::upper).upper);
  CHECK_FALSE(limits(Side::lower).lower);
  for (long run = 59; run < 93; ++run) // order 2: the one without a number, then the extreme
    results.append({run, Status::deployed, {}, {30.0}, "", ""});
  CHECK(limits(Side::upper).upper == 59);
  CHECK(limits(Side::lower).lower == 1);
}

TEST_CASE("a wing as bad as a requirement just forbids passes as seldom as the confidence says") {
  constexpr int trials = 2000;
  constexpr long runs = 500;
  constexpr double p = .97, c = .9;
  std::mt19937_64 random(61);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  int passed = 0, guaranteed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Results results(ResultNames{{}, {"x"}});
    for (long run = 0; run < runs; ++run) { // a third of what breaks it stalls
      const double u = uniform();
      results.append({run,
                      u < .01 ? Status::stalled : Status::deployed,
                      {},
                      {u < .01 ? none : 1 - u},
                      "",
                      ""});
    }
    const Verdict verdict = judge(at_most(p, p, c), results);
    if (verdict.decision == Decision::pass) ++passed;
    if (!verdict.guaranteed || *verdict.guaranteed >= p) ++guaranteed;
  }
  const double risk = cdf(boost::math::binomial_distribution<double>(runs, 1 - p),
                          static_cast<double>(allowed_failures(runs, p, c).value()));
  REQUIRE(risk <= 1 - c);
  const double band = 5 * std::sqrt(risk * (1 - risk) / trials);
  CHECK(static_cast<double>(passed) / trials == Approx(risk).margin(band));
  CHECK(static_cast<double>(guaranteed) / trials == Approx(1 - risk).margin(band));
}

// By definition, from all runs sorted by how bad they are.
TEST_CASE("many requirements at once are judged as each by itself, and as they are defined") {
  std::mt19937_64 random(62);
  Results results(ResultNames{{}, {"x", "y"}});
  const std::vector<Status> kinds{Status::deployed, Status::deployed, Status::deployed,
                                  Status::deployed, Status::stalled,  Status::failed};
  for (long run = 5; run < 605; ++run) { // ties, values missing, values of runs that did not deploy
    const auto value = [&] {
      const auto number = static_cast<double>(random() % 40);
      return number == 39 ? none : number - 20;
    };
    results.append({run, kinds[random() % 6], {}, {value(), value()}, "", ""});
  }
  std::vector<Requirement> requirements;
  for (const char* output : {"x", "deployed", "y", "x"})
    for (const double limit : {-30., -3., 0., 12., 30.})
      for (const bool above : {true, false}) {
        Requirement each{"", output, {}, {}, .6, .9};
        if (output != std::string("deployed")) (above ? each.max : each.min) = limit;
        requirements.push_back(each);
      }
  const std::vector<Verdict> verdicts = judge_all(requirements, results, {2});
  REQUIRE(verdicts.size() == requirements.size());
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    const Requirement& requirement = requirements[k];
    const Verdict &verdict = verdicts[k], alone = judge(requirement, results, {2});
    const bool is_share = requirement.output == "deployed";
    const auto& values = results.outputs[requirement.output == "y" ? 1 : 0].values;
    const double sign = requirement.min ? -1 : 1;
    std::vector<std::pair<double, long>> worst; // minus the badness, and the run
    for (std::size_t row = 0; row < 600; ++row) {
      const double value = is_share ? 0 : sign * values[row];
      const bool counts = results.status[row] == Status::deployed && !std::isnan(value);
      worst.emplace_back(counts ? -value : -std::numeric_limits<double>::infinity(),
                         results.runs[row]);
    }
    std::ranges::sort(worst);
    const double limit =
        is_share ? 0 : sign * requirement.max.value_or(requirement.min.value_or(0));
    std::vector<long> broken;
    for (const auto& [badness, run] : worst)
      if (-badness > limit) broken.push_back(run);
    CHECK(verdict.broken == broken);
    CHECK(alone.broken == verdict.broken);
    CHECK((alone.decision == verdict.decision && alone.margin == verdict.margin));
    CHECK((alone.observed == verdict.observed && alone.guaranteed == verdict.guaranteed));
    CHECK(verdict.allowed == allowed_failures(600, .6, .95));
    if (is_share) continue;
    const auto at = [&](std::size_t place) {
      return std::isinf(worst[place].first) ? std::nullopt
                                            : std::optional(-sign * worst[place].first);
    };
    CHECK(verdict.observed == at(600 - 360)); // the 360th of 600 from the good side
    CHECK(verdict.guaranteed == at(static_cast<std::size_t>(*verdict.allowed)));
  }
}

// One look in two is taken at 1 − (1 − c)/2: two looks at .95 are at .975 each.
TEST_CASE("tolerance limits and verdicts of two looks are those of half the risk") {
  const Results results = counting(300);
  const RankedOutput ranks(results, results.outputs[0]);
  for (const Side side : {Side::upper, Side::lower, Side::both}) {
    const Bounds at_two = output_limits(ranks, {.95, .95, side}, {2});
    const Bounds half = output_limits(ranks, {.95, .975, side});
    const Bounds at_one = output_limits(ranks, {.95, .95, side});
    CHECK((at_two.lower == half.lower && at_two.upper == half.upper));
    if (side != Side::both) // of these 3 are left out on either side at one look and at two
      CHECK((at_two.lower != at_one.lower || at_two.upper != at_one.upper));
  }
  const auto upper = [&](long looks) {
    return *output_limits(ranks, {.95, .95, Side::upper}, {looks}).upper;
  };
  // Summing the binomial law of 300 runs at 5 %: P(X ≤ 8) = .0341, P(X ≤ 7) = .0160, P(X ≤ 6) = .0066
  CHECK(upper(1) == 300 - 8);
  CHECK(upper(2) == 300 - 7);
  CHECK(upper(5) == 300 - 6);
  CHECK(judge(at_most(1000, .95, .95), results, {2}).confidence == Approx(.975).epsilon(1e-15));
  CHECK(judge(at_most(1000, .95, .95), results, {2}).allowed == 7);
  CHECK(judge(at_most(1000, .95, .95), results).allowed == 8);
}

// The k-th run turns at −k or +k: magnitudes 1 … 1000, of which 5 may break 99 % at 90 % (scipy 1.10.1).
TEST_CASE("a limit on the magnitude does not ask for the sense of rotation") {
  Results results(ResultNames{{}, {"x"}});
  for (long run = 0; run < 1000; ++run)
    results.append(
        {run, Status::deployed, {}, {(run % 2 == 0 ? -1. : 1.) * double(run + 1)}, "", ""});
  Requirement both = at_most(995, .99, .9);
  both.absolute = true;
  const Verdict verdict = judge(both, results);
  CHECK(verdict.broken == std::vector<long>{999, 998, 997, 996, 995});
  CHECK(
      (verdict.decision == Decision::pass && verdict.observed == 990 && verdict.guaranteed == 995));
  CHECK(judge(at_most(995, .99, .9), results).broken == std::vector<long>{999, 997, 995});
  Requirement least = at_least(3, .99, .9);
  least.absolute = true;
  CHECK(judge(least, results).broken == std::vector<long>{0, 1}); // −1, 2
  // The same output with and without the magnitude, side by side.
  const std::vector<Verdict> together =
      judge_all(std::vector{at_most(995, .99, .9), both}, results);
  CHECK((together[0].broken.size() == 3 && together[1].broken.size() == 5));
  const Verdict alone = judge(at_most(995, .99, .9), results);
  CHECK((together[0].observed == alone.observed && together[0].guaranteed == alone.guaranteed));
  CHECK((together[1].observed == 990 && together[1].guaranteed == 995));
  CHECK(alone.observed != verdict.observed); // so the two can be told apart
}

// scipy 1.10.1, stats.binom.cdf: of 1000, 40 may break .95/.95 and 38 may break .95/.975.
TEST_CASE("requirements of a group hold together at the confidence they share") {
  const Results results = counting(1000);
  std::vector<Requirement> pair{at_most(1000, .95, .95), at_most(1000, .95, .95),
                                at_most(1000, .95, .95)};
  pair[0].group = pair[1].group = "A";
  const std::vector<Verdict> verdicts = judge_all(pair, results);
  for (const std::size_t k : {0U, 1U}) {
    CHECK(verdicts[k].confidence == Approx(.975).epsilon(1e-15));
    CHECK(verdicts[k].allowed == allowed_failures(1000, .95, 1 - .05 / 2));
  }
  CHECK((verdicts[2].confidence == .95 && *verdicts[2].allowed > *verdicts[0].allowed));
  CHECK(joint_confidence(verdicts) ==
        Approx(.9).epsilon(1e-14)); // .95 for the group, .95 for the other
  CHECK(judge_all(pair, results, {2})[0].confidence == Approx(1 - .05 / 4).epsilon(1e-15));
  pair[1].max = 500;
  const auto groups = judge_groups(judge_all(pair, results));
  REQUIRE(groups.size() == 1);
  CHECK((groups[0].name == "A" && groups[0].members == 2 && groups[0].passed == 1));
  CHECK((groups[0].confidence == .95 && groups[0].decision == Decision::fail));
  CHECK(judge_groups(verdicts)[0].decision == Decision::pass);
}

TEST_CASE("a group fails if any member fails, else is undecided if any is, in whatever order") {
  constexpr std::array decisions{Decision::pass, Decision::fail, Decision::undecided};
  for (int code = 0; code < 27; ++code) {
    std::vector<Verdict> verdicts(3);
    long passed = 0;
    bool failed = false, open = false;
    for (int k = 0, rest = code; k < 3; ++k, rest /= 3) {
      Verdict& verdict = verdicts[static_cast<std::size_t>(k)];
      verdict.requirement.group = "A", verdict.requirement.confidence = .9;
      verdict.decision = decisions[static_cast<std::size_t>(rest % 3)];
      passed += verdict.decision == Decision::pass;
      failed = failed || verdict.decision == Decision::fail;
      open = open || verdict.decision == Decision::undecided;
    }
    CAPTURE(code);
    const GroupVerdict group = judge_groups(verdicts).at(0);
    CHECK((group.members == 3 && group.passed == passed));
    CHECK(group.decision == (failed ? Decision::fail
                             : open ? Decision::undecided
                                    : Decision::pass));
  }
}

TEST_CASE("a limit on the other side of zero from every value is found") {
  Results results(ResultNames{{}, {"x"}});
  for (const double value : {-1.5, -1.25, none, -0.5})
    results.append({static_cast<long>(results.size()), Status::deployed, {}, {value}, "", ""});
  const auto found = judge(at_most(1.5, .5, .5), results).beyond_zero;
  REQUIRE(found);
  CHECK((found->front() == -1.5 && found->back() == -0.5));
  CHECK_FALSE(judge(at_most(0, .5, .5), results).beyond_zero);
  CHECK_FALSE(judge(at_least(-2, .5, .5), results).beyond_zero);
  Requirement magnitude = at_most(1.5, .5, .5);
  magnitude.absolute = true;
  CHECK_FALSE(judge(magnitude, results).beyond_zero);
  Requirement margin =
      at_least(0.1, .5, .5); // a static margin below 0 is not met, and has no magnitude
  CHECK(beyond_zero(-0.7, -0.5, margin));
  margin.static_margin.emplace();
  CHECK_FALSE(beyond_zero(-0.7, -0.5, margin));
  results.append({4, Status::deployed, {}, {0.1}, "", ""});
  CHECK_FALSE(judge(at_most(1.5, .5, .5), results).beyond_zero); // not every value
  CHECK_FALSE(judge(at_most(1.5, .5, .5), Results(ResultNames{{}, {"x"}})).beyond_zero);
}

TEST_CASE("a limit between zero and the values, or among them, is on their side") {
  for (const double sign : {1.0, -1.0}) {
    Results far(ResultNames{{}, {"x"}}), both(ResultNames{{}, {"x"}});
    for (const double value : {0.75, 0.9})
      far.append({static_cast<long>(far.size()), Status::deployed, {}, {sign * value}, "", ""});
    for (const double value : {-0.75, 0.9})
      both.append({static_cast<long>(both.size()), Status::deployed, {}, {sign * value}, "", ""});
    for (const double limit : {0.5, 0.8, 2.0}) {
      CAPTURE(sign, limit);
      CHECK_FALSE(judge(at_most(sign * limit, .5, .5), far).beyond_zero);
      CHECK_FALSE(judge(at_least(sign * limit, .5, .5), far).beyond_zero);
      CHECK(judge(at_most(-sign * limit, .5, .5), far).beyond_zero);
      CHECK(judge(at_least(-sign * limit, .5, .5), far).beyond_zero);
      CHECK_FALSE(judge(at_most(sign * limit, .5, .5), both).beyond_zero);
      CHECK_FALSE(judge(at_least(sign * limit, .5, .5), both).beyond_zero);
    }
  }
}
