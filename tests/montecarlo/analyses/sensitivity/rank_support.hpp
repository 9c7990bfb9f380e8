/// Results made of normal columns, for the tests of the rank coefficients.
#pragma once

#include "distributions/continuous_law.hpp"
#include "distributions/random_stream.hpp"
#include "montecarlo/analyses/sensitivity/rank_sensitivity.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace wingspread::test {

using Columns = std::vector<std::vector<double>>;

/// Standard normal columns.
inline Columns normal_columns(std::size_t columns, std::size_t n, std::uint64_t seed) {
  Columns x(columns);
  for (std::size_t j = 0; j < columns; ++j) {
    RandomStream stream(seed, j, stream_name("test"));
    for (std::size_t k = 0; k < n; ++k) {
      const double u = open_uniform(stream());
      x[j].push_back(inverse(Normal{}, {u, 1 - u}));
    }
  }
  return x;
}

inline std::vector<double> combination(const Columns& x, const std::vector<double>& weights) {
  std::vector<double> y(x.front().size(), 0.0);
  for (std::size_t j = 0; j < weights.size(); ++j)
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += weights[j] * x[j][k];
  return y;
}

/// Runs of which all deployed, with draws x0, x1, … and the output "y".
inline Results results_of(const Columns& x, const std::vector<double>& y) {
  Results results;
  for (std::size_t j = 0; j < x.size(); ++j)
    results.draws.push_back({std::string("x") += std::to_string(j), x[j]});
  results.outputs.push_back({"y", y});
  for (std::size_t k = 0; k < y.size(); ++k) {
    results.runs.push_back(static_cast<long>(k));
    results.status.push_back(Status::deployed);
    results.latch_order.push_back("");
    results.reason.push_back("");
  }
  return results;
}

} // namespace wingspread::test
