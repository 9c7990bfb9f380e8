#include "distributions/copula.hpp"
#include "distributions/prepared_distribution.hpp"
#include "distributions/reached_correlation.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace wingspread;

namespace {

/// Mid-ranks of the values as shares, less ½.
std::vector<double> mid_ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values, ranks;
  std::ranges::sort(sorted);
  for (const double value : values) {
    const auto [first, last] = std::ranges::equal_range(sorted, value);
    const auto place = [&](auto at) { return static_cast<double>(at - sorted.begin()); };
    ranks.push_back((place(first) + place(last)) / 2 / static_cast<double>(values.size()) - 0.5);
  }
  return ranks;
}

/// Spearman's coefficient of draws of the copula.
double sampled(const Distribution& first, const Distribution& second, double spearman) {
  const PreparedDistribution one(first), other(second);
  const double r = normal_correlation(spearman);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> a, b;
  for (int k = 0; k < 60000; ++k) {
    const double x = normal(random), y = r * x + std::sqrt(1 - r * r) * normal(random);
    a.push_back(one.quantile(std::erfc(-x / std::sqrt(2.0)) / 2));
    b.push_back(other.quantile(std::erfc(-y / std::sqrt(2.0)) / 2));
  }
  a = mid_ranks(a), b = mid_ranks(b);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    ab += a[k] * b[k], aa += a[k] * a[k], bb += b[k] * b[k];
  return ab / std::sqrt(aa * bb);
}

} // namespace

TEST_CASE("what ties leave of a rank correlation is that of draws") {
  const std::vector<Distribution> laws{{Normal{0, 1}, {}},
                                       {Discrete{{1, 2}, {0.99, 0.01}}, {}},
                                       {Discrete{{3, 1, 2}, {0.1, 0.7, 0.2}}, {}},
                                       {Empirical{{1, 1, 1, 2, 3, 3, 4, 5, 6, 6}}, {}},
                                       {Uniform{0, 1}, {}}};
  for (const Distribution& first : laws)
    for (const Distribution& second : laws)
      for (const double spearman : {0.8, -0.5}) {
        CAPTURE(first.law.index(), second.law.index(), spearman);
        CHECK(reached_correlation(first, second, spearman) ==
              Approx(sampled(first, second, spearman)).margin(0.015));
      }
  CHECK(reached_correlation(laws[0], laws[4], 0.8) == Approx(0.8).epsilon(1e-3));
  CHECK(reached_correlation(laws[0], laws[2], 0.8) == Approx(0.64).margin(0.005));
  CHECK(reached_correlation(laws[0], laws[1], 0.8) == Approx(0.16).margin(0.005));
  CHECK(reached_correlation({Constant{2}, {}}, laws[0], 0.8) == 0);
}
