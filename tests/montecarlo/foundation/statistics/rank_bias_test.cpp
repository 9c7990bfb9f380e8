#include "montecarlo/foundation/statistics/rank_bias.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace wingspread;

TEST_CASE("without ties, ranks are biased towards Kendall's τ by 3/(n + 1)") {
  const std::vector<double> x{1, 2, 3, 4, 5}, y{2, 1, 3, 5, 4}; // 8 pairs agree, 2 do not: τ = 0.6
  const RankBias bias({x, y});
  CHECK(bias.in_sample(0, 1, 0.9) == Approx((3 * 0.9 + 3 * 0.6) / 6).epsilon(1e-14));
  CHECK(std::isnan(bias.in_sample(0, 1, std::numeric_limits<double>::quiet_NaN())));
}

// P(x, y) on {0, 1} × {0, 1, 2}; the grade correlation by sums over the law, its sample counterpart over all samples.
TEST_CASE("with ties the bias is that of all samples of four") {
  constexpr double law[2][3] = {{.3, .1, .1}, {.05, .15, .3}};
  constexpr int n = 4;
  const auto sign = [](int a, int b) { return double((a > b) - (a < b)); };
  double terms = 0, tau = 0, x_terms = 0, x_ties = 0, y_terms = 0,
         y_ties = 0; // of s s' with j ≠ k, and j = k
  const auto probability = [&](int i) { return law[i / 3][i % 3]; };
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double pair = probability(i) * probability(j);
      const double sx = sign(i / 3, j / 3), sy = sign(i % 3, j % 3);
      tau += pair * sx * sy, x_ties += pair * sx * sx, y_ties += pair * sy * sy;
      for (int k = 0; k < 6; ++k) {
        const double weight = pair * probability(k), tx = sign(i / 3, k / 3),
                     ty = sign(i % 3, k % 3);
        terms += weight * sx * ty, x_terms += weight * sx * tx, y_terms += weight * sy * ty;
      }
    }
  const auto in_sample = [&](double apart, double same) { return (n - 2) * apart + same; };
  const double expected =
      in_sample(terms, tau) / std::sqrt(in_sample(x_terms, x_ties) * in_sample(y_terms, y_ties));
  std::vector<double> x,
      y; // the law as a sample of 20, without the bias of four: w of four from its shares
  for (int i = 0; i < 6; ++i)
    for (int copy = 0; copy < std::lround(20 * probability(i)); ++copy) {
      x.push_back(i / 3), y.push_back(i % 3);
    }
  const double wx = x_ties / in_sample(x_terms, x_ties), wy = y_ties / in_sample(y_terms, y_ties);
  const double rho = terms / std::sqrt(x_terms * y_terms);
  CHECK(std::sqrt((1 - wx) * (1 - wy)) * rho +
            std::sqrt(wx * wy) * tau / std::sqrt(x_ties * y_ties) ==
        Approx(expected).epsilon(1e-12)); // (1) of the header
  const RankBias bias({x, y});            // of 20 rows: w = B/A, with the sample's own sums
  const double w20x = x_ties / (20 * x_terms), w20y = y_ties / (20 * y_terms);
  CHECK(bias.in_sample(0, 1, rho) ==
        Approx(std::sqrt((1 - w20x) * (1 - w20y)) * rho +
               std::sqrt(w20x * w20y) * tau / std::sqrt(x_ties * y_ties))
            .epsilon(1e-12));
}

TEST_CASE("a column longer than the rows that are compared has the share of its own length") {
  std::vector<double> x, y; // without ties
  for (std::size_t row = 0; row < 3 * rank_bias_rows; ++row) {
    x.push_back(std::fmod(0.6180339887498949 * static_cast<double>(row), 1.0));
    y.push_back(x.back() + std::fmod(0.4142135623730951 * static_cast<double>(row), 1.0));
  }
  const auto share = [&](std::size_t rows) { // w τ, where nothing is correlated
    return RankBias({std::span(x).first(rows), std::span(y).first(rows)}).in_sample(0, 1, 0);
  };
  const auto n = static_cast<double>(rank_bias_rows);
  REQUIRE(share(rank_bias_rows) > 0);
  for (const double times : {2.0, 3.0})
    CHECK(share(static_cast<std::size_t>(times * n)) ==
          Approx(share(rank_bias_rows) * (n + 1) / (times * n + 1)).epsilon(1e-12));
}
