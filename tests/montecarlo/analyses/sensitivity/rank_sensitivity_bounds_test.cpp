// Confidence bounds of the rank coefficients: their coverage, and what is called idle or seen by them.
#include "distributions/copula.hpp"
#include "distributions/design.hpp"
#include "tests/montecarlo/analyses/sensitivity/rank_support.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("the bounds hold their coefficient as often as they say", "[long]") {
  // population values as in the closed form above; 95 % bounds of 600 samples of 50 runs
  const double c = spearman_correlation(1 / std::sqrt(2.25)),
               other = spearman_correlation(-0.5 / std::sqrt(2.25)),
               partial = c / std::sqrt(1 - other * other);
  int spearman_hits = 0, partial_hits = 0;
  constexpr int samples = 600;
  for (int sample = 0; sample < samples; ++sample) {
    const Columns x = normal_columns(3, 50, 1000 + static_cast<std::uint64_t>(sample));
    const auto effect =
        rank_sensitivity(results_of({x[0], x[1]}, combination(x, {1, -0.5, 1})), 0.95)
            .outputs[0]
            .effects[0];
    spearman_hits += *effect.spearman.bounds.lower <= c && c <= *effect.spearman.bounds.upper;
    partial_hits +=
        *effect.partial.bounds.lower <= partial && partial <= *effect.partial.bounds.upper;
  }
  // the binomial's 4 standard deviations are 0.036
  CHECK(spearman_hits > 0.914 * samples);
  CHECK(spearman_hits < 0.986 * samples);
  CHECK(partial_hits > 0.914 * samples);
  CHECK(partial_hits < 0.986 * samples);
}

TEST_CASE("a dispersion that moves nothing is named, and seldom one that does") {
  int named = 0, wrongly = 0;
  for (std::uint64_t sample = 0; sample < 100; ++sample) {
    const Columns x = normal_columns(6, 200, 5000 + sample);
    Results results = results_of({x[0], x[1]}, combination(x, {0.5, 0, 1}));
    for (std::size_t k = 3; k < 6; ++k) results.outputs.push_back({"noise", x[k]});
    for (const std::string& idle : rank_sensitivity(results, 0.95).idle)
      ++(idle == "x1" ? named : wrongly);
  }
  CHECK(named >= 88); // 95 expected at least, its standard deviation 2.2
  CHECK(wrongly == 0);
}

// Of six strong dispersions the ranks' own variance is not that of a partial coefficient: Fisher's z with
// (1 + r²/2)/(n − g − 3) covers 87 % here, with 1/(n − g − 3) 79 %, in place of 95.
TEST_CASE("the bounds of a partial coefficient hold it as often as they say, close to 1 too",
          "[long]") {
  struct Example {
    std::vector<double> weights; ///< the last one of noise
    double truth;                ///< of the first
  };
  const auto example = GENERATE(values<Example>({{{1, .3, .1, .03, 0}, .991},
                                                 {{1, .6, .3, .1, .3}, .92},
                                                 {{1, 1, 1, 1, 2}, .42},
                                                 {{2, .5, .5, .5, .5, .5, .2}, .97}}));
  const auto& weights = example.weights;
  const std::size_t draws = weights.size() - 1;
  double variance = 0, others = 0;
  for (const double weight : weights) variance += weight * weight;
  for (std::size_t j = 1; j < draws; ++j)
    others += std::pow(spearman_correlation(weights[j] / std::sqrt(variance)), 2);
  const double truth =
      spearman_correlation(weights[0] / std::sqrt(variance)) / std::sqrt(1 - others);
  REQUIRE(truth == Approx(example.truth).margin(.02));
  const int runs = GENERATE(100, 400, 1600);
  if (runs == 1600 && random_cases(1, 0) == 0) return;
  const int samples = random_cases(1000, runs == 100 ? 300 : 100);
  int hits = 0, given = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const Columns x = normal_columns(weights.size(), std::size_t(runs),
                                     9000 + static_cast<std::uint64_t>(sample));
    const Results results = results_of({x.begin(), x.end() - 1}, combination(x, weights));
    const Bounds bounds = rank_sensitivity(results, 0.9).outputs[0].effects[0].partial.bounds;
    given += bounds.lower.has_value();
    hits += bounds.lower && *bounds.lower <= truth && truth <= *bounds.upper;
  }
  INFO(hits << " of " << given << " in " << samples << ", " << runs << " runs, " << truth);
  CHECK(given >= (runs == 100 ? .9 : 1) * samples);
  const double error = std::sqrt(.09 / given);
  CHECK(std::abs(hits / double(given) - (runs == 100 ? .925 : .9)) < .02 + 3 * error);
}

TEST_CASE(
    "where one dispersion dominates, partial coefficients have no bounds rather than wrong ones") {
  const double weight = GENERATE(.2, .1, .05, .02, .005); // of the other dispersion
  const int runs = GENERATE(50, 200);
  const double other = spearman_correlation(weight / std::hypot(1, weight)),
               own = spearman_correlation(1 / std::hypot(1, weight)),
               truth = other / std::sqrt(1 - own * own);
  constexpr int samples = 100;
  int given = 0, wrong = 0;
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    const Columns x = normal_columns(2, std::size_t(runs), 400 + sample);
    const RankEffect effect =
        rank_sensitivity(results_of(x, combination(x, {1, weight})), 0.9).outputs[0].effects[1];
    REQUIRE(effect.spearman.bounds.lower);
    if (!effect.partial.bounds.lower) continue;
    ++given;
    wrong += truth < *effect.partial.bounds.lower || *effect.partial.bounds.upper < truth;
  }
  INFO(wrong << " of " << given << " wrong, weight " << weight << ", " << runs << " runs");
  CHECK(wrong <= .1 * samples + 3 * std::sqrt(.09 * samples));
  if (weight <= .02) CHECK(given == 0);
}

namespace {

/// Runs of x0 + x1 over Sobol' points in so many replicates, run k in replicate k mod R.
Results sobol_sum(std::uint64_t seed, long runs, int replicates, RunsMade& made) {
  const PreparedDesign design({DesignKind::sobol, seed, static_cast<std::uint64_t>(runs),
                               static_cast<std::uint64_t>(replicates)},
                              {"x0", "x1"});
  Columns x(2);
  std::vector<double> y;
  made.replication.replicates = replicates;
  for (long k = 0; k < runs; ++k) {
    for (std::size_t j = 0; j < 2; ++j)
      x[j].push_back(design.uniform(static_cast<std::uint64_t>(k), j));
    y.push_back(x[0].back() + x[1].back());
    made.replication.of_row.push_back(static_cast<int>(k % replicates));
  }
  return results_of(x, y);
}

} // namespace

// Spearman's of u and u + v, both uniform: F(s) = s²/2 below 1 and 1 − (2 − s)²/2 above, E F(u + v) u =
// 1/2 · 1/2 + cov, cov = ∫∫ (u − 1/2) F = 7/120, so that ρ = 12 · 7/120 = 0.7.
TEST_CASE("bounds of draws that depend on each other come from their replicates", "[long]") {
  int hits = 0;
  constexpr int designs = 200;
  double width = 0;
  for (int k = 0; k < designs; ++k) {
    RunsMade made;
    const Results results = sobol_sum(static_cast<std::uint64_t>(k), 512, 8, made);
    const RankSensitivity all = rank_sensitivity(results, 0.9, made);
    CHECK(all.replicates == 8);
    const Bounds bounds = all.outputs[0].effects[0].spearman.bounds;
    hits += *bounds.lower <= 0.7 && 0.7 <= *bounds.upper;
    width += (*bounds.upper - *bounds.lower) / designs;
  }
  CHECK(hits > 0.82 * designs); // the binomial's 4 standard deviations are 0.085
  const Bounds independent = rank_correlation_bounds(0.7, 512, 0.9);
  CHECK(width < 0.25 * (*independent.upper - *independent.lower)); // what the points gain
}

TEST_CASE("replicates tell what moves an output either way from what moves nothing") {
  constexpr long runs = 512;
  const PreparedDesign design({DesignKind::sobol, 5, runs, 8}, {"x0", "x1", "x2"});
  RunsMade made;
  made.replication.replicates = 8;
  Columns x(3);
  std::vector<double> y;
  for (long k = 0; k < runs; ++k) {
    for (std::size_t j = 0; j < 3; ++j)
      x[j].push_back(design.uniform(static_cast<std::uint64_t>(k), j));
    y.push_back(x[0].back() - x[1].back());
    made.replication.of_row.push_back(static_cast<int>(k % 8));
  }
  const RankSensitivity all = rank_sensitivity(results_of(x, y), 0.9, made);
  const auto& effects = all.outputs[0].effects;
  CHECK((effects[0].seen && effects[0].spearman.value > 0));
  CHECK((effects[1].seen && effects[1].spearman.value < 0));
  CHECK_FALSE(effects[2].seen);
  CHECK(all.idle == std::vector<std::string>{"x2"});
}

TEST_CASE("runs of one replicate have no bounds, and no dispersion is called idle for it") {
  RunsMade made;
  const Results results = sobol_sum(1, 256, 1, made);
  const RankSensitivity all = rank_sensitivity(results, 0.95, made);
  CHECK(all.outputs[0].effects[0].spearman.value == Approx(0.7).margin(0.05));
  CHECK(!all.outputs[0].effects[0].spearman.bounds.lower);
  CHECK(!all.outputs[0].effects[0].partial.bounds.lower);
  CHECK(all.idle.empty());
}

TEST_CASE("the result says how the runs were made, and of which") {
  const Columns x = normal_columns(2, 60, 4);
  const RunsMade made{.replication = {}, .interim = {3}, .rows = {{"fitted", {"x0", "x1"}}}};
  const RankSensitivity all = rank_sensitivity(results_of(x, x[0]), 0.9, made);
  CHECK(all.runs == 60);
  CHECK(all.confidence == 0.9);
  CHECK(all.dispersions == std::vector<std::string>{"x0", "x1"});
  CHECK(all.interim.planned == 3);
  CHECK(all.replicates == 0);
  CHECK(all.rows == made.rows);
}

TEST_CASE("a campaign that may stop at several looks shares its risk out among them") {
  const Columns x = normal_columns(3, 200, 12);
  const Results results = results_of({x[0], x[1]}, combination(x, {1, -0.5, 1}));
  const auto effect = [&](double confidence, long looks) {
    return rank_sensitivity(results, confidence, {{}, {looks}}).outputs[0].effects[0];
  };
  CHECK(*effect(0.9, 5).spearman.bounds.lower == *effect(0.98, 1).spearman.bounds.lower);
  CHECK(*effect(0.9, 5).partial.bounds.upper == *effect(0.98, 1).partial.bounds.upper);
  CHECK(*effect(0.9, 5).partial.bounds.upper > *effect(0.9, 1).partial.bounds.upper);
}

// Of 40 runs 19 other dispersions leave 21: a partial coefficient's errors are 1.5 times what they would be without.
TEST_CASE("few runs of many dispersions that move nothing show hardly any", "[long]") {
  constexpr std::size_t dispersions = 20, samples = 100;
  long seen = 0;
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    Columns x = normal_columns(dispersions + 1, 40, 9000 + sample);
    const std::vector<double> y = x.back();
    x.pop_back();
    const RankSensitivity all = rank_sensitivity(results_of(x, y), 0.95);
    for (const RankEffect& effect : all.outputs[0].effects) seen += effect.seen;
  }
  // Two coefficients of each are looked at, at 2.5 % each: at most 5 % of 2000, with a standard deviation of 10. At
  // 5 % each it would be 192, and 280 where the 19 are forgotten.
  CAPTURE(seen);
  CHECK(seen < 140);
  CHECK(seen > 30);
}
