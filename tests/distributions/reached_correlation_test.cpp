#include "distributions/copula.hpp"
#include "distributions/prepared_distribution.hpp"
#include "distributions/reached_correlation.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
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

/// The law's values at normal scores, as mid-ranks.
std::vector<double> ranks_at(const Distribution& distribution, const std::vector<double>& scores) {
  const PreparedDistribution law(distribution);
  std::vector<double> values;
  for (const double z : scores) values.push_back(law.quantile(std::erfc(-z / std::sqrt(2.0)) / 2));
  return mid_ranks(values);
}

/// Pairs of independent normal scores.
struct Scores {
  std::vector<double> first, second;

  Scores() {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 60000; ++k) {
      first.push_back(normal(random));
      second.push_back(normal(random));
    }
  }
};

/// Scores correlated with the first ones, so that the ranks have this Spearman coefficient.
std::vector<double> coupled(const Scores& scores, double spearman) {
  const double r = normal_correlation(spearman);
  std::vector<double> coupled;
  for (std::size_t k = 0; k < scores.first.size(); ++k)
    coupled.push_back(r * scores.first[k] + std::sqrt(1 - r * r) * scores.second[k]);
  return coupled;
}

double correlation_of_ranks(const std::vector<double>& a, const std::vector<double>& b) {
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
  const Scores scores;
  std::vector<std::vector<double>> ranks;
  for (const Distribution& law : laws) ranks.push_back(ranks_at(law, scores.first));
  for (const double spearman : {0.8, -0.5}) {
    const std::vector<double> others = coupled(scores, spearman);
    for (const Distribution& second : laws) {
      const std::vector<double> other_ranks = ranks_at(second, others);
      for (std::size_t k = 0; k < laws.size(); ++k) {
        CAPTURE(laws[k].law.index(), second.law.index(), spearman);
        CHECK(reached_correlation(laws[k], second, spearman) ==
              Approx(correlation_of_ranks(ranks[k], other_ranks)).margin(0.015));
      }
    }
  }
  CHECK(reached_correlation(laws[0], laws[4], 0.8) == Approx(0.8).epsilon(1e-3));
  CHECK(reached_correlation(laws[0], laws[2], 0.8) == Approx(0.64).margin(0.005));
  CHECK(reached_correlation(laws[0], laws[1], 0.8) == Approx(0.16).margin(0.005));
  CHECK(reached_correlation({Constant{2}, {}}, laws[0], 0.8) == 0);
}

namespace {

double normal_below(double z) { return std::erfc(-z / std::sqrt(2.0)) / 2; }

/// z with P(Z ≤ z) = u, by bisection.
double normal_score(double u) {
  double low = -10, high = 10;
  for (int k = 0; k < 80; ++k) (normal_below((low + high) / 2) < u ? low : high) = (low + high) / 2;
  return low;
}

/// A law by its steps' probabilities, a continuous one by none.
struct Steps {
  std::vector<double> probabilities, ends; ///< ends: normal scores, without the last

  explicit Steps(std::vector<double> of) : probabilities(std::move(of)) {
    double end = 0;
    for (std::size_t k = 0; k + 1 < probabilities.size(); ++k)
      ends.push_back(normal_score(end += probabilities[k]));
  }
};

/// The mean of the law's mid-rank, less ½, where a normal score has the mean `of` and the standard deviation `sigma`.
double mean_rank(const Steps& law, double of, double sigma) {
  if (law.probabilities.empty()) return normal_below(of / std::hypot(1, sigma)) - 0.5;
  double sum = -0.5, begin = 0, from = 0;
  for (std::size_t k = 0; k < law.probabilities.size(); ++k) {
    const double end = begin + law.probabilities[k];
    const double up_to = k == law.ends.size() ? 1 : normal_below((law.ends[k] - of) / sigma);
    sum += (begin + end) / 2 * (up_to - from);
    begin = end, from = up_to;
  }
  return sum;
}

double rank_variance(const std::vector<double>& steps) {
  double cubes = 0;
  for (const double p : steps) cubes += p * p * p;
  return (1 - cubes) / 12;
}

/// E[E[R_1 | z_2] R_2(z_2)] by the middle rule between the steps of the second law.
double integrated(const Steps& law, const Steps& other, double spearman) {
  const std::vector<double>& second = other.probabilities;
  const double r = normal_correlation(spearman);
  std::vector<double> ends{-9};
  ends.insert(ends.end(), other.ends.begin(), other.ends.end());
  ends.push_back(9);
  double sum = 0, begin = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    constexpr int points = 1000;
    const double h = (ends[k + 1] - ends[k]) / points;
    for (int i = 0; i < points; ++i) {
      const double z = ends[k] + (i + 0.5) * h;
      const double rank = second.empty() ? normal_below(z) : begin + second[k] / 2;
      sum += h * std::exp(-z * z / 2) / std::sqrt(2 * std::acos(-1.0)) * (rank - 0.5) *
             mean_rank(law, r * z, std::sqrt(1 - r * r));
    }
    if (!second.empty()) begin += second[k];
  }
  return sum / std::sqrt(rank_variance(law.probabilities) * rank_variance(second));
}

Distribution law_of(const std::vector<double>& steps) {
  if (steps.empty()) return {Normal{0, 1}, {}};
  std::vector<double> values;
  for (std::size_t k = 0; k < steps.size(); ++k) values.push_back(static_cast<double>(k));
  return {Discrete{values, steps}, {}};
}

} // namespace

TEST_CASE("what the ties of rare steps leave is that of an integral, in either order") {
  const std::vector<std::vector<double>> laws{
      {}, {0.9, 0.1}, {0.001, 0.999}, {0.9999, 1e-4}, {0.99999, 1e-5}, {0.3, 1e-4, 0.6999}};
  for (const auto& first : laws)
    for (const auto& second : laws)
      for (const double spearman : {0.3, 0.85, -0.8, 0.99, -0.97}) {
        const double found = reached_correlation(law_of(first), law_of(second), spearman);
        CAPTURE(first, second, spearman);
        CHECK(found ==
              Approx(integrated(Steps(first), Steps(second), spearman)).epsilon(2e-3).margin(1e-9));
        CHECK(found == Approx(reached_correlation(law_of(second), law_of(first), spearman))
                           .epsilon(1e-4)
                           .margin(1e-12));
      }
  // Of a million draws: 0.0163 and -0.00099.
  CHECK(reached_correlation(law_of({0.9999, 1e-4}), law_of({}), 0.85) ==
        Approx(0.0163).margin(0.001));
  CHECK(reached_correlation(law_of({0.999, 0.001}), law_of({0.999, 0.001}), -0.8) ==
        Approx(-0.001).margin(2e-5));
}

TEST_CASE("ties of one value among many different ones reduce a correlation") {
  const Scores scores;
  const std::vector<double> second_scores = coupled(scores, 0.8);
  const std::vector<double> normal = ranks_at({Normal{0, 1}, {}}, second_scores);
  for (const int others : {100, 199, 250, 1500}) {
    CAPTURE(others);
    Empirical law{std::vector<double>(1500, 0.0)};
    for (int k = 1; k <= others; ++k) law.values.push_back(k);
    const std::vector<double> ranks = ranks_at({law, {}}, scores.first);
    CHECK(reached_correlation({law, {}}, {Normal{0, 1}, {}}, 0.8) ==
          Approx(correlation_of_ranks(ranks, normal)).margin(0.01));
    CHECK(reached_correlation({law, {}}, {law, {}}, 0.8) ==
          Approx(correlation_of_ranks(ranks, ranks_at({law, {}}, second_scores))).margin(0.015));
  }
}
