#include "distributions/step_law.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

namespace {

// Out of order, with a repeated value and a value of no weight at either end.
const Discrete dice{{9, 3, 1, 3, 2, 0}, {0, 1, 2, 3, 2, 0}};

} // namespace

TEST_CASE("a discrete law's table is sorted and leaves out what has no weight") {
  const StepLaw law = step_law(dice);
  CHECK(law.values == std::vector<double>{1, 2, 3, 3});
  CHECK(law.below == std::vector<double>{0.25, 0.5, 0.625, 1});
  CHECK(law.above == std::vector<double>{0.75, 0.5, 0.375, 0});
}

TEST_CASE("a discrete quantile is the smallest value that reaches the probability") {
  const StepLaw law = step_law(dice);
  CHECK(quantile(law, 0) == 1); // not 0, which has no weight
  CHECK(quantile(law, 0x1p-53) == 1);
  CHECK(quantile(law, 0.25) == 1);
  CHECK(quantile(law, std::nextafter(0.25, 1)) == 2);
  CHECK(quantile(law, 0.5) == 2);
  CHECK(quantile(law, 0.75) == 3);
  CHECK(quantile(law, 1) == 3);
  CHECK(quantile_complement(law, 1) == 1);
  CHECK(quantile_complement(law, 0.75) == 1);
  CHECK(quantile_complement(law, std::nextafter(0.75, 0)) == 2);
  CHECK(quantile_complement(law, 0.5) == 2);
  CHECK(quantile_complement(law, 0.4) == 3);
  CHECK(quantile_complement(law, 0) == 3);
}

TEST_CASE("a discrete distribution function counts what lies at or below") {
  const StepLaw law = step_law(dice);
  CHECK(cdf(law, 0.5) == 0);
  CHECK(cdf(law, 1) == 0.25);
  CHECK(cdf(law, 2.5) == 0.5);
  CHECK(cdf(law, 3) == 1);
  CHECK(cdf_complement(law, 0.5) == 1);
  CHECK(cdf_complement(law, 1) == 0.75);
  CHECK(cdf_complement(law, 2.5) == 0.5);
  CHECK(cdf_complement(law, 3) == 0);
}

TEST_CASE("a step law's quantile and distribution function undo each other, rounding included") {
  Discrete uneven;
  for (int i = 0; i < 1000; ++i) {
    uneven.values.push_back(std::sin(i));
    uneven.weights.push_back(1. / (1 + i));
  }
  const StepLaw law = step_law(uneven);
  for (const double value : uneven.values) {
    CHECK(quantile(law, cdf(law, value)) == value);
    CHECK(quantile_complement(law, cdf_complement(law, value)) == value);
  }
  CHECK(law.below.back() == 1);
}

TEST_CASE("a tail far below epsilon is kept by the complement") {
  const StepLaw law = step_law(Discrete{{1, 2}, {1, 1e-30}});
  CHECK(cdf_complement(law, 1) == Approx(1e-30).epsilon(1e-15));
  CHECK(quantile_complement(law, 0.9e-30) == 2);
  CHECK(quantile_complement(law, 1.1e-30) == 1);
}

TEST_CASE("an empirical law draws the data, each as often as the others") {
  const StepLaw law = step_law(Empirical{{5, -1, 5, 2}});
  CHECK(quantile(law, 0.2) == -1);
  CHECK(quantile(law, 0.25) == -1);
  CHECK(quantile(law, 0.26) == 2); // the data's own values, nothing between
  CHECK(quantile(law, 0.51) == 5);
  CHECK(cdf(law, 5) == 1);
  CHECK(cdf(law, 4.9) == 0.5);
}

TEST_CASE("a constant law always draws its value") {
  const StepLaw law = step_law(Constant{-2.5});
  for (const double u : {0., 0x1p-53, 0.5, 1.}) {
    CHECK(quantile(law, u) == -2.5);
    CHECK(quantile_complement(law, u) == -2.5);
  }
  CHECK(cdf(law, -2.6) == 0);
  CHECK(cdf(law, -2.5) == 1);
}
