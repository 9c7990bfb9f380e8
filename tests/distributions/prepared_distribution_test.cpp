#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"
#include "tests/distributions/reference_laws.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::vector<double> draws(const Distribution& distribution, const std::string& name,
                          std::size_t count = 200000) {
  const PreparedDistribution prepared(distribution);
  const StreamName stream = stream_name(name);
  std::vector<double> values(count);
  for (std::size_t run = 0; run < count; ++run)
    values[run] = prepared.quantile(uniform(1, run, stream));
  return values;
}

double central_moment(const std::vector<double>& values, double mean, int power) {
  double sum = 0;
  for (const double value : values) sum += std::pow(value - mean, power);
  return sum / static_cast<double>(values.size());
}

// Mean and standard deviation within 5 of their standard errors. The error of the standard
// deviation takes the fourth moment, from the sample itself.
void check_sample(const std::vector<double>& values, LawMoments expected) {
  const auto [mean, std] = expected;
  const double root = std::sqrt(static_cast<double>(values.size()));
  const double variance = central_moment(values, mean, 2);
  const double fourth = central_moment(values, mean, 4);
  CHECK(std::abs(central_moment(values, mean, 1)) <= 5 * std / root);
  CHECK(std::abs(std::sqrt(variance) - std) <=
        5 * std::sqrt(fourth - variance * variance) / (2 * std) / root);
}

} // namespace

TEST_CASE("drawn samples have the continuous laws' moments") {
  for (const ContinuousLaw& law : reference_laws()) {
    if (law.index() == 3 && std::get<Lognormal>(law).sigma_log > 1)
      continue; // so skewed that a sample's standard error says nothing
    CAPTURE(law.index(), support(law).lower, continuous_moments(law).mean);
    const Law whole = std::visit([](const auto& l) { return Law(l); }, law);
    check_sample(draws({whole, {}}, "moments of " + std::to_string(law.index())),
                 continuous_moments(law));
  }
}

TEST_CASE("drawn samples have the step laws' moments") {
  for (const Law& law : {Law(Discrete{{3, 1, 2, 7}, {1, 2, 0, 3}}), Law(Empirical{{5, -1, 5, 2}})})
    check_sample(draws({law, {}}, "steps"), moments(law));
  for (const double value : draws({Constant{3}, {}}, "constant", 10)) CHECK(value == 3);
}

// Mean and variance of a truncated normal law from its density φ (Johnson, Kotz & Balakrishnan,
// Continuous Univariate Distributions 1, 13.10).
TEST_CASE("drawn samples have the moments of the truncated law") {
  const double a = -0.5;
  const double b = 1.5;
  const double mass = static_cast<double>(probability(Normal{}, a, b));
  const auto phi = [](double x) { return static_cast<double>(density(Normal{}, x)); };
  const double mean = (phi(a) - phi(b)) / mass;
  const double variance = 1 + (a * phi(a) - b * phi(b)) / mass - mean * mean;
  check_sample(draws({Normal{}, Truncation{a, b}}, "truncated"), {mean, std::sqrt(variance)});
}

TEST_CASE("discrete values come as often as their weights say") {
  const std::vector<double> sample = draws({Discrete{{0, 1, 2}, {1, 2, 5}}, {}}, "weights");
  const double n = static_cast<double>(sample.size());
  for (const auto& [value, p] : {std::pair{0, 0.125}, std::pair{1, 0.25}, std::pair{2, 0.625}}) {
    const auto count = static_cast<double>(std::ranges::count(sample, value));
    CHECK(std::abs(count - n * p) < 5 * std::sqrt(n * p * (1 - p)));
  }
}

TEST_CASE("a prepared distribution answers as its law does") {
  const PreparedDistribution normal({Normal{1, 2}, {}});
  const Tails at = tails(Normal{1, 2}, 12);
  CHECK(normal.cdf(12) == at.below);
  CHECK(normal.cdf_complement(12) == at.above);
  CHECK(normal.quantile(0.25) == inverse(Normal{1, 2}, {0.25, 0.75}));
  CHECK(normal.quantile_complement(1e-20) == inverse(Normal{1, 2}, {1, 1e-20}));

  const PreparedDistribution far({Normal{}, Truncation{8, 9}});
  const TruncatedLaw truncated_law = truncated(Normal{}, {8, 9});
  CHECK(far.quantile(0.25) == quantile(truncated_law, 0.25));
  CHECK(far.quantile_complement(0.25) == quantile_complement(truncated_law, 0.25));
  CHECK(far.cdf(8.5) == cdf(truncated_law, 8.5));
  CHECK(far.cdf_complement(8.5) == cdf_complement(truncated_law, 8.5));

  const PreparedDistribution steps({Discrete{{4, 2}, {1, 3}}, {}});
  CHECK(steps.quantile(0.75) == 2);
  CHECK(steps.quantile_complement(0.2) == 4);
  CHECK(steps.cdf(2) == 0.75);
  CHECK(steps.cdf_complement(2) == 0.25);
}
