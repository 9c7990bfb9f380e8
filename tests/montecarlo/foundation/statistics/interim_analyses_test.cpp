#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/statistics/interim_analyses.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
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

/// The largest probability of a wrong pass at this analysis or a later one, for P = p, if each number of runs is chosen by
/// the failures seen. All failures are tried, by the definition.
struct Adversary {
  double p, c;
  std::vector<double> factors; ///< of the runs so far
  std::vector<long> runs{}, failed{};

  /// @param further analyses after this one
  double risk_at(long n, int further) {
    const long before = failed.empty() ? 0 : failed.back(),
               added = n - (runs.empty() ? 0 : runs.back());
    const auto allowed = passing_rule({1, runs}, n, p, c, failed).allowed;
    const boost::math::binomial law(double(added), 1 - p);
    double risk = 0;
    for (long x = 0; x <= added; ++x) {
      const double probability = pdf(law, double(x));
      if (probability < 1e-7) continue;
      if (allowed && before + x <= *allowed)
        risk += probability;
      else if (further > 0)
        risk += probability * risk_after(n, before + x, further - 1);
    }
    return risk;
  }
  double risk_after(long n, long failures, int further) {
    runs.push_back(n), failed.push_back(failures);
    double most = 0;
    for (const double factor : factors)
      most = std::max(most, risk_at(std::lround(factor * double(n)), further));
    runs.pop_back(), failed.pop_back();
    return most;
  }
};

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
  // p = 1/2, c = 0.6: none of 2 runs may fail, 1/4 of 0.4. (3) with m = 8: b = 3, as 1/2 · 37/256 + 1/4 · 9/256 is below
  // the 0.15 left, and 1/2 · 93/256 + 1/4 · 37/256 is not.
  const double C = .15 / (.5 * 37 / 256 + .25 * 9 / 256);
  CHECK(C * 37 / 256 / 2 > 1. / 8); // half of it pays for none of 3 more to fail
  const PassingRule one = passing_rule({1, {2}}, 5, .5, .6, std::array{1L});
  CHECK(one.allowed == 1);
  CHECK(one.joint->risk == Approx(.4).epsilon(1e-12));
  CHECK(one.joint->risk_alone == Approx(.25 + 2. / 32).epsilon(1e-12));
  CHECK(one.confidence == Approx(1 - 6. / 32).epsilon(1e-12)); // P(Bin(5, 1/2) ≤ 1)
  CHECK(one.joint->allowed_alone == 1);
  CHECK(C * 9 / 256 / 2 < 1. / 8);
  CHECK(passing_rule({1, {2}}, 5, .5, .6, std::array{2L}).allowed == 1); // two have failed: no pass
  // C 37/512 = 0.134 and of 4 more runs: 1/16 for none, 5/16 for one
  CHECK(passing_rule({1, {2}}, 6, .5, .6, std::array{1L}).allowed == 1);
  // it has passed: from then on judged as bounds are, at 1 − 0.4/2
  CHECK(passing_rule({1, {2}}, 6, .5, .6, std::array{0L}).allowed == 1);
  CHECK(allowed_failures(6, .5, .6) == 2);
  for (const long n : {79, 80, 100}) // 0.95^79 > 0.1/6, 0.95^80 is not
    CHECK(passing_rule({1, {45, 60}}, n, .95, .9, std::array{0L, 0L}).allowed == 0);
}

TEST_CASE("numbers of runs that are chosen by the failures pass no more often than promised") {
  struct Given {
    double p, c;
    long first;
    int extensions;
    double least; ///< of α: the rule is no idle one
  };
  for (const auto& [p, c, first, extensions, least] : {Given{.8, .9, 12, 2, .8},
                                                       {.8, .9, 25, 2, .8},
                                                       {.5, .6, 3, 2, .7},
                                                       {.9, .9, 30, 2, .7},
                                                       {.95, .9, 100, 1, .6},
                                                       {.9, .8, 5, 2, .7},
                                                       {.99, .95, 300, 1, .6}}) {
    Adversary adversary{p, c, {1.1, 1.5, 2, 3, 5}};
    const double risk = adversary.risk_at(first, extensions);
    CAPTURE(p, c, first, extensions, risk);
    CHECK(risk <= (1 - c) * (1 + 1e-9));
    CHECK(risk >= least * (1 - c));
  }
}

TEST_CASE("extensions at the boundary pass wrongly about as often as is promised, and a good wing "
          "passes") {
  constexpr double p = .95, c = .9;
  const std::vector<long> runs = doubled(500, 5);
  const auto share_passed = [&](double met, int campaigns) {
    int passed = 0;
    RandomStream stream(5, 0, stream_name("extensions"));
    for (int campaign = 0; campaign < campaigns; ++campaign) {
      long n = 0, failures = 0;
      InterimAnalyses interim;
      std::vector<long> failed;
      for (const long next : runs) {
        for (; n < next; ++n) failures += open_uniform(stream()) > met;
        const auto allowed = passing_rule(interim, n, p, c, failed).allowed;
        if (failures <= *allowed) {
          ++passed;
          break;
        }
        interim.before.push_back(n), failed.push_back(failures);
      }
    }
    return double(passed) / campaigns;
  };
  CHECK(share_passed(p, 1000) == Approx(.098).margin(3 * .0095));
  CHECK(share_passed(.96, 200) > .85); // .95 by a rule for these numbers of runs alone
  // dynamic programming in Python (numpy 1.24), all states kept
  const PassingRule last =
      passing_rule({1, {500, 1000, 2000, 4000}}, 8000, p, c, std::array{25L, 50L, 100L, 200L});
  CHECK(last.joint->risk_alone == Approx(.2545).epsilon(1e-3));
}

TEST_CASE("the more have failed, the fewer of the runs added may") {
  for (const double p : {.5, .9, .95, .99, .9973})
    for (const double c : {.5, .9, .95})
      for (const long first : {8L, 100L, 500L, 3000L}) {
        const long added = first;
        long most = added;
        const auto mean = std::lround((1 - p) * double(first));
        for (long failed = allowed_failures(first, p, c).value_or(-1) + 1; failed < 3 * mean + 5;
             ++failed) {
          const PassingRule rule =
              passing_rule({1, {first}}, first + added, p, c, std::array{failed});
          CAPTURE(p, c, first, failed);
          CHECK(rule.allowed.value_or(-1) <= rule.joint->allowed_alone.value_or(-1));
          if (rule.allowed && rule.confidence < .999)
            CHECK(allowed_failures(first + added, p, rule.confidence) == rule.allowed);
          CHECK(rule.allowed.value_or(-1) - failed <= most);
          most = rule.allowed.value_or(-1) - failed;
        }
      }
}

TEST_CASE("analyses of few runs leave a later one of many all that it may risk, and one of few "
          "more less") {
  const PassingRule rule =
      passing_rule({1, {10, 20}}, 3000, .999, .9, std::array{0L, 0L}); // it takes 2302
  CHECK(rule.allowed == allowed_failures(3000, .999, .9));
  CHECK_FALSE(passing_rule({1, {10}}, 20, .999, .9, std::array{0L}).allowed);
  // 22 runs would do without the 20 before
  for (const auto& [n, passes] : {std::pair{22L, false}, {25L, false}, {35L, true}}) {
    CAPTURE(n);
    const PassingRule next = passing_rule({1, {20}}, n, .9, .9, std::array{0L});
    CHECK((next.joint->allowed_alone.has_value() && next.allowed.has_value() == passes));
  }
}

TEST_CASE(
    "a wing far better than required passes after an extension, and one far worse is disproved") {
  const InterimAnalyses interim{1, {500, 1000, 2000, 4000}};
  CHECK(passing_rule(interim, 8000, .95, .9, std::array{20L, 40L, 80L, 165L}).allowed > 8000 * .04);
  CHECK(is_disproved(interim, 8000, .95, .9, 480, std::array{30L, 60L, 120L, 240L}));
  CHECK_FALSE(is_disproved(interim, 8000, .95, .9, 400, std::array{25L, 50L, 100L, 200L}));
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
    std::vector<long> failed;
    for (const long earlier : before) failed.push_back(std::lround((1 - p) * double(earlier)));
    const PassingRule rule = passing_rule({1, before}, n, p, c, failed);
    std::vector<long> with = before;
    with.push_back(n);
    const PassingRule again = passing_rule({1, with}, n, p, c, failed);
    with.push_back(n + 100);
    const PassingRule later = passing_rule({1, with}, n, p, c, failed);
    CAPTURE(n, p, c);
    for (const PassingRule& each : {again, later})
      CHECK((each.allowed == rule.allowed && each.confidence == rule.confidence));
  }
}
