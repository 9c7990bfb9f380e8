/// Limit states of known probability for the tests of subset simulation.
#pragma once

#include "montecarlo/analyses/rare/subset_simulation.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace wingspread::oracle {

using PointFunction = std::function<double(const NormalPoint&)>;

inline LimitStateFunction limit_state(const PointFunction& g) {
  return [g](std::span<const NormalPoint> points) {
    std::vector<double> values;
    for (const NormalPoint& point : points) values.push_back(g(point));
    return values;
  };
}

/// β − Σ z_i/√d: P = Φ(−β).
inline PointFunction linear(double beta) {
  return [beta](const NormalPoint& z) {
    return beta - std::accumulate(z.begin(), z.end(), 0.0) / std::sqrt(double(z.size()));
  };
}

inline double normal_tail(double beta) { return std::erfc(beta / std::sqrt(2)) / 2; }

/// The points of the first level have these, in their order; all others are far away, so that no move is taken.
inline LimitStateFunction never_nearer(std::vector<double> first) {
  return [first, begins = true](std::span<const NormalPoint> points) mutable {
    if (!std::exchange(begins, false)) return std::vector<double>(points.size(), 1e9);
    return first;
  };
}

inline RareEstimate repeated(const PointFunction& g, std::size_t d, long samples, long repeats,
                             std::uint64_t seed) {
  std::vector<SubsetEstimate> estimates;
  for (long k = 0; k < repeats; ++k)
    estimates.push_back(subset_simulation(
        limit_state(g), d,
        {.samples = samples, .seed = seed, .repetition = static_cast<std::uint64_t>(k)}));
  return combined(estimates, 0.95);
}

} // namespace wingspread::oracle
