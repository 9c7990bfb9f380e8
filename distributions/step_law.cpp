#include "distributions/step_law.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <numeric>

namespace wingspread {
namespace {

/// The indices of the values with positive weight, in ascending order of the values.
std::vector<std::size_t> ascending(const Discrete& law) {
  std::vector<std::size_t> order(law.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return law.weights[i] == 0; });
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return law.values[i]; });
  return order;
}

/// The number of values ≤ x.
std::ptrdiff_t count_to(const StepLaw& law, double x) {
  return std::distance(law.values.begin(), std::ranges::upper_bound(law.values, x));
}

} // namespace

StepLaw step_law(const Discrete& law) {
  const std::vector<std::size_t> order = ascending(law);
  const std::size_t n = order.size();
  StepLaw table{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    table.values[i] = law.values[order[i]];
    table.below[i] = sum += law.weights[order[i]];
  }
  double rest = 0;
  for (std::size_t i = n; i-- > 0; rest += law.weights[order[i]]) table.above[i] = rest / sum;
  for (double& below : table.below) below /= sum;
  return table;
}

StepLaw step_law(const Empirical& law) {
  return step_law(Discrete{law.values, std::vector<double>(law.values.size(), 1.)});
}

StepLaw step_law(const Constant& law) { return {{law.value}, {1}, {0}}; }

double quantile(const StepLaw& law, double u) {
  const auto at = std::ranges::lower_bound(law.below, u);
  return law.values[std::distance(law.below.begin(), at)];
}

double quantile_complement(const StepLaw& law, double q) {
  const auto at = std::ranges::lower_bound(law.above, q, std::greater{});
  return law.values[std::distance(law.above.begin(), at)];
}

double cdf(const StepLaw& law, double x) {
  const std::ptrdiff_t n = count_to(law, x);
  return n == 0 ? 0 : law.below[n - 1];
}

double cdf_complement(const StepLaw& law, double x) {
  const std::ptrdiff_t n = count_to(law, x);
  return n == 0 ? 1 : law.above[n - 1];
}

} // namespace wingspread
