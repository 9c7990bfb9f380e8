#include "montecarlo/report/data/distribution_curve.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a distribution function steps at its values, its band by hand", "[page]") {
  const std::vector<double> sorted{1, 2, 2, 4};
  const auto knots = distribution_curve(sorted, {}, 0, 0.95, 129).knots;
  REQUIRE(knots.size() == 3);
  CHECK(knots[0].x == 1);
  CHECK(knots[0].p == 0.25);
  CHECK(knots[1].x == 2);
  CHECK(knots[1].p == 0.75); // both of them
  CHECK(knots[2].p == 1);
  const double width = std::sqrt(std::log(40.0) / 8); // ln(2/0.05)/(2·4)
  CHECK(*knots[1].band.lower == Approx(0.75 - width).epsilon(1e-14));
  CHECK(*knots[0].band.lower == 0); // no share is below 0
  CHECK(*knots[1].band.upper == 1);
  CHECK(distribution_curve({}, {}, 0, 0.95, 129).knots.empty());
  CHECK(band_name(0, 0.95) == "Dvoretzky-Kiefer-Wolfowitz, 95 %");
}

TEST_CASE(
    "a curve has steps where its knots are all distinct values, however many runs they stand for",
    "[page]") {
  std::vector<double> sorted(4000, 1.0);
  sorted.resize(4001, 2.0); // one run in the middle, which no rank of the curve need hit
  sorted.resize(10'000, 3.0);
  const auto curve = distribution_curve(sorted, {}, 0, 0.95, 17);
  CHECK(curve.steps);
  REQUIRE(curve.knots.size() == 3);
  CHECK((curve.knots[0].x == 1 && curve.knots[0].p == 0.4));
  CHECK((curve.knots[1].x == 2 && curve.knots[1].p == 0.4001));
  CHECK((curve.knots[2].x == 3 && curve.knots[2].p == 1));
  std::vector<double> many(20'000);
  for (std::size_t k = 0; k < many.size(); ++k) many[k] = static_cast<double>(k / 2);
  const auto lines = distribution_curve(many, {}, 0, 0.95, 17);
  CHECK_FALSE(lines.steps);
  CHECK(lines.knots.size() <= 17);
  for (const auto& [n, steps] : {std::pair(8192, true), std::pair(20'000, false)}) {
    Population population(grid_of(many)); // streaming: steps if all its values are kept
    for (int k = 0; k < n; ++k) population.add(k % 3, k);
    CHECK(distribution_curve(RankedPopulation(population), 0.95, 17).steps == steps);
  }
}

TEST_CASE("ranks of a curve reach both ends and stay within their number", "[page]") {
  for (const long n : {1L, 2L, 5L, 100L, 1'000'000L})
    for (const std::size_t most : {std::size_t{17}, std::size_t{129}}) {
      const auto ranks = curve_ranks(n, most);
      CAPTURE(n, most);
      CHECK(ranks.size() <= most);
      CHECK(ranks.front() == 1);
      CHECK(ranks.back() == n);
      CHECK(std::ranges::is_sorted(ranks));
      CHECK(std::ranges::adjacent_find(ranks) == ranks.end());
    }
  const auto ranks = curve_ranks(1'000'000, 129);
  CHECK(ranks[1] <= 2); // the tails are drawn to the last runs
  CHECK(ranks.end()[-2] >= 999'999);
}

TEST_CASE("the band holds the whole distribution function as often as it says", "[page]") {
  std::mt19937_64 random(17);
  constexpr int trials = 2000;
  int held = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto sorted = sorted_sample(40, random);
    const auto knots = distribution_curve(sorted, {}, 0, 0.8, 129).knots; // every value is a knot
    REQUIRE(knots.size() == 40);
    bool inside = true; // F(x) = x, at each step from the left and from the right
    double before = 0;
    const double width = std::sqrt(std::log(2 / 0.2) / 80);
    for (const CurveKnot& knot : knots) {
      inside = inside && knot.x <= before + width && knot.x >= *knot.band.lower;
      before = knot.p;
    }
    held += inside;
  }
  CHECK(held > (0.8 - band(0.8, trials)) * trials);
  CHECK(held < 0.9 * trials); // and it is not idle: at n = 40 it covers some 83 %
}

TEST_CASE("of replicates the band is each knot's own", "[page]") {
  const std::vector<double> sorted{1, 2, 3, 4};
  const std::vector<ReplicateValue> replicated{{1, 0}, {2, 1}, {3, 1}, {4, 0}};
  const auto knots = distribution_curve(sorted, replicated, 2, 0.95, 129).knots;
  REQUIRE(knots.size() == 4);
  const Bounds expected =
      replicate_proportion_bounds(std::vector<long>{1, 0}, std::vector<long>{2, 2}, 0.95);
  REQUIRE(expected.lower);
  CHECK(knots[0].band.lower == expected.lower);
  CHECK(knots[0].band.upper == expected.upper);
  CHECK(!knots[1].band.lower); // both replicates have one of two: they agree, which says nothing
  CHECK(band_name(2, 0.9) == "Korn-Graubard over 2 replicates, 90 % at each value by itself");
}

TEST_CASE("the curve of streaming statistics is that of the values where all are kept", "[page]") {
  const std::vector<double> sorted{-1, 2, 2, 4, 5, 5, 5, 9};
  Population population(grid_of(sorted));
  for (std::size_t k = 0; k < sorted.size(); ++k) population.add(sorted[k], static_cast<long>(k));
  const auto expected = distribution_curve(sorted, {}, 0, 0.9, 129).knots;
  const auto knots = distribution_curve(RankedPopulation(population), 0.9, 129).knots;
  REQUIRE(knots.size() == expected.size());
  for (std::size_t k = 0; k < knots.size(); ++k) {
    CHECK(knots[k].x == expected[k].x);
    CHECK(knots[k].p == expected[k].p);
    CHECK(*knots[k].band.lower == *expected[k].band.lower);
    CHECK(*knots[k].band.upper == *expected[k].band.upper);
  }
  CHECK(distribution_curve(RankedPopulation(Population(grid_of({}))), 0.9, 129).knots.empty());
}
