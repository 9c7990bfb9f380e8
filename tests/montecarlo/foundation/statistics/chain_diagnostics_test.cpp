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
    const auto [r_hat, ess] = diagnose(chains_of(20, 2000, phi));
    CHECK(ess == Approx(40000 * (1 - phi) / (1 + phi))
                     .epsilon(0.2)); // heuristic: 11 % off at φ = 0.9 with these draws
    CHECK(r_hat == Approx(1).margin(0.01));
  }
}

TEST_CASE("chains that lie apart, and chains that drift, are seen") {
  CHECK(diagnose(chains_of(4, 1000, 0.5, 1)).r_hat > 1.2);
  std::vector<std::vector<double>> drifting = chains_of(4, 1000, 0.5);
  for (auto& chain : drifting)
    for (std::size_t n = 0; n < chain.size(); ++n) chain[n] += 0.003 * static_cast<double>(n);
  CHECK(diagnose(drifting).r_hat > 1.2); // the halves differ
  CHECK(diagnose(drifting).ess < 100);
  CHECK(
      std::isinf(diagnose(std::vector<std::vector<double>>(4, std::vector<double>(100, 1))).r_hat));
}
