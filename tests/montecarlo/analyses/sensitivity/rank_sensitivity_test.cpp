#include "distributions/copula.hpp"
#include "montecarlo/foundation/statistics/ranked_column.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "tests/montecarlo/analyses/sensitivity/rank_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <iterator>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::vector<double> partials(const Results& results) {
  std::vector<double> values;
  for (const RankEffect& effect : rank_sensitivity(results, 0.95).outputs.front().effects)
    values.push_back(effect.partial.value);
  return values;
}

/// The oracle: residuals of two least-squares fits (by QR, of another library), correlated.
double by_residuals(const Columns& x, const std::vector<double>& y, std::size_t j) {
  const auto n = static_cast<Eigen::Index>(y.size());
  Eigen::MatrixXd others(n, static_cast<Eigen::Index>(x.size()));
  const auto ranks = [&](const std::vector<double>& values) {
    const Spilled<double> column(values);
    const std::vector<double> of_column = RankedColumn(column).ranks();
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(of_column.data(), n));
  };
  others.col(0).setOnes();
  for (std::size_t i = 0, at = 1; i < x.size(); ++i)
    if (i != j) others.col(static_cast<Eigen::Index>(at++)) = ranks(x[i]);
  const auto rest = [&](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(v - others * others.colPivHouseholderQr().solve(v));
  };
  const Eigen::VectorXd a = rest(ranks(x[j])), b = rest(ranks(y));
  return a.dot(b) / (a.norm() * b.norm());
}

} // namespace

TEST_CASE("partial coefficients are those of the residuals of two fits, ties and all") {
  Columns x = normal_columns(4, 60, 3);
  for (double& value : x[1]) value = std::round(2 * value); // ties
  for (std::size_t k = 0; k < x[2].size(); ++k) x[2][k] += x[0][k];
  std::vector<double> y = combination(x, {1, 0.5, -0.7, 0.2});
  for (double& value : y) value = std::round(value * value * value);
  const std::vector<double> found = partials(results_of(x, y));
  for (std::size_t j = 0; j < x.size(); ++j)
    CHECK(found[j] == Approx(by_residuals(x, y, j)).margin(1e-12));
}

TEST_CASE("of two dispersions, the textbook's formula for partial correlation") {
  Columns x = normal_columns(2, 40, 5);
  for (std::size_t k = 0; k < 40; ++k) x[1][k] += 0.8 * x[0][k];
  const Columns noise = normal_columns(3, 40, 6);
  std::vector<double> y = combination(x, {1, -1});
  for (std::size_t k = 0; k < 40; ++k) y[k] += noise[2][k];
  const Spilled<double> x0(x[0]), x1(x[1]), column_y(y);
  const RankedColumn a(x0), b(x1), c(column_y);
  const double ab = pearson(a.ranks(), b.ranks()), ac = pearson(a.ranks(), c.ranks()),
               bc = pearson(b.ranks(), c.ranks());
  CHECK(partials(results_of(x, y))[0] ==
        Approx((ac - ab * bc) / std::sqrt((1 - ab * ab) * (1 - bc * bc))).epsilon(1e-12));
}

TEST_CASE("a linear model of normal dispersions has the coefficients of its closed form") {
  // Spearman's of two normal variables with correlation r is 6/π asin(r/2) (Pearson 1907); with
  // independent dispersions (1) is c_j/√(1 − Σ_{i≠j} c_i²).
  const std::vector<double> weights{2, -1, 0.5, 0};
  const std::size_t n = 20000;
  const Columns x = normal_columns(5, n, 11); // the last is noise
  std::vector<double> y = combination(x, weights);
  for (std::size_t k = 0; k < n; ++k) y[k] = std::exp(y[k] + x[4][k]); // ranks do not see exp
  Columns drawn(x.begin(), x.begin() + 4);
  const auto effects = rank_sensitivity(results_of(drawn, y), 0.95).outputs.front().effects;
  std::vector<double> c;
  double sum = 0;
  for (const double weight : weights) {
    c.push_back(spearman_correlation(weight / std::sqrt(4 + 1 + 0.25 + 1)));
    sum += c.back() * c.back();
  }
  const double error = 4 / std::sqrt(static_cast<double>(n));
  for (std::size_t j = 0; j < 4; ++j) {
    CHECK(effects[j].spearman.value == Approx(c[j]).margin(error));
    CHECK(effects[j].partial.value ==
          Approx(c[j] / std::sqrt(1 - sum + c[j] * c[j])).margin(error));
  }
}

TEST_CASE("an output that follows one dispersion without rest leaves nothing to the others") {
  const Columns x = normal_columns(3, 200, 7);
  std::vector<double> y = x[1];
  for (double& value : y) value = -std::exp(value);
  const std::vector<double> found = partials(results_of(x, y));
  CHECK(found[1] == Approx(-1).epsilon(1e-10));
  CHECK(std::isnan(found[0])); // 0/0
  CHECK(std::isnan(found[2]));
}

TEST_CASE("bounds of a partial coefficient contain it, or there are none") {
  int without = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const Columns x = normal_columns(2, 300, seed);
    std::vector<double> y = x[0];
    for (std::size_t row = 0; row < y.size(); ++row) y[row] += 0.003 * x[1][row];
    for (const RankEffect& effect :
         rank_sensitivity(results_of(x, y), 0.95).outputs.front().effects) {
      const auto& [value, bounds] = effect.partial;
      CAPTURE(seed, value);
      without += !bounds.lower;
      if (bounds.lower) CHECK((*bounds.lower <= value && value <= *bounds.upper));
    }
  }
  CHECK(without > 0); // too few ranks are left to bound them
}

TEST_CASE("ties share their rank") {
  const auto effect = rank_sensitivity(results_of({{1, 1, 2, 2, 3, 3}}, {1, 2, 3, 4, 5, 6}), 0.95)
                          .outputs.front()
                          .effects.front();
  // mid-ranks 1.5 1.5 3.5 3.5 5.5 5.5: Σ = 16, with Σ = 16 and 17.5 of the squares
  CHECK(effect.spearman.value == Approx(std::sqrt(16 / 17.5)));
}

TEST_CASE("runs without the output are left out and counted, and others keep theirs") {
  const Columns x = normal_columns(2, 50, 8);
  std::vector<double> y = combination(x, {1, 1});
  Columns kept{{}, {}};
  std::vector<double> kept_y;
  for (std::size_t k = 0; k < 50; ++k)
    if (k % 5 == 0)
      y[k] = none;
    else
      for (kept_y.push_back(y[k]); const std::size_t j : {0u, 1u}) kept[j].push_back(x[j][k]);
  Results results = results_of(x, y);
  results.outputs.push_back({"z", combination(x, {1, -1})});
  const RankSensitivity all = rank_sensitivity(results, 0.95);
  CHECK(all.outputs[0].count == 40);
  CHECK(all.outputs[0].missing == 10);
  CHECK(all.outputs[1].count == 50);
  CHECK(all.outputs[1].missing == 0);
  CHECK(partials(results) == partials(results_of(kept, kept_y)));
}

TEST_CASE("deployment is an output where some runs deployed and others did not") {
  const Columns x = normal_columns(2, 300, 9);
  Results results = results_of(x, combination(x, {0, 1}));
  CHECK(rank_sensitivity(results, 0.95).outputs.size() == 1);
  for (std::size_t k = 0; k < 300; ++k)
    if (x[0][k] > 0.8) results.status[k] = k % 2 ? Status::stalled : Status::timed_out;
  results.status[0] = Status::failed;
  results.status[1] = Status::invalid;
  const RankSensitivity all = rank_sensitivity(results, 0.95);
  REQUIRE(all.outputs.size() == 2);
  CHECK(all.outputs[1].output == "deployed");
  CHECK(all.outputs[1].count == 300); // failed and invalid ones too
  CHECK(all.outputs[1].effects[0].partial.value < -0.6);
  CHECK(std::abs(all.outputs[1].effects[1].partial.value) < 0.2);
}

TEST_CASE("columns that do not vary, or not by themselves, have no partial coefficient") {
  Columns x = normal_columns(3, 50, 10);
  const std::vector<double> y = combination(x, {1, 1, 1});
  x[1].assign(50, 2.0);
  const RankSensitivity all = rank_sensitivity(results_of(x, y), 0.95);
  CHECK(all.unvaried == std::vector<std::string>{"x1"});
  CHECK(all.idle.empty());
  CHECK(std::isnan(all.outputs[0].effects[1].partial.value));
  CHECK(!all.outputs[0].effects[1].partial.bounds.lower);
  CHECK(all.outputs[0].effects[0].partial.value > 0.3);

  x[1] = x[0];
  for (double& value : x[1]) value = 7 - value * 2; // its ranks are x0's, the other way round
  const RankSensitivity twins = rank_sensitivity(results_of(x, y), 0.95);
  CHECK(twins.outputs[0].entangled);
  CHECK(std::isnan(twins.outputs[0].effects[2].partial.value));
  CHECK(!std::isnan(twins.outputs[0].effects[2].spearman.value));
}

TEST_CASE("few runs have no partial coefficients, and none at all no coefficients") {
  const Columns x = normal_columns(4, 5, 1);
  const auto effect =
      rank_sensitivity(results_of(x, combination(x, {1, 1, 1, 1})), 0.95).outputs[0].effects[0];
  CHECK(std::isnan(effect.partial.value)); // five runs, four dispersions
  const RankSensitivity empty = rank_sensitivity(results_of({{}, {}}, {}), 0.95);
  CHECK(empty.outputs[0].count == 0);
  CHECK(std::isnan(empty.outputs[0].effects[0].spearman.value));
}

TEST_CASE("dispersions that follow from others are named") {
  Columns x = normal_columns(5, 400, 13);
  for (std::size_t k = 0; k < 400; ++k) x[1][k] = x[0][k] + 0.3 * x[1][k]; // R² 0.9
  const std::vector<double> y = combination(x, {1, 1, 1, 0, 1});
  const RankSensitivity all = rank_sensitivity(results_of({x[0], x[1], x[2], x[3]}, y), 0.95);
  CHECK(all.collinear == std::vector<std::string>{"x0", "x1"});
  CHECK(rank_sensitivity(results_of({x[0], x[2], x[3]}, y), 0.95).collinear.empty());
}

TEST_CASE("in few runs no independent draws are said to follow from others") {
  for (const std::size_t runs : {5, 6, 8, 12, 19})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Columns x = normal_columns(3, runs, seed);
      CHECK(rank_sensitivity(results_of(x, combination(x, {1, 1, 1})), 0.95).collinear.empty());
    }
}

TEST_CASE("a dispersion of which the others explain half is named, one of a third is not") {
  const auto collinear = [](double rest) { // R² = 1/(1 + rest²)
    Columns x = normal_columns(4, 2000, 14);
    for (std::size_t k = 0; k < 2000; ++k) x[1][k] = x[0][k] + rest * x[1][k];
    return rank_sensitivity(results_of({x[0], x[1]}, combination(x, {1, 1, 1})), 0.95).collinear;
  };
  CHECK(collinear(0.8) == std::vector<std::string>{"x0", "x1"}); // 0.61
  CHECK(collinear(1.4).empty());                                 // 0.34
}

// On a busy machine each team waits for a thread that has no processor: the test of the bounds above took 5 to 7 s in
// place of 0.4 s.
TEST_CASE("the coefficients of some hundred runs start no threads") {
  const auto threads = [] {
    namespace fs = std::filesystem;
    return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator{});
  };
  const Columns x = normal_columns(8, 300, 5);
  const auto before = threads(); // in a program of its own, as ctest has it, just this one
  CHECK(rank_sensitivity(results_of(x, x[0]), 0.95).runs == 300);
  CHECK(threads() == before);
}
