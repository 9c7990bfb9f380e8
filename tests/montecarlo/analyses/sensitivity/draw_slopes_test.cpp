#include "montecarlo/analyses/sensitivity/draw_slopes.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;

TEST_CASE("slopes of a linear output are its own, with and without each group", "[needed]") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Results results(ResultNames{{"a", "same", "b"}, {}});
  OutputValues values;
  for (long run = 0; run < 200; ++run) {
    const double a = normal(random), b = 3 + 0.1 * normal(random);
    results.append({run, Status::deployed, {a, 7, b}, {}, "", ""});
    values.rows.push_back(static_cast<std::size_t>(run));
    values.y.push_back(2 * a - 5 * b);
  }
  const DrawSlopes slopes(values, results, {});
  REQUIRE(slopes.known());
  CHECK(slopes.runs() == 200);
  CHECK(slopes.of(0) == Approx(2));
  CHECK(slopes.of(1) == 0);
  CHECK(slopes.of(2) == Approx(-5));
  CHECK(slopes.explained() == Approx(1));
  const std::vector<std::size_t> columns{0, 2};
  const std::vector<double> weights{1, 2};
  for (const double sum : slopes.without(columns, weights)) CHECK(sum == Approx(-8));
}
