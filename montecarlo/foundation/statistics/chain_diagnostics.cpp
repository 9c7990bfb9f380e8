#include "montecarlo/foundation/statistics/chain_diagnostics.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace wingspread {
namespace {

/// Mean over the chains of Σ (x_i − m)(x_{i+k} − m)/N, m the chain's mean.
double autocovariance(std::span<const std::span<const double>> chains,
                      std::span<const double> means, std::size_t lag) {
  Sum sum;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const std::span<const double> x = chains[c];
    double own = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i)
      own += (x[i] - means[c]) * (x[i + lag] - means[c]);
    sum.add(own / static_cast<double>(x.size()));
  }
  return sum.value() / static_cast<double>(chains.size());
}

/// (2). @param halves of chain after chain, first and second
double nested_r_hat(std::span<const std::span<const double>> halves, std::span<const double> means,
                    std::size_t groups) {
  std::vector<double> centers, variances; // of superchains
  for (std::size_t first = 0; first < 2 * groups; ++first) {
    std::vector<double> own;
    Sum within;
    for (std::size_t k = first; k < halves.size(); k += 2 * groups) {
      own.push_back(means[k]);
      within.add(std::pow(moments(halves[k]).std, 2));
    }
    const Moments between = moments(own);
    centers.push_back(between.mean);
    variances.push_back(within.value() / static_cast<double>(own.size()) +
                        (own.size() > 1 ? between.std * between.std : 0));
  }
  return std::sqrt(1 + std::pow(moments(centers).std, 2) / moments(variances).mean);
}

} // namespace

ChainDiagnostics diagnose(std::span<const std::vector<double>> chains, std::size_t groups) {
  std::vector<std::span<const double>> halves;
  const std::size_t n = chains.front().size() / 2;
  assert(n >= 2);
  for (const std::vector<double>& chain : chains) {
    halves.emplace_back(chain.data(), n);
    halves.emplace_back(chain.data() + chain.size() - n, n);
  }
  std::vector<double> means;
  for (const auto& half : halves) means.push_back(moments(half).mean);
  const auto length = static_cast<double>(n), count = static_cast<double>(halves.size());
  const double within = autocovariance(halves, means, 0) * length / (length - 1);
  const double between = std::pow(moments(means).std, 2); // B/N
  const double total = within * (length - 1) / length + between;
  if (!(within > 0)) return {std::numeric_limits<double>::infinity(), 1};
  double pairs = 0, last = std::numeric_limits<double>::infinity();
  const auto rho = [&](std::size_t lag) {
    return lag == 0 ? 1 : 1 - (within - autocovariance(halves, means, lag)) / total;
  };
  for (std::size_t lag = 0; lag + 1 < n; lag += 2) {
    const double pair = rho(lag) + rho(lag + 1);
    if (!(pair > 0)) break;
    pairs += last = std::min(last, pair);
  }
  const double time = std::max(1.0, 2 * pairs - 1);
  return {nested_r_hat(halves, means, groups), length * count / time};
}

} // namespace wingspread
