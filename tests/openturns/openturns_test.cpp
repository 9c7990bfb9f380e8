/// What others compute too, held against OpenTURNS (libopenturns-dev), which shares no code with this program and is
/// written by other people from other sources: sizes of samples, laws, dependence, rank correlations, rare events.
#include "distributions/copula.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/analyses/rare/subset_simulation.hpp"
#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"
#include "montecarlo/foundation/statistics/rank_correlation.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"

#include <catch2/catch.hpp>
#include <openturns/Beta.hxx>
#include <openturns/CompositeRandomVector.hxx>
#include <openturns/CorrelationAnalysis.hxx>
#include <openturns/Exponential.hxx>
#include <openturns/Gamma.hxx>
#include <openturns/Less.hxx>
#include <openturns/LogNormal.hxx>
#include <openturns/Normal.hxx>
#include <openturns/NormalCopula.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/RandomVector.hxx>
#include <openturns/SubsetSampling.hxx>
#include <openturns/SymbolicFunction.hxx>
#include <openturns/ThresholdEvent.hxx>
#include <openturns/Triangular.hxx>
#include <openturns/TruncatedDistribution.hxx>
#include <openturns/Uniform.hxx>
#include <openturns/WeibullMin.hxx>
#include <openturns/Wilks.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace wingspread;

TEST_CASE("sizes of samples are those of OpenTURNS") {
  for (const double p : {.5, .9, .95, .99, .9973, .99865})
    for (const double c : {.5, .9, .95, .99})
      for (const unsigned order : {1u, 2u, 3u, 10u}) {
        CAPTURE(p, c, order);
        CHECK(runs_to_show(p, c, order - 1) ==
              static_cast<long>(OT::Wilks::ComputeSampleSize(p, c, order - 1)));
      }
}

// OpenTURNS gives quantiles to 1e-8 or so where it iterates (gamma, beta).
TEST_CASE("laws have the quantiles that OpenTURNS gives them, on either side") {
  const std::vector<std::pair<Distribution, OT::Distribution>> laws{
      {{Normal{1, 0.05}, {}}, OT::Normal(1, 0.05)},
      {{Uniform{-1, 2}, {}}, OT::Uniform(-1, 2)},
      {{Triangular{-1, 0.25, 2}, {}}, OT::Triangular(-1, 0.25, 2)},
      {{Lognormal{0.1, 0.3}, {}}, OT::LogNormal(0.1, 0.3)},
      {{Weibull{0.7, 2}, {}}, OT::WeibullMin(2, 0.7)}, // its scale comes first
      {{Weibull{3.5, 1.2}, {}}, OT::WeibullMin(1.2, 3.5)},
      {{Gamma{4, 0.5}, {}}, OT::Gamma(4, 2)}, // its second parameter is the rate
      {{Gamma{0.3, 2}, {}}, OT::Gamma(0.3, 0.5)},
      {{Beta{2, 3, -1, 4}, {}}, OT::Beta(2, 3, -1, 4)},
      {{Exponential{0.25}, {}}, OT::Exponential(0.25)},
      {{Normal{1, 0.05}, Truncation{0.9, 1.02}},
       OT::TruncatedDistribution(OT::Normal(1, 0.05), 0.9, 1.02)},
      {{Lognormal{0, 0.5}, Truncation{0.5, 3}},
       OT::TruncatedDistribution(OT::LogNormal(0, 0.5), 0.5, 3.0)}};
  for (const auto& [ours, theirs] : laws) {
    const PreparedDistribution law(ours);
    CAPTURE(theirs.__str__());
    for (const double u : {1e-4, 0.01, 0.3, 0.5, 0.77, 0.99, 0.9999}) {
      CHECK(law.quantile(u) == Approx(theirs.computeQuantile(u)[0]).epsilon(1e-7));
      CHECK(law.cdf(law.quantile(u)) ==
            Approx(theirs.computeCDF(OT::Point(1, law.quantile(u)))).epsilon(1e-9));
    }
  }
}

TEST_CASE("rank correlations become normal ones as in OpenTURNS") {
  OT::CorrelationMatrix spearman(3);
  spearman(0, 1) = 0.6, spearman(1, 2) = -0.8, spearman(0, 2) = -0.3;
  const OT::CorrelationMatrix theirs =
      OT::NormalCopula::GetCorrelationFromSpearmanCorrelation(spearman);
  const std::vector<RankCorrelation> pairs{{0, 1, 0.6}, {1, 2, -0.8}, {0, 2, -0.3}};
  const Eigen::MatrixXd ours = normal_correlations(3, pairs);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const auto row = static_cast<OT::UnsignedInteger>(i),
                 column = static_cast<OT::UnsignedInteger>(j);
      CHECK(ours(i, j) == Approx(theirs(row, column)).epsilon(1e-14));
    }
}

// Columns that correlate with each other, without ties, of which the output is a bent function.
TEST_CASE("Spearman's and partial rank correlations are those of OpenTURNS") {
  constexpr std::size_t n = 400, k = 4;
  std::mt19937_64 random(91);
  std::normal_distribution<double> normal;
  std::vector<Spilled<double>> columns(k);
  Spilled<double> output;
  OT::Sample x(n, k), y(n, 1);
  for (std::size_t row = 0; row < n; ++row) {
    std::array<double, k> at{};
    const double common = normal(random);
    for (std::size_t j = 0; j < k; ++j)
      at[j] = normal(random) + 0.4 * static_cast<double>(j) * common;
    const double value = std::exp(at[0]) + at[1] * at[1] * at[1] - 2 * at[3] + 0.5 * normal(random);
    for (std::size_t j = 0; j < k; ++j) columns[j].push_back(x(row, j) = at[j]);
    output.push_back(y(row, 0) = value);
  }
  const OT::CorrelationAnalysis theirs(x, y);
  const OT::Point spearman = theirs.computeSpearmanCorrelation(), partial = theirs.computePRCC();

  std::vector<const Spilled<double>*> all;
  for (const auto& column : columns) all.push_back(&column);
  const std::vector<const Spilled<double>*> of{&output};
  const std::vector<RankedColumn> ranked = rank_columns(all), ranked_output = rank_columns(of);
  const std::vector<Correlation> found = pairwise_correlations(ranked, ranked_output);
  std::vector<Spilled<double>> ranks;
  for (const RankedColumn& column : ranked) ranks.emplace_back(column.ranks());
  std::vector<double> plain;
  for (std::size_t j = 0; j < k; ++j) {
    CHECK(found[j].spearman == Approx(spearman[j]).epsilon(1e-10));
    plain.push_back(found[j].spearman);
  }
  const std::vector<double> given = PartialCorrelations(ranks).given(plain);
  for (std::size_t j = 0; j < k; ++j) CHECK(given[j] == Approx(partial[j]).epsilon(1e-9));
}

// Beyond either of two curves on opposite sides, at about 5e-4. Both are subset simulations, by different moves; each is
// known to its own spread over forty.
TEST_CASE("a rare event has the probability that OpenTURNS' subset sampling finds") {
  constexpr int repeats = 40;
  struct Spread {
    double sum = 0, square = 0;
    void add(double value) { sum += value, square += value * value; }
    [[nodiscard]] double mean() const { return sum / repeats; }
    [[nodiscard]] double error() const {
      return std::sqrt((square / repeats - mean() * mean()) / (repeats - 1));
    }
  };
  const LimitStateFunction g = [](std::span<const NormalPoint> points) {
    std::vector<double> values;
    for (const NormalPoint& z : points)
      values.push_back(
          std::min(3.2 - z[0] + 0.1 * (z[2] * z[2] + z[3]), 3.5 + z[1] + 0.2 * z[0] * z[2]));
    return values;
  };
  const OT::SymbolicFunction same(
      OT::Description{"z0", "z1", "z2", "z3"},
      OT::Description{"min(3.2 - z0 + 0.1*(z2*z2 + z3), 3.5 + z1 + 0.2*z0*z2)"});
  OT::RandomGenerator::SetSeed(5);
  Spread ours, theirs;
  for (int k = 0; k < repeats; ++k) {
    ours.add(subset_simulation(
                 g, 4, {.samples = 1000, .seed = 6, .repetition = static_cast<std::uint64_t>(k)})
                 .probability);
    const OT::RandomVector point(OT::Normal(4)), value(OT::CompositeRandomVector(same, point));
    OT::SubsetSampling sampling(OT::ThresholdEvent(value, OT::Less(), 0.0));
    sampling.setMaximumOuterSampling(1000);
    sampling.setBlockSize(1);
    sampling.run();
    theirs.add(sampling.getResult().getProbabilityEstimate());
  }
  INFO(ours.mean() << " ± " << ours.error() << ", OpenTURNS " << theirs.mean() << " ± "
                   << theirs.error());
  CHECK(ours.error() < 0.1 * ours.mean());
  CHECK(theirs.error() < 0.1 * theirs.mean());
  CHECK(std::abs(ours.mean() - theirs.mean()) < 4 * std::hypot(ours.error(), theirs.error()));
}
