/// Samples for tests of statistics, and the tolerances that chance requires.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace wingspread::test {

/// The value of a run without this number.
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

inline std::vector<double> uniforms(std::uint64_t seed, int n) {
  std::mt19937_64 random(seed);
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(uniform(random));
  return values;
}

inline std::vector<double> sorted_sample(int n, std::mt19937_64& random) {
  std::vector<double> sample(static_cast<std::size_t>(n));
  std::ranges::generate(sample, [&] { return uniform(random); });
  std::ranges::sort(sample);
  return sample;
}

inline Approx within(double value, double relative) {
  return Approx(value).epsilon(relative).margin(1e-300);
}

/// Five standard errors of a share observed in `trials`. Chance exceeds them about once in a million times.
inline double band(double share, int trials) { return 5 * std::sqrt(share * (1 - share) / trials); }

} // namespace wingspread::test
