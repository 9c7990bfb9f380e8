#include "montecarlo/analyses/rare/subset_simulation.hpp"
#include "tests/montecarlo/analyses/rare/limit_states.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("levels climb over ties of a quantity that takes few values") {
  const int needed = GENERATE(4, 5); // of six values that are each low with probability 0.1
  const auto labels =
      GENERATE(std::vector<std::size_t>{}, std::vector<std::size_t>{0, 1, 2, 3, 4, 5});
  const double low = -1.2815515655446004;
  const LimitStateFunction g = limit_state([&](const NormalPoint& z) {
    return needed - 0.5 -
           static_cast<double>(std::ranges::count_if(z, [&](double x) { return x < low; }));
  });
  const boost::math::binomial law(6, 0.1);
  const double p = cdf(complement(law, needed - 1));
  constexpr int seeds = 60;
  int missed = 0;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    std::vector<SubsetEstimate> estimates;
    for (std::uint64_t k = 0; k < 5; ++k)
      estimates.push_back(subset_simulation(
          g, 6, {.samples = 500, .seed = seed, .repetition = k, .labels = labels}));
    const RareEstimate found = combined(estimates, 0.9);
    missed += !(found.interval.lower <= p && p <= found.interval.upper);
    sum += found.probability;
  }
  INFO(needed << " low values, P = " << p << ", labels: " << labels.size());
  CHECK(missed <= 6 + 3 * 2.4);
  CHECK(sum / seeds == Approx(p).epsilon(0.15));
}

TEST_CASE(
    "an event that no run has: the smaller of the bounds by the last levels and by the first") {
  const auto bound = [](const PointFunction& g, double smallest) {
    std::vector<SubsetEstimate> estimates;
    for (std::uint64_t k = 0; k < 5; ++k)
      estimates.push_back(subset_simulation(
          limit_state(g), 2, {.samples = 500, .smallest = smallest, .seed = 3, .repetition = k}));
    return combined(estimates, 0.95);
  };
  const double counted = 1 - std::pow(0.025, 1 / 2500.); // 0 of 2,500: Clopper–Pearson
  const RareEstimate halves = bound([](const NormalPoint& z) { return z[0] < 0 ? 1 : 2; }, 1e-10);
  CHECK((halves.plain && halves.hits == 0 && halves.draws == 2500));
  CHECK(halves.probability == 0);
  CHECK(halves.bias == 0);
  CHECK(halves.interval.lower == 0);
  CHECK(halves.interval.upper == Approx(counted).epsilon(1e-12));
  const RareEstimate far = bound([](const NormalPoint& z) { return 40 - z[0]; }, 1e-6);
  CHECK_FALSE((far.plain || far.reached));
  CHECK(far.interval.upper < counted);
}

TEST_CASE("where only the event lies below a tie, its share is the estimate") {
  std::vector<double> g(500, 1.0);
  for (std::size_t k = 0; k < 40; ++k) g[k] = -1 - static_cast<double>(k);
  const SubsetEstimate found = subset_simulation(never_nearer(g), 2, {.samples = 500, .seed = 1});
  CHECK((found.stuck && found.reached));
  CHECK(found.levels.size() == 1);
  CHECK(found.probability == Approx(0.08).epsilon(1e-12));
  CHECK(found.inside.size() == 40);
}

TEST_CASE("chains that start from the same point count as one in the variation") {
  std::vector<double> g(500, 2.0);
  std::fill_n(g.begin(), 40, 1.0); // fewer than the 50 chains
  const SubsetEstimate found = subset_simulation(never_nearer(g), 2, {.samples = 500, .seed = 1});
  REQUIRE(found.levels.size() == 2);
  CHECK(found.levels[0].share == Approx(0.08).epsilon(1e-12));
  CHECK(found.levels[1].share == 1);
  std::fill_n(g.begin(), 8, 0.5); // a fifth of those; their ten copies of 40 start 50 chains
  const SubsetEstimate nearer = subset_simulation(never_nearer(g), 2, {.samples = 500, .seed = 1});
  REQUIRE(nearer.levels.size() >= 2);
  const SubsetLevel& level = nearer.levels[1];
  CHECK(level.variation == Approx(std::sqrt((1 - level.share) / (level.share * 500) *
                                            (1 + level.correlation) * 1.25)));
}
