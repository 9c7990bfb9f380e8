/// Samples for tests of statistics, and what chance allows them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace wingspread::test {

inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

inline std::vector<double> sorted_sample(int n, std::mt19937_64& random) {
  std::vector<double> sample(static_cast<std::size_t>(n));
  std::ranges::generate(sample, [&] { return uniform(random); });
  std::ranges::sort(sample);
  return sample;
}

/// Five standard errors of a share seen in `trials`: chance leaves this band once in a million
/// times.
inline double band(double share, int trials) { return 5 * std::sqrt(share * (1 - share) / trials); }

} // namespace wingspread::test
