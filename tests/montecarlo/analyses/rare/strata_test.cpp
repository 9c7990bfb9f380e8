#include "distributions/copula.hpp"
#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "tests/montecarlo/analyses/rare/lid_support.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A release that fails with this probability, after a delay of 5 ± 0.4 s.
Json failing_lid(double probability) {
  Json json = lid();
  json["dispersions"] = {discrete_law("nofire", {0, 1}, {1 - probability, probability}, "set",
                                      "hinges.h.release.fails"),
                         normal_law("D", 5, 0.4, "set", "hinges.h.release.delay")};
  return json;
}

double upper_tail(double beta) { return std::erfc(beta / std::sqrt(2)) / 2; }

/// How many of the seeds' bounds cover the probability.
int covered(Json campaign, RareOptions options, double exact, int seeds) {
  int count = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    campaign["sampling"]["seed"] = seed;
    const RareEstimate found = estimate_of(campaign, options).estimate;
    INFO("seed " << seed << ": " << found.interval.lower << " … " << found.interval.upper);
    CHECK(found.interval.lower > 0);
    CHECK(found.interval.upper < 3 * exact);
    count +=
        found.interval.lower <= exact * (1 + 1e-12) && exact <= found.interval.upper * (1 + 1e-12);
  }
  return count;
}

double sum_of_probabilities(const Strata& strata) {
  double sum = strata.left_out;
  for (const Stratum& stratum : strata.list) sum += stratum.probability;
  return sum;
}

} // namespace

TEST_CASE("a release that fails once in 100,000: bounds of all seeds cover it", "[rare][long]") {
  const int seeds = random_cases(12, 6);
  const RareOptions options{.samples = 200, .repeats = 3};
  CHECK(covered(failing_lid(1e-5), options, 1e-5, seeds) == seeds); // certain within the stratum
  CHECK(covered(failing_lid(5e-4), options, 5e-4, seeds) == seeds);
}

TEST_CASE("a rare stiffness among common ones, and a rare failure beside late deployments",
          "[rare][long]") {
  const int seeds = random_cases(12, 6);
  Json island = lid();
  island["scene"]["hinges"][0].erase("release");
  island["dispersions"] = {
      discrete_law("k", {2000, 9000}, {0.9997, 0.0003}, "set", "hinges.h.latch.stiffness"),
      normal_law("s", 1, 0.05, "scale", "hinges.h.spring.scale")};
  CHECK(covered(island, {.event = {"h.peak_moment", 120, true}, .samples = 200, .repeats = 3}, 3e-4,
                seeds) >= seeds - seeds / 6);
  // it latches later than 8 s: never, or after a delay of 8 s less the travel's time
  const double late = upper_tail((8 - std::sqrt(2 * 1.5 / 1.2) - 5) / 0.4);
  const double exact = 5e-4 + (1 - 5e-4) * late;
  CHECK(covered(failing_lid(5e-4),
                {.event = {"h.latch_time", 8, true}, .samples = 500, .repeats = 5}, exact,
                seeds) >= seeds - seeds / 6);
}

TEST_CASE("two rare values that only together stall the wing: one in a million", "[rare]") {
  Json json = lid();
  json["scene"]["hinges"][0]["friction"] = {{"coulomb", 0.1}, {"model", "exact"}};
  const std::string friction = "hinges.h.friction.coulomb";
  json["dispersions"] = {discrete_law("a", {0, 0.7}, {0.999, 0.001}, "add", friction),
                         discrete_law("b", {0, 0.7}, {0.999, 0.001}, "add", friction),
                         normal_law("s", 1, 0.01, "scale", "hinges.h.spring.scale")};
  const RareResult found = estimate_of(json, {.samples = 500, .repeats = 3});
  CHECK(found.strata.size() == 4);
  CHECK(found.estimate.probability == Approx(1e-6).epsilon(0.01));
  CHECK(found.estimate.interval.lower <= 1e-6);
  CHECK(found.estimate.interval.upper >= 1e-6);
  REQUIRE(found.likeliest);
  CHECK(found.likeliest->draws[0] == 0.7);
  CHECK(found.likeliest->draws[1] == 0.7);
}

TEST_CASE("strata share all probability, and are one without rare values", "[rare]") {
  const auto strata = [](const Json& json, long samples = 2000) {
    return strata_of(campaign_of(json), {.samples = samples});
  };
  CHECK(strata(rare_values(1, 0.3)).list.size() == 1);
  CHECK(strata(rare_values(1, 0.3)).unseen.empty());
  CHECK(strata(rare_values(1, 0.016)).list.size() == 1); // 32 runs of a level have it
  CHECK(strata(rare_values(1, 0.014)).list.size() == 2);
  const Strata ten = strata(rare_values(10, 1e-3));
  REQUIRE(ten.list.size() ==
          65); // none, one or two of ten are 56; three have 1e-9 each, 112 of them together
  CHECK(ten.list.back().others.size() == 112);
  CHECK(ten.list.back().probability == Approx(112e-9).epsilon(0.01));
  CHECK(ten.list[55].rare.size() == 2);
  CHECK(ten.list.front().rare.empty());
  CHECK(ten.list.front().probability == Approx(std::pow(0.999, 10)));
  CHECK(sum_of_probabilities(ten) == Approx(1).epsilon(1e-12));
  CHECK(ten.left_out < 1e-9);
  Json doubled = lid(); // equal values of an empirical law are one
  std::vector<double> values(999, 1.0);
  values.push_back(1.5);
  doubled["dispersions"] = {{{"name", "e"},
                             {"distribution", {{"type", "empirical"}, {"values", values}}},
                             {"apply", "scale"},
                             {"to", {"bodies.lid.inertia"}}}};
  REQUIRE(strata(doubled).list.size() == 2);
  CHECK(strata(doubled).list[1].probability == Approx(1e-3));
  CHECK(describe(strata(doubled).list[1]) == "e = 1.5");
}

TEST_CASE(
    "strata fall in probability, and one that is too improbable is left out, also the only one",
    "[rare]") {
  Json json = lid();
  json["dispersions"] = {discrete_law("d", {1, 1.001, 1.002, 1.003}, {0.994, 1e-4, 5e-3, 9e-4},
                                      "scale", "bodies.lid.inertia")};
  const auto strata = [&](double smallest) {
    return strata_of(campaign_of(json), {.samples = 2000, .smallest = smallest});
  };
  const Strata all = strata(1e-10);
  REQUIRE(all.list.size() == 4);
  CHECK(describe(all.list[0]) == "no rare value");
  CHECK(describe(all.list[1]) == "d = 1.002");
  CHECK(describe(all.list[2]) == "d = 1.003");
  CHECK(describe(all.list[3]) == "d = 1.001");
  CHECK(all.left_out == 0);
  for (const auto& [smallest, left, left_out] :
       {std::tuple{5e-4, 3, 1e-4}, {2e-3, 2, 1e-3}, {2e-2, 1, 6e-3}}) {
    const Strata some = strata(smallest);
    CHECK(std::ssize(some.list) == left);
    CHECK(some.left_out == Approx(left_out).epsilon(1e-9));
    CHECK(sum_of_probabilities(some) == Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("draws of a stratum have its value, and correlated draws their conditional law",
          "[rare]") {
  constexpr double p = 1e-4, rho = 0.7;
  Json json = lid();
  json["dispersions"] = {
      discrete_law("z_rare", {1, 2, 3}, {0.5, p, 0.5 - p}, "scale", "bodies.lid.inertia"),
      normal_law("a_normal", 1, 1e-3, "scale", "hinges.h.spring.scale")};
  json["correlations"] = {{{"between", {"a_normal", "z_rare"}}, {"spearman", rho}}};
  const Campaign campaign = campaign_of(json);
  const Strata strata = strata_of(campaign, {});
  REQUIRE(strata.list.size() == 2);
  const Stratum& rare = strata.list[1];
  CHECK(rare.probability == Approx(p).epsilon(1e-12));
  constexpr long runs = 4000;
  std::vector<NormalPoint> points;
  RandomStream random(1, 0, stream_name("strata"));
  const auto normal_draw = [&] {
    return inverse(Normal{}, tails_of_uniform(open_uniform(random())));
  };
  for (long k = 0; k < runs; ++k) points.push_back(within(rare, {normal_draw(), normal_draw()}));
  const RunPlan plan(campaign, [&](long k, std::span<Tails> u) {
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = unit_point(points[static_cast<std::size_t>(k)][i]);
  });
  double sum = 0, square = 0;
  for (long k = 0; k < runs; ++k) {
    std::vector<double> draws(2);
    plan.draw(k, draws);
    CHECK(draws[0] == 2);
    const double z = (draws[1] - 1) / 1e-3;
    sum += z, square += z * z;
  }
  // between Φ⁻¹(0.5) and Φ⁻¹(0.5001) the discrete law's normal variable is 1.25e-4: the other one is
  // normal about r times that, with the variance 1 − r²
  const double r = normal_correlation(rho), variance = 1 - r * r;
  CHECK(std::abs(sum / runs - r * 1.25e-4) < 4 * std::sqrt(variance / runs));
  CHECK(std::abs(square / runs - variance) < 4 * variance * std::sqrt(2.0 / runs));
}

TEST_CASE("values that no first level may draw keep the upper bound at that of plain sampling",
          "[rare]") {
  Json json = lid();
  std::vector<double> values;
  for (int k = 0; k < 5000; ++k) values.push_back(1 + 1e-6 * k);
  json["dispersions"] = {{{"name", "measured"},
                          {"distribution", {{"type", "empirical"}, {"values", values}}},
                          {"apply", "scale"},
                          {"to", {"hinges.h.spring.scale"}}},
                         normal_law("J", 1, 0.02, "scale", "bodies.lid.inertia")};
  const RareOptions options{.event = {"h.latch_time", 1.75, true}, .samples = 200, .repeats = 2};
  const RareResult found = estimate_of(json, options);
  REQUIRE(found.unseen.size() == 1);
  CHECK(found.unseen[0].first == "measured");
  CHECK(found.unseen[0].second == Approx(400.0 / 5000));
  CHECK(found.estimate.interval.upper >= clopper_pearson(0, 400, 0.95).upper);
  CHECK(doubts_of(found).back().find("\"measured\"") != std::string::npos);
  values.resize(20); // each is drawn 20 times
  json["dispersions"][0]["distribution"]["values"] = values;
  CHECK(estimate_of(json, options).unseen.empty());
}

TEST_CASE("the report of strata has each one's probability, and the sum", "[rare]") {
  const RareOptions options{.samples = 200, .repeats = 2};
  const Json campaign = failing_lid(1e-5);
  const RareResult found = estimate_of(campaign, options);
  const std::string text = rare_text(found, options, campaign_of(campaign));
  CHECK_THAT(text, Catch::Contains("P(not deployed) = 1e-05, 95 % bounds") &&
                       Catch::Contains("nofire = 1") && Catch::Contains("no rare value"));
  const Json json = rare_json(found, options, campaign_of(campaign), {});
  CHECK(json["method"] == "stratified_subset_simulation");
  REQUIRE(json["strata"].size() == 2);
  CHECK(json["strata"][1]["rare_values"]["nofire"] == 1);
  CHECK(json["strata"][1]["probability"].get<double>() == Approx(1e-5));
  CHECK(json["strata"][1]["event"] == 1);
  CHECK(json["warnings"].empty());
}

TEST_CASE("the progress over strata never runs backwards nor beyond the end", "[rare]") {
  Json json = rare_values(2, 1e-3);
  json["dispersions"].push_back(normal_law("s", 1, 0.05, "scale", "hinges.h.spring.scale"));
  ThreadEvaluator evaluator({.threads = 1}, never);
  StudyProgress last;
  double share = 0;
  const RareResult result = estimate_rare_event(
      campaign_of(json), {.event = {"h.latch_time", 1.7, true}, .samples = 200, .repeats = 2},
      evaluator, [&](const StudyProgress& now) {
        CHECK(now.runs <= now.most_runs);
        const double its = static_cast<double>(now.runs) / static_cast<double>(now.most_runs);
        CHECK(its >= share);
        share = its;
        last = now;
      });
  CHECK(result.strata.size() == 4);
  CHECK(last.runs == result.estimate.evaluations);
}

TEST_CASE("levels of common draws end where all strata add less than a thousandth to the sum",
          "[rare]") {
  Json json = lid();
  json["dispersions"] = {normal_law("D", 5, 0.4, "set", "hinges.h.release.delay")};
  for (int k = 0; k < 5; ++k) // each makes it late by 10 s
    json["dispersions"].push_back(discrete_law("late" + std::to_string(k), {0, 10}, {0.999, 1e-3},
                                               "add", "hinges.h.release.delay"));
  const RareResult found = estimate_of(
      json, {.event = {"h.latch_time", 12, true}, .samples = 100, .repeats = 1, .smallest = 1e-12});
  const auto count = static_cast<double>(found.strata.size());
  CHECK(count > 10);
  CHECK(found.estimate.probability == Approx(1 - std::pow(0.999, 5)).epsilon(0.01));
  const double least = 1e-3 * found.estimate.probability / count; // of one stratum
  for (const SubsetEstimate& estimate : found.strata[0].estimates) {
    CHECK_FALSE(estimate.reached); // 13 standard deviations away
    const double last = estimate.last_level * found.strata[0].stratum.probability;
    CHECK((last < 2 * least && last > least / 20));
  }
}

TEST_CASE(
    "levels of rare values end at the smallest probability of the draws and the event together",
    "[rare]") {
  Json json = lid();
  json["dispersions"] = {
      normal_law("D", 5, 0.4, "set", "hinges.h.release.delay"),
      discrete_law("late", {0, 10}, {0.999, 1e-3}, "add", "hinges.h.release.delay")};
  const RareResult found = estimate_of(
      json, {.event = {"h.latch_time", 99, true}, .samples = 100, .repeats = 1, .smallest = 1e-7});
  REQUIRE(found.strata.size() == 2);
  for (const StratumEstimate& part : found.strata)
    for (const SubsetEstimate& estimate : part.estimates) {
      CHECK_FALSE(estimate.reached);
      const double last = estimate.last_level * part.stratum.probability;
      CAPTURE(part.stratum.probability, last);
      CHECK((last < 2e-7 && last > 1e-7 / 20));
    }
}

namespace {

/// A stratum of probability w in which the event has the probability p, or at most `upper` if no repeat reached it.
StratumEstimate part_of(double w, double p, const Interval& interval, double variation,
                        bool reached) {
  StratumEstimate part;
  part.stratum.probability = w;
  part.estimates.resize(3);
  for (SubsetEstimate& estimate : part.estimates) estimate.reached = reached;
  part.estimate.probability = p, part.estimate.interval = interval;
  part.estimate.reached = reached;
  part.estimate.variation = variation, part.estimate.from_chains = 0.8 * variation;
  part.estimate.from_spread = variation, part.estimate.bias = 0.1 * variation;
  part.estimate.evaluations = 1000, part.estimate.draws = 300, part.estimate.hits = 2;
  return part;
}

} // namespace

TEST_CASE("a sum over strata is weighed by their probabilities, and its errors by the squares",
          "[rare]") {
  const auto seen = part_of(0.9, 1e-3, {4e-4, 3e-3}, 0.3, true);
  const auto likely = part_of(1e-3, 0.5, {0.2, 0.9}, 0.2, true);
  const auto silent = part_of(2e-4, 1e-4, {0, 1e-2}, 0.5, false);
  const double a = 0.9 * 1e-3, b = 1e-3 * 0.5, p = a + b;
  for (const double left_out : {0.0, 3e-5}) {
    const RareEstimate sum = sum_of({seen, likely, silent}, left_out);
    CHECK(sum.probability == Approx(p).epsilon(1e-12)); // the silent one adds nothing
    CHECK(sum.variation == Approx(std::hypot(0.3 * a, 0.2 * b) / p).epsilon(1e-12));
    CHECK(sum.from_chains == Approx(0.8 * sum.variation).epsilon(1e-12));
    CHECK(sum.bias == Approx((0.03 * a + 0.02 * b) / p).epsilon(1e-12));
    CHECK(sum.interval.lower == Approx(p - std::hypot(0.9 * 6e-4, 1e-3 * 0.3)).epsilon(1e-12));
    CHECK(sum.interval.upper ==
          Approx(p + std::hypot(0.9 * 2e-3, 1e-3 * 0.4) + 2e-4 * 1e-2 + left_out)
              .epsilon(1e-12)); // both may be certain to fail
    CHECK(sum.reached ==
          (left_out == 0)); // 2e-6 is less than a hundredth of 1.4e-3, 3.2e-5 is more
    CHECK((sum.evaluations == 3000 && sum.draws == 900 && sum.hits == 6));
    CHECK(sum.plain_runs == Approx((1 - p) / (p * sum.variation * sum.variation)).epsilon(1e-12));
    const RareEstimate turned = sum_of({silent, likely, seen}, left_out);
    CHECK(turned.probability == Approx(sum.probability).epsilon(1e-12));
    CHECK(turned.interval.upper == Approx(sum.interval.upper).epsilon(1e-12));
    CHECK(turned.interval.lower == Approx(sum.interval.lower).epsilon(1e-12));
  }
  const RareEstimate none = sum_of({silent, silent}, 1e-6);
  CHECK_FALSE(none.reached);
  CHECK(none.probability == Approx(2 * 2e-4 * 1e-4).epsilon(1e-12)); // of the last levels
  CHECK(none.interval.lower == 0);
  CHECK(none.interval.upper >= 2 * 2e-4 * 1e-2 + 1e-6 - 1e-12);
}
