#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/rank_correlation.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

// Python 3.11, math: tanh(atanh(r) ∓ 1.959963984540054 √((1 + r²/2)/(n − 3))).
TEST_CASE("bounds of Spearman's coefficient: worked by hand") {
  const Bounds bounds = rank_correlation_bounds(0.5, 103, 0.95);
  CHECK(*bounds.lower == Approx(0.32874503087588147).epsilon(1e-12));
  CHECK(*bounds.upper == Approx(0.6394198469997987).epsilon(1e-12));
  const Bounds other = rank_correlation_bounds(-0.8, 43, 0.95);
  CHECK(*other.lower == Approx(-0.8966099745203255).epsilon(1e-12));
  CHECK(*other.upper == Approx(-0.6306936680956227).epsilon(1e-12));
}

TEST_CASE("few rows have no bounds, and a coefficient of 1 is its own") {
  CHECK(!rank_correlation_bounds(0.5, 3, 0.95).lower);
  CHECK(rank_correlation_bounds(0.5, 4, 0.95).lower);
  // equal ranks are no certainty: of 5 rows with a true coefficient of 0.89 a fifth has them
  CHECK(*rank_correlation_bounds(1, 100, 0.95).lower < 1);
  CHECK(*rank_correlation_bounds(1, 100, 0.95).lower > 0.9999);
  CHECK(*rank_correlation_bounds(1, 100, 0.95).upper == 1);
  CHECK(*rank_correlation_bounds(1, 5, 0.95).lower < 0.7);
  CHECK(*rank_correlation_bounds(-1, 5, 0.95).lower == -1);
  CHECK(*rank_correlation_bounds(-1, 5, 0.95).upper == -*rank_correlation_bounds(1, 5, 0.95).lower);
}

// By hand: with C = [1 c; c 1], the textbook's r_0 = (a − c b)/√((1 − c²)(1 − b²)).
TEST_CASE("partial coefficients of two columns from their correlations") {
  const PartialCorrelations partial({{1, 2, 3, 4}, {2, 1, 4, 3}}); // c = 0.6
  CHECK((partial.varying() == 2 && !partial.entangled()));
  const std::vector<double> r = partial.given(std::vector{0.5, -0.2});
  CHECK(r[0] == Approx((0.5 + 0.6 * 0.2) / std::sqrt(0.64 * 0.96)).epsilon(1e-13));
  CHECK(r[1] == Approx((-0.2 - 0.6 * 0.5) / std::sqrt(0.64 * 0.75)).epsilon(1e-13));
}

TEST_CASE("a column that does not vary has no partial coefficient, and twins have none either") {
  const PartialCorrelations fixed({{1, 2, 3, 4}, {7, 7, 7, 7}});
  CHECK((fixed.varying() == 1 && !fixed.entangled()));
  CHECK(fixed.given(std::vector<double>{0.5, NAN})[0] == 0.5);
  CHECK(std::isnan(fixed.given(std::vector<double>{0.5, NAN})[1]));
  const PartialCorrelations twins({{1, 2, 3, 4}, {8, 6, 4, 2}});
  CHECK(twins.entangled());
  CHECK(std::isnan(twins.given(std::vector{0.5, -0.5})[0]));
}

// By hand: of two columns with c = 0.6, C⁻¹_jj = 1/(1 − 0.36), and 1 − (4 − 1)/((4 − 2) C⁻¹_jj) = 0.04.
TEST_CASE("how far a column follows from the others") {
  const PartialCorrelations partial({{1, 2, 3, 4}, {2, 1, 4, 3}, {7, 7, 7, 7}});
  const std::vector<double> explained = partial.explained();
  CHECK(explained[0] == Approx(0.04).epsilon(1e-12));
  CHECK(explained[1] == Approx(0.04).epsilon(1e-12));
  CHECK(std::isnan(explained[2]));
  CHECK(std::isnan(PartialCorrelations({{1, 2, 3, 4}, {8, 6, 4, 2}}).explained()[0]));
}

TEST_CASE("partial coefficients have the same bits for any number of threads", "[parallel]") {
  constexpr std::size_t columns = 12, pairs = columns * columns / 2;
  const auto enough = static_cast<std::size_t>(operations_worth_threads) / pairs;
  for (const std::size_t rows : {std::size_t{100}, enough - 1, enough + 1}) {
    std::vector<Spilled<double>> drawn;
    for (std::size_t j = 0; j < columns; ++j)
      drawn.emplace_back(uniforms(40 + j, static_cast<int>(rows)));
    const std::vector<double> plain(columns, 0.1);
    const PartialCorrelations alone(drawn, 1);
    for (const int threads : {2, 3, 8}) {
      const PartialCorrelations together(drawn, threads);
      CHECK(together.given(plain) == alone.given(plain));
      CHECK(together.explained() == alone.explained());
    }
  }
}

namespace {

/// Mid-ranks, by counting.
std::vector<double> counted_ranks(const std::vector<double>& x) {
  std::vector<double> ranks;
  for (const double a : x)
    ranks.push_back(0.5 + 0.5 * static_cast<double>(std::ranges::count(x, a)) +
                    static_cast<double>(std::ranges::count_if(x, [&](double b) { return b < a; })));
  return ranks;
}

/// The jackknife's standard error of Spearman's coefficient, leaving out one row after the other.
double jackknife_error(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> without;
  for (std::size_t k = 0; k < x.size(); ++k) {
    std::vector<double> a = x, b = y;
    a.erase(a.begin() + static_cast<long>(k)), b.erase(b.begin() + static_cast<long>(k));
    without.push_back(pearson(counted_ranks(a), counted_ranks(b)));
  }
  const auto n = static_cast<double>(x.size());
  return (n - 1) / std::sqrt(n) * moments(without).std;
}

} // namespace

TEST_CASE(
    "the error of Spearman's coefficient for any law is the jackknife's, with ties and without") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (const int kind : {0, 1, 2, 3}) {
    std::vector<double> x, y;
    for (int i = 0; i < 150; ++i) {
      double a = normal(random), b = normal(random);
      if (kind == 1) a = a < 1 ? 0 : 1; // two values
      if (kind == 2) b = a * a + 0.1 * b;
      if (kind == 3) a = std::round(a), b = std::round(2 * (a + b));
      x.push_back(a), y.push_back(kind == 2 ? b : a + b);
    }
    CAPTURE(kind);
    const double error = rank_correlation_error(counted_ranks(x), counted_ranks(y));
    CHECK(error == Approx(jackknife_error(x, y)).epsilon(0.04)); // 1/n, and curvature
    const double rho = pearson(counted_ranks(x), counted_ranks(y));
    const Bounds wide = rank_correlation_bounds(rho, 150, 0.95, 10 * error),
                 narrow = rank_correlation_bounds(rho, 150, 0.95, 0.1 * error);
    CHECK(*wide.upper - *wide.lower > *narrow.upper - *narrow.lower);
    CHECK(*narrow.lower == *rank_correlation_bounds(rho, 150, 0.95).lower); // the formula is wider
    // by hand: artanh ρ ± 1.96 · 10 error/(1 − ρ²)
    CHECK(std::atanh(*wide.upper) - std::atanh(rho) ==
          Approx(1.959963984540054 * 10 * error / (1 - rho * rho)).epsilon(1e-9));
  }
  CHECK(rank_correlation_error(std::vector{1., 2., 3.}, std::vector{2., 2., 2.}) == 0);
}
