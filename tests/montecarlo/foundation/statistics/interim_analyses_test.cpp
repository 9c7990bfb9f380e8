#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/statistics/interim_analyses.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <vector>

using namespace wingspread;

namespace {

/// 500, 1000, … up to the last: `count` analyses.
std::vector<long> doubled(long first, int count) {
  std::vector<long> runs;
  for (int k = 0; k < count; ++k) runs.push_back(first << k);
  return runs;
}

PassingRule rule_at(std::vector<long> runs, double p, double c) {
  const long n = runs.back();
  runs.pop_back();
  return passing_rule({1, runs}, n, p, c);
}

} // namespace

TEST_CASE("a single analysis, and planned ones, have the rule of Wilks") {
  CHECK(passing_rule({}, 10000, .99, .9).allowed == allowed_failures(10000, .99, .9));
  const PassingRule five = passing_rule({5}, 10000, .99, .9);
  CHECK((five.confidence == Approx(.98) && five.allowed == allowed_failures(10000, .99, .98)));
  CHECK_FALSE(five.joint);
}

// scipy 1.10.1, stats.binom.sf: the fewest failures of probability 1 − c at most.
TEST_CASE("what disproves a requirement") {
  CHECK((is_disproved({}, 10000, .99, .9, 114) && !is_disproved({}, 10000, .99, .9, 113)));
  CHECK((is_disproved({}, 1000, .99865, .9, 4) && !is_disproved({}, 1000, .99865, .9, 3)));
  CHECK_FALSE(is_disproved({}, 0, .5, .5, 0));
}

TEST_CASE("two analyses: by hand") {
  // p = 1/2, c = 0.75: 2 runs pass with none failing, 1/4, which is all of the risk.
  const PassingRule spent = passing_rule({1, {2}}, 3, .5, .75);
  CHECK(spent.joint->risk == Approx(.25).epsilon(1e-12));
  CHECK(spent.allowed == 0); // none failed in 2 runs: it had passed
  // c = 0.6: 1/4 of 0.4, and so 0.075 is left for analysis 2. Of 5 runs 1 failed: only in the first two, 2/4 · 1/8.
  const PassingRule two = passing_rule({1, {2}}, 5, .5, .6);
  CHECK(two.allowed == 1);
  CHECK(two.joint->risk == Approx(.25 + 2. / 32).epsilon(1e-12));
  CHECK(two.confidence == Approx(1 - 6. / 32).epsilon(1e-12)); // P(Bin(5, 1/2) ≤ 1)
  CHECK(two.joint->allowed_alone == 1);
}

TEST_CASE("extensions at the boundary pass wrongly as often as is said, and within the promise") {
  const auto analyses = GENERATE(5, 9);
  constexpr double p = .95, c = .9;
  const std::vector<long> runs = doubled(500, analyses);
  const PassingRule last = rule_at(runs, p, c);
  CHECK(last.joint->risk <= 1 - c);
  CHECK(last.joint->risk > .09);
  // dynamic programming in Python (numpy 1.24), all states kept
  CHECK(last.joint->risk_alone == Approx(analyses == 5 ? .2545 : .3886).epsilon(1e-3));

  std::vector<long> allowed;
  for (std::size_t k = 0; k < runs.size(); ++k)
    allowed.push_back(*rule_at({runs.begin(), runs.begin() + long(k) + 1}, p, c).allowed);
  CHECK(std::vector(allowed.begin(), allowed.begin() + 5) ==
        std::vector<long>{18, 35, 77, 165, 347});
  if (analyses == 5) CHECK(last.joint->risk == Approx(.09803).epsilon(1e-3));
  constexpr int campaigns = 2000;
  int passed = 0;
  RandomStream stream(5, 0, stream_name("extensions"));
  for (int campaign = 0; campaign < campaigns; ++campaign) {
    long n = 0, failures = 0;
    bool passes = false;
    for (std::size_t k = 0; k < runs.size() && !passes; ++k) {
      for (; n < runs[k]; ++n) failures += open_uniform(stream()) > p;
      passes = failures <= allowed[k];
      if (runs[k] >= 8000) break; // further ones add less than 0.1 % each
    }
    passed += passes;
  }
  CHECK(double(passed) / campaigns == Approx(last.joint->risk).margin(3 * .0067));
}

TEST_CASE("the risk stays within the promise for any probability, confidence and number of runs") {
  for (const double p : {.5, .9, .95, .99, .9973})
    for (const double c : {.5, .9, .95})
      for (const long first : {8L, 100L, 500L, 3000L}) {
        CAPTURE(p, c, first);
        double before = 0;
        for (int analyses = 2; analyses <= 6; ++analyses) {
          const PassingRule rule = rule_at(doubled(first, analyses), p, c);
          REQUIRE(rule.joint);
          CHECK(rule.joint->risk <= (1 - c) * (1 + 1e-9));
          CHECK(rule.joint->risk >= before - 1e-12);
          CHECK(rule.allowed.value_or(-1) <= rule.joint->allowed_alone.value_or(-1));
          if (rule.allowed && rule.confidence < .999)
            CHECK(allowed_failures(first << (analyses - 1), p, rule.confidence) == rule.allowed);
          before = rule.joint->risk;
        }
      }
}

TEST_CASE("analyses that could not pass have spent nothing") {
  const PassingRule rule = passing_rule({1, {10, 20}}, 3000, .999, .9); // it takes 2302
  CHECK(rule.allowed == allowed_failures(3000, .999, .9));
  CHECK(rule.joint->risk == Approx(rule.joint->risk_alone).epsilon(1e-12));
  CHECK_FALSE(passing_rule({1, {10}}, 20, .999, .9).allowed);
}

TEST_CASE(
    "a wing far better than required passes after an extension, and one far worse is disproved") {
  const std::vector<long> before{500, 1000, 2000, 4000};
  CHECK(passing_rule({1, before}, 8000, .95, .9).allowed > 8000 * .04);
  CHECK(is_disproved({1, before}, 8000, .95, .9, 480));
  CHECK_FALSE(is_disproved({1, before}, 8000, .95, .9, 400));
}

TEST_CASE("bounds of all extensions hold together") {
  double risk = 0;
  std::vector<long> before;
  for (long k = 2; k < 1000; ++k) {
    before.push_back(k);
    risk += 1 - InterimAnalyses{1, before}.confidence_of_bound(.9);
  }
  CHECK((risk < .1 && risk > .0998));
}

TEST_CASE("an analysis of the same runs again, and later ones, change no rule") {
  std::mt19937_64 random(5);
  for (int k = 0; k < 100; ++k) {
    std::vector<long> before;
    for (long n = 50; before.size() < 1 + random() % 4;) before.push_back(n += 1 + random() % 500);
    const long n = before.back() + 1 + static_cast<long>(random() % 500);
    const double p = 0.8 + 0.001 * static_cast<double>(random() % 190),
                 c = 0.8 + 0.001 * static_cast<double>(random() % 190);
    const PassingRule rule = passing_rule({1, before}, n, p, c);
    std::vector<long> with = before;
    with.push_back(n);
    const PassingRule again = passing_rule({1, with}, n, p, c);
    with.push_back(n + 100);
    const PassingRule later = passing_rule({1, with}, n, p, c);
    CAPTURE(n, p, c);
    for (const PassingRule& each : {again, later})
      CHECK((each.allowed == rule.allowed && each.confidence == rule.confidence));
  }
}
