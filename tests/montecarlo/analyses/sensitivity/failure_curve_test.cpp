#include "montecarlo/analyses/sensitivity/failure_curve.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

using namespace wingspread;

namespace {

/// The fit by its max–min formula: max over a ≤ i of min over b ≥ i of the mean from a to b.
double max_min(const std::vector<double>& y, std::size_t i) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a <= i; ++a) {
    double least = std::numeric_limits<double>::infinity(), sum = 0;
    for (std::size_t b = a; b < y.size(); ++b) {
      sum += y[b];
      if (b >= i) least = std::min(least, sum / static_cast<double>(b - a + 1));
    }
    most = std::max(most, least);
  }
  return most;
}

} // namespace

TEST_CASE("the curve of failures is the rising function of least squares", "[needed]") {
  std::mt19937 random(3);
  for (const int n : {1, 2, 7, 60}) {
    std::vector<double> y, index;
    for (int i = 0; i < n; ++i) {
      index.push_back(i);
      y.push_back(std::uniform_int_distribution(0, n)(random) < i ? 1 : 0);
    }
    const FailureCurve curve(index, y);
    for (std::size_t i = 0; i < y.size(); ++i)
      CHECK(curve.at(index[i]) == Approx(max_min(y, i)).margin(1e-12));
  }
}

TEST_CASE("gaps of the curve have the share of the larger index; equal indices share one value",
          "[needed]") {
  const std::vector<double> index{3, 1, 1, 2, 3}, failed{1, 0, 0, 1, 0};
  const FailureCurve curve(index, failed); // 0 at 1; (1 + 1 + 0)/3 at 2 and 3
  CHECK(curve.at(0) == 0);
  CHECK(curve.at(1) == 0);
  CHECK(curve.at(1.01) == Approx(2 / 3.));
  CHECK(curve.at(2.5) == Approx(2 / 3.));
  CHECK(curve.at(9) == Approx(2 / 3.));
}
