#include "distributions/continuous_law.hpp"
#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/statistics/chain_diagnostics.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

namespace {

/// Chains x' = φ x + √(1 − φ²) ξ: autocorrelation φ^k, so that ESS = n (1 − φ)/(1 + φ).
std::vector<std::vector<double>> chains_of(std::size_t count, std::size_t length, double phi,
                                           double apart = 0) {
  std::vector<std::vector<double>> chains(count);
  for (std::size_t c = 0; c < count; ++c) {
    RandomStream random(9, c, stream_name("chain"));
    const auto normal = [&] { return inverse(Normal{}, tails_of_uniform(open_uniform(random()))); };
    double x = normal();
    for (std::size_t n = 0; n < length; ++n) {
      chains[c].push_back(x + apart * static_cast<double>(c));
      x = phi * x + std::sqrt(1 - phi * phi) * normal();
    }
  }
  return chains;
}

} // namespace

TEST_CASE("the effective sample size of a chain with a known autocorrelation") {
  for (const double phi : {0.0, 0.5, 0.9}) {
    const auto [r_hat, ess] = diagnose(chains_of(20, 2000, phi), 4);
    CHECK(ess == Approx(40000 * (1 - phi) / (1 + phi))
                     .epsilon(0.2)); // heuristic: 11 % off at φ = 0.9 with these draws
    CHECK(r_hat == Approx(1).margin(0.01));
  }
}

TEST_CASE("chains that lie apart, and chains that drift, are seen") {
  CHECK(diagnose(chains_of(4, 1000, 0.5, 1), 4).r_hat > 1.2);
  std::vector<std::vector<double>> drifting = chains_of(4, 1000, 0.5);
  for (auto& chain : drifting)
    for (std::size_t n = 0; n < chain.size(); ++n) chain[n] += 0.003 * static_cast<double>(n);
  CHECK(diagnose(drifting, 4).r_hat > 1.2); // the halves differ
  CHECK(diagnose(drifting, 4).ess < 100);
  CHECK(std::isinf(
      diagnose(std::vector<std::vector<double>>(4, std::vector<double>(100, 1)), 4).r_hat));
}

TEST_CASE("many short chains at their goal need no more samples than a few long ones") {
  const auto chains = chains_of(40, 60, 0.5); // 800 effective samples
  CHECK(diagnose(chains, 4).r_hat < 1.015);   // √(1 + 2 · 4/800) = 1.005
  CHECK(diagnose(chains, 40).r_hat > 1.03);   // √(1 + 2 · 40/800) = 1.05
}

TEST_CASE("chains that hardly move are seen, whatever the group") {
  std::vector<std::vector<double>> chains = chains_of(40, 100, 0.999); // from independent starts
  CHECK(diagnose(chains, 4).r_hat > 1.02);
  CHECK(diagnose(chains, 4).ess < 200);
  for (std::size_t c = 0; c < chains.size(); ++c) // chains of one group lie apart
    for (double& x : chains[c]) x += c / 4 % 2 == 0 ? 50 : -50;
  CHECK(diagnose(chains, 4).ess < 100);
}

TEST_CASE("the nested R-hat has its definition's value") {
  // Two groups of two chains of four. Halves' means: group 0: {1.5, 3.5}, {5.5, 3.5}; group 1: {2, 2}, {6, 4}.
  const std::vector<std::vector<double>> chains{
      {1, 2, 5, 6}, {1, 3, 5, 7}, {3, 4, 3, 4}, {1, 3, 3, 5}};
  // Variances in halves: .5 .5 | .5 .5 and 2 2 | 2 2. Of means: 2, 2, 0, 2. Centers: 2.5, 4.5, 2, 5.
  const double within = ((0.5 + 2) + (0.5 + 2) + (2 + 0) + (2 + 2)) / 4;
  const double between = (1.0 + 1.0 + 2.25 + 2.25) / 3; // about 3.5
  CHECK(diagnose(chains, 2).r_hat == Approx(std::sqrt(1 + between / within)).epsilon(1e-12));
}

// Python 3.11: of the four halves ρ_0 + ρ_1 = 1.215, ρ_2 + ρ_3 = 0.118, and ρ_4 + ρ_5 = 0.651 counts as the 0.118 before it.
TEST_CASE("a pair of autocorrelations counts no more than the one before it") {
  const std::vector<std::vector<double>> chains{{1, 4, 3, 4, 2, 3, 3, 3, 0, 0, 2, 3},
                                                {2, 2, 0, 1, 0, 3, 4, 4, 3, 1, 4, 4}};
  CHECK(diagnose(chains, 1).ess == Approx(12.616071428571425).epsilon(1e-12));
}
