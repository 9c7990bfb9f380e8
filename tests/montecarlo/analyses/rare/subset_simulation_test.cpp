#include "distributions/random_stream.hpp"
#include "montecarlo/analyses/rare/subset_simulation.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "tests/montecarlo/analyses/rare/limit_states.hpp"
#include "tests/support/random_cases.hpp"

#include <boost/math/distributions/normal.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numeric>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a linear limit state, β = 4: 3.16712e-5 within 20 % at 60,000 evaluations", "[long]") {
  // Over seeds, since one of them proves nothing: an error of 20 % is to be two standard deviations
  // of the estimate, and its mean right within what 24 estimates can show.
  constexpr int seeds = 24;
  const double exact = normal_tail(4);
  REQUIRE(exact == Approx(3.16712e-5).epsilon(1e-5));
  double sum = 0, square = 0, variation = 0;
  int close = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const RareEstimate found = repeated(linear(4), 5, 2000, 6, seed);
    CHECK(found.reached);
    CHECK(found.evaluations <= 60'000);
    CHECK(!found.plain_is_enough());
    const double error = found.probability / exact - 1;
    sum += error;
    square += error * error;
    variation += found.from_chains;
    close += std::abs(error) <= 0.2;
    covered += found.interval.lower <= exact && exact <= found.interval.upper;
  }
  const double spread = std::sqrt(square / seeds);
  CHECK(std::abs(sum / seeds) < 0.06); // 0.1/√24 is 0.02; the method's own bias is as much
  CHECK(spread < 0.13);                // 0.1, and three of its own standard errors are 0.04
  CHECK(close >= 20);                  // 22.9 expected
  CHECK(covered >= 20);                // 22.8 expected at least
  CHECK(variation / seeds == Approx(spread).epsilon(0.4)); // what is claimed is what is seen
}

TEST_CASE("one in a million, in many dimensions as in one") {
  const double exact = normal_tail(4.75); // 1.017e-6
  for (const std::size_t d : {1u, 40u}) {
    const RareEstimate found = repeated(linear(4.75), d, 2000, 4, 3);
    CHECK(found.reached);
    CHECK(found.evaluations < 55'000);
    CHECK(std::abs(std::log(found.probability / exact)) < 0.5); // 4 standard deviations of 0.12
    CHECK(found.interval.lower < exact);
    CHECK(found.interval.upper > exact);
  }
}

TEST_CASE("a bent limit state with two ends agrees with counting, at 1e-3 and 1e-4") {
  // beyond either of two curves, on opposite sides
  const auto g = [](double reach) {
    return [reach](const NormalPoint& z) {
      const double bend = 0.1 * (z[2] * z[2] + z[3]);
      return std::min(reach - z[0] + bend, reach + 0.3 + z[1] + 0.2 * z[0] * z[2]);
    };
  };
  for (const double reach : {2.8, 3.5}) {
    constexpr long n = 1'000'000;
    long hits = 0;
    const PointFunction at = g(reach);
    RandomStream stream(9, 0, stream_name("count"));
    NormalPoint z(4);
    for (long k = 0; k < n; ++k) {
      for (std::size_t i = 0; i < 4; i += 2) { // Box and Muller: another way than the code's own
        const double r = std::sqrt(-2 * std::log(open_uniform(stream())));
        const double turn = 2 * 3.14159265358979324 * open_uniform(stream());
        z[i] = r * std::cos(turn), z[i + 1] = r * std::sin(turn);
      }
      hits += at(z) < 0;
    }
    const RareEstimate found = repeated(at, 4, 2000, 5, 17);
    const double counted = double(hits) / n, error = 1 / std::sqrt(double(hits));
    INFO("counted " << counted << ", found " << found.probability);
    CHECK(hits > 80);
    CHECK(hits < 5000);
    CHECK(std::abs(std::log(found.probability / counted)) <
          3.5 * std::hypot(found.variation, error));
  }
}

TEST_CASE("a likely event is plain sampling, and says that it would have been enough") {
  const SubsetEstimate once =
      subset_simulation(limit_state(linear(0.5)), 3, {.samples = 1000, .seed = 1});
  REQUIRE(once.levels.size() == 1);
  CHECK(once.evaluations == 1000);
  CHECK(std::ssize(once.inside) == std::lround(1000 * once.probability));
  CHECK(once.variation == Approx(std::sqrt((1 - once.probability) / (1000 * once.probability))));
  const RareEstimate found = combined(std::vector{once}, 0.95);
  CHECK(found.plain_is_enough());
  CHECK(found.plain_runs == Approx(1000));
  CHECK((found.plain && found.hits == std::ssize(once.inside) && found.draws == 1000));
  CHECK(std::isnan(found.from_spread));
  CHECK(found.interval.lower < normal_tail(0.5));
  CHECK(found.interval.upper > normal_tail(0.5));
}

TEST_CASE("levels come nearer, a tenth at a time, and half the moves are taken") {
  const SubsetEstimate found =
      subset_simulation(limit_state(linear(4)), 6, {.samples = 2000, .seed = 5});
  REQUIRE(found.levels.size() == 5);
  double product = 1;
  for (std::size_t k = 0; k < 5; ++k) {
    const SubsetLevel& level = found.levels[k];
    product *= level.share;
    if (k < 4) {
      CHECK(level.share >= 0.1); // a move that is not taken leaves two points alike
      CHECK(level.share < 0.105);
      CHECK(level.threshold > found.levels[k + 1].threshold);
    }
    if (k == 0) {
      CHECK(std::isnan(level.taken));
      CHECK(level.correlation == 0);
    } else {
      CHECK(level.taken == Approx(0.44).margin(0.1));
      CHECK(level.correlation > 0.3);
    }
  }
  CHECK(found.levels.back().threshold == 0);
  CHECK(found.probability == product);
  CHECK(found.evaluations == 2000 + 4 * 1800);
  for (const NormalPoint& point : found.inside) CHECK(linear(4)(point) < 0);
}

TEST_CASE("an event that there is not comes to an end, below a bound") {
  const SubsetEstimate found =
      subset_simulation(limit_state(linear(30)), 2, {.samples = 500, .smallest = 1e-6, .seed = 1});
  CHECK(!found.reached);
  CHECK(!found.stuck);
  CHECK(found.inside.empty());
  CHECK(found.probability < 1.1e-6);
  CHECK(found.probability > 0.9e-7);
  const RareEstimate all = combined(std::vector{found}, 0.95);
  CHECK(!all.reached);
  CHECK(!all.plain_is_enough());
  CHECK(all.interval.lower == 0);
}

TEST_CASE("a limit state that tells points apart no more is found out") {
  const auto step = [](const NormalPoint& z) { return z[0] > 9 ? -1.0 : std::max(1.0, 2 - z[0]); };
  const SubsetEstimate found = subset_simulation(limit_state(step), 2, {.samples = 500, .seed = 1});
  CHECK(found.stuck);
  CHECK(!found.reached);
  const auto counted = [](const NormalPoint& z) { return z[0] > 2 ? -1.0 : 1.0; };
  const SubsetEstimate plain =
      subset_simulation(limit_state(counted), 2, {.samples = 5000, .seed = 1});
  CHECK(plain.stuck); // but counting has found it
  CHECK(plain.reached);
  CHECK(plain.probability ==
        Approx(normal_tail(2)).epsilon(0.35)); // 114 points: 3.5 of their errors
}

TEST_CASE("chains that do not move are worth a point each: their correlation is that of copies") {
  std::vector<double> ranks(100);
  std::iota(ranks.begin(), ranks.end(), 1.0);
  const SubsetEstimate found =
      subset_simulation(never_nearer(ranks), 2, {.samples = 100, .smallest = 0.01, .seed = 1});
  REQUIRE(found.levels.size() == 2);
  CHECK(found.levels[0].threshold == 10);
  CHECK(found.levels[1].taken == 0);
  CHECK(found.levels[1].threshold == 1); // the ten copies of the best
  CHECK(found.levels[1].share == Approx(0.1));
  // r(k) = 1: γ = 2 Σ (1 − k/10) = 9, and so (3) has the hundred points as ten
  CHECK(found.levels[1].correlation == Approx(9).epsilon(1e-12));
  CHECK(found.levels[1].variation == Approx(std::sqrt(0.9 / (0.1 * 10))).epsilon(1e-12));
}

TEST_CASE("where half the points are alike, chains start all over them") {
  std::vector<double> g(100, 2.0);
  std::fill_n(g.begin(), 50, 1.0);      // at the threshold
  std::fill_n(g.begin() + 45, 5, -1.0); // a tenth of those: in the event
  const SubsetEstimate found = subset_simulation(never_nearer(g), 2, {.samples = 100, .seed = 1});
  CHECK(found.reached);
  CHECK(found.inside.size() == 10);
  CHECK(found.probability == Approx(0.05).epsilon(1e-12));
}

TEST_CASE("what is not a number is in the event") {
  const auto g = [](const NormalPoint& z) { return z[0] > 3 ? std::nan("") : 3 - z[0]; };
  const RareEstimate found = repeated(g, 2, 1000, 4, 1);
  CHECK(found.reached);
  CHECK(found.probability == Approx(normal_tail(3)).epsilon(0.5));
}

TEST_CASE("the same seed gives the same estimate, another repetition another") {
  const auto once = [](std::uint64_t repetition) {
    return subset_simulation(limit_state(linear(3)), 3,
                             {.samples = 500, .seed = 4, .repetition = repetition})
        .probability;
  };
  CHECK(once(0) == once(0));
  CHECK(once(0) != once(1));
}

TEST_CASE("repetitions are combined by their mean, and by the wider of two intervals") {
  SubsetEstimate a, b;
  a.probability = 1e-5, b.probability = 3e-5;
  a.variation = b.variation = 0.1;
  a.reached = b.reached = true;
  a.evaluations = b.evaluations = 10;
  const RareEstimate found = combined(std::vector{a, b}, 0.95);
  CHECK(found.probability == Approx(2e-5));
  CHECK(found.evaluations == 20);
  CHECK(found.from_chains == Approx(0.1 * std::hypot(1.0, 3.0) / 4));
  CHECK(found.from_spread == Approx(0.5)); // s = √2e-5, over √2, over 2e-5
  CHECK(found.variation == found.from_spread);
  CHECK(found.interval.upper == Approx(2e-5 * std::exp(12.7062 * 0.5))); // Student's, 1 degree
  CHECK(found.plain_runs == Approx((1 - 2e-5) / (2e-5 * 0.25)));
  b.reached = false;
  CHECK(!combined(std::vector{a, b}, 0.95).reached);
}

TEST_CASE("repetitions that differ by far more than their variations disagree") {
  const auto disagree = [](const std::vector<double>& probabilities, double variation) {
    std::vector<SubsetEstimate> estimates;
    for (const double p : probabilities) {
      SubsetEstimate& each = estimates.emplace_back();
      each.probability = each.last_level = p;
      each.variation = variation, each.reached = p > 0;
      each.levels.resize(3);
    }
    return repetitions_disagree(estimates);
  };
  CHECK(disagree({2.67e-10, 1e-6, 3e-8, 2e-3, 5e-9}, 0.5));
  CHECK(disagree({1e-5, 1e-5, 0, 1e-5}, 0.3)); // one did not reach the event
  CHECK_FALSE(disagree({0.8e-5, 1e-5, 1.4e-5, 1.1e-5}, 0.3));
  CHECK_FALSE(disagree({0.5e-5, 1e-5, 2.4e-5, 1.1e-5}, 0.5));
  CHECK_FALSE(disagree({1e-5}, 0.3));
}

// Of 400 estimates, the spread is known to 1/√800, 3.5 %. Along the chains' correlation δ has to come out as large as
// it is, and no larger; without it, at γ = 0, it is too small by a third.
TEST_CASE("the variation is the spread that repetitions have, no less and no more", "[long]") {
  constexpr int repeats = 400;
  std::vector<double> probabilities;
  double square = 0, uncorrelated = 0;
  for (std::uint64_t k = 0; k < repeats; ++k) {
    const SubsetEstimate found = subset_simulation(limit_state(linear(3.5)), 5,
                                                   {.samples = 1000, .seed = 8, .repetition = k});
    probabilities.push_back(found.probability);
    square += found.variation * found.variation;
    for (const SubsetLevel& level : found.levels)
      uncorrelated += (1 - level.share) / (level.share * 1000);
  }
  const Moments seen = moments(probabilities);
  const double spread = seen.std / seen.mean, claimed = std::sqrt(square / repeats);
  INFO("seen " << spread << ", claimed " << claimed);
  CHECK(claimed > 0.8 * spread); // (3) knows nothing of seeds that resemble each other
  CHECK(claimed < 1.1 * spread);
  CHECK(std::sqrt(uncorrelated / repeats) < 0.7 * spread);
}

TEST_CASE("bounds keep their confidence for events that are likely, certain, or an atom",
          "[long]") {
  struct Example {
    const char* name;
    double p;  ///< of the event
    bool atom; ///< g tells the points outside the event not apart
  };
  const auto example = GENERATE(values<Example>({{"nearly certain", 0.99865, false},
                                                 {"certain but for an atom", 0.995, true},
                                                 {"likely", 0.5, false},
                                                 {"in the first level of some repeats", 0.1, false},
                                                 {"just in the second level", 0.07, false},
                                                 {"in the second level", 0.02, false},
                                                 {"an atom of 5 %", 0.05, true},
                                                 {"an atom of 0.1 %", 1e-3, true}}));
  INFO(example.name);
  const double limit = boost::math::quantile(boost::math::normal(), example.p);
  const LimitStateFunction g = limit_state([&](const NormalPoint& z) {
    return example.atom ? (z[0] < limit ? -1.0 : 1.0) : z[0] - limit;
  });
  const int seeds = random_cases(1000, 250);
  constexpr double confidence = 0.9;
  int missed = 0;
  double sum = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::vector<SubsetEstimate> estimates;
    for (std::uint64_t k = 0; k < 5; ++k)
      estimates.push_back(subset_simulation(
          g, 1, {.samples = 200, .seed = static_cast<std::uint64_t>(seed), .repetition = k}));
    const RareEstimate found = combined(estimates, confidence);
    missed += !(found.interval.lower <= example.p && example.p <= found.interval.upper);
    sum += found.probability;
    CHECK(std::isfinite(found.plain_runs));
  }
  CHECK(missed <= seeds * 0.1 + 3 * std::sqrt(seeds * 0.1)); // 10 %, and three standard errors
  CHECK(sum / seeds == Approx(example.p).epsilon(example.atom ? 0.12 : 0.05));
}

TEST_CASE("one hit in 1,500 of an atom: the bounds of 1,500 plain draws") {
  long call = 0;
  const LimitStateFunction g = [&](std::span<const NormalPoint> points) {
    std::vector<double> values(points.size(), 1.0);
    if (call++ == 2) values[7] = -1;
    return values;
  };
  std::vector<SubsetEstimate> estimates;
  for (std::uint64_t k = 0; k < 5; ++k)
    estimates.push_back(subset_simulation(g, 1, {.samples = 300, .repetition = k}));
  const RareEstimate found = combined(estimates, 0.95);
  CHECK((found.plain && found.reached));
  CHECK(found.probability == Approx(1 / 1500.));
  CHECK(found.interval.lower == Approx(1.688e-5).epsilon(1e-3)); // scipy.stats.beta.ppf
  CHECK(found.interval.upper == Approx(3.709e-3).epsilon(1e-3));
  estimates.erase(estimates.begin() + 2);
  const RareEstimate none = combined(estimates, 0.95);
  CHECK(none.probability == 0);
  CHECK(none.interval.lower == 0);
  CHECK(none.interval.upper == Approx(1 - std::pow(0.025, 1 / 1200.)));
}

TEST_CASE("an atom behind the first level is estimated without bias, and within its bounds") {
  const double p = normal_tail(1.5) * normal_tail(2); // g stops at z_0 = 1.5; then z_1 decides
  const LimitStateFunction g = limit_state([](const NormalPoint& z) {
    return z[0] > 1.5 && z[1] > 2 ? -1.0 : std::max(1.0, 2.5 - z[0]);
  });
  constexpr int seeds = 400;
  int missed = 0;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    std::vector<SubsetEstimate> estimates;
    for (std::uint64_t k = 0; k < 5; ++k)
      estimates.push_back(subset_simulation(g, 2, {.samples = 100, .seed = seed, .repetition = k}));
    const RareEstimate found = combined(estimates, 0.9);
    missed += !(found.interval.lower <= p && p <= found.interval.upper);
    sum += found.reached ? found.probability : 0;
  }
  CHECK(missed <= 40 + 3 * 6);
  CHECK(sum / seeds == Approx(p).epsilon(0.15));
}
