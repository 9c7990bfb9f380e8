#include "montecarlo/foundation/statistics/jackknife.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wingspread {

Bounds jackknife_bounds(double value, std::span<const double> without_each, double confidence) {
  const long groups = std::ssize(without_each);
  const auto is_number = [](double each) { return std::isfinite(each); };
  if (groups < 2 || !is_number(value) || !std::ranges::all_of(without_each, is_number)) return {};
  const auto count = static_cast<double>(groups);
  const double error = moments(without_each).std * (count - 1) / std::sqrt(count); // (1)
  if (!(error > 0)) return {};
  const double reach = two_sided_student(groups - 1, confidence) * error;
  return {value - reach, value + reach};
}

Bounds from_z(const Bounds& z) {
  if (!z.lower || !z.upper) return {};
  return {std::tanh(*z.lower), std::tanh(*z.upper)};
}

Bounds jackknife_correlation_bounds(double coefficient, std::span<const double> without_each,
                                    double confidence) {
  std::vector<double> z;
  for (const double each : without_each) z.push_back(std::atanh(each));
  return from_z(jackknife_bounds(std::atanh(coefficient), z, confidence));
}

} // namespace wingspread
