#include "montecarlo/statistics/binomial_bounds.hpp"
#include "montecarlo/summary/verdict.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

using namespace wingspread;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

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
    CHECK(evidence(pass) == std::to_string(allowed) + " of 10000 runs break it, and " +
                                std::to_string(allowed) + " may");
    CHECK(evidence(fail) == std::to_string(allowed + 1) + " of 10000 runs break it, and " +
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
}

TEST_CASE("a campaign that may have stopped earlier has to show more") {
  const Results results = counting(10000);
  const Verdict verdict = judge(at_most(9914, .99, .9), results, 5);
  CHECK(verdict.confidence == Approx(.98));
  CHECK(verdict.allowed == allowed_failures(10000, .99, .98));
  CHECK(*verdict.allowed < 86);
  CHECK(verdict.decision == Decision::fail);
}

TEST_CASE("tolerance limits of an output put runs that did not deploy beyond every number") {
  Results results = counting(59);
  const auto limits = [&](Side side) {
    return output_limits(results, results.outputs[0], {.95, .95, side});
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
