#include "montecarlo/foundation/statistics/statistics.hpp"

#include <boost/sort/pdqsort/pdqsort.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace wingspread {

namespace {

/// The mean as shift + rest. Subtracting the shift, one of the values, is exact if the values are close to each other,
/// so deviations lose no digits. The shift is the middle value, of a sorted sample its median: from an end of a long
/// tail, the subtraction would cost every other value its last digits.
struct ShiftedMean {
  double shift, rest;
  [[nodiscard]] double deviation(double value) const { return (value - shift) - rest; }
};

ShiftedMean shifted_mean(std::span<const double> values) {
  const double shift = values[values.size() / 2];
  Sum sum;
  for (const double value : values) sum.add(value - shift);
  return {shift, sum.value() / static_cast<double>(values.size())};
}

/// Largest |deviation|. Sums of powers of deviations divided by it neither overflow nor vanish.
double largest_deviation(std::span<const double> values, const ShiftedMean& mean) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(mean.deviation(value)));
  return largest;
}

/// Fills in std, skewness and kurtosis of a sample that is not constant.
void add_shape(std::span<const double> values, const ShiftedMean& mean, Moments& result) {
  const double n = static_cast<double>(values.size());
  const double scale = largest_deviation(values, mean);
  Sum sum2, sum3, sum4;
  for (const double value : values) {
    const double z = mean.deviation(value) / scale;
    sum2.add(z * z);
    sum3.add(z * z * z);
    sum4.add(z * z * z * z);
  }
  const double m2 = sum2.value() / n, m3 = sum3.value() / n, m4 = sum4.value() / n;
  result.std = scale * std::sqrt(sum2.value() / (n - 1));
  set_shape(m2, m3, m4, result);
}

} // namespace

void set_shape(double m2, double m3, double m4, Moments& moments) {
  const auto n = static_cast<double>(moments.count);
  if (n > 2) moments.skewness = m3 / (m2 * std::sqrt(m2)) * std::sqrt(n * (n - 1)) / (n - 2);
  if (n > 3)
    moments.kurtosis = (n - 1) / ((n - 2) * (n - 3)) * ((n + 1) * (m4 / (m2 * m2) - 3) + 6);
}

Moments moments(std::span<const double> values) {
  Moments result{static_cast<long>(values.size()),
                 undefined,
                 undefined,
                 undefined,
                 undefined,
                 undefined,
                 undefined};
  if (values.empty()) return result;
  const auto [min, max] = std::ranges::minmax(values);
  const ShiftedMean mean = shifted_mean(values);
  result.mean = std::clamp(mean.shift + mean.rest, min, max);
  result.min = min;
  result.max = max;
  if (min < max)
    add_shape(values, mean, result);
  else if (values.size() > 1)
    result.std = 0;
  return result;
}

bool varies(std::span<const double> values) {
  return std::ranges::any_of(values, [&](double value) { return value != values.front(); });
}

std::vector<double> sorted_present(std::span<const double> values) {
  std::vector<double> present;
  present.reserve(values.size());
  std::ranges::copy_if(values, std::back_inserter(present),
                       [](double v) { return !std::isnan(v); });
  sort_values(present);
  return present;
}

void sort_values(std::span<double> values) {
  boost::sort::pdqsort_branchless(values.begin(), values.end());
  // −0 and 0 are equal to the comparison: put −0 first, so that the sign of a minimum does not depend on the rows'
  // order.
  const auto [first, last] = std::equal_range(values.begin(), values.end(), 0.0);
  std::partition(first, last, [](double zero) { return std::signbit(zero); });
}

long quantile_rank(long n, double p) {
  assert(n > 0 && p >= 0 && p <= 1);
  const double product = static_cast<double>(n) * p;
  // p and the product each carry half a unit in the last place.
  const double slack = 2 * std::numeric_limits<double>::epsilon() * product;
  return std::clamp(std::lround(std::ceil(product - slack)), 1L, n);
}

double quantile(std::span<const double> sorted, double p) {
  return quantile(sorted, {std::ssize(sorted)}, p);
}

double quantile(std::span<const double> sorted, const PartialRanks& ranks, double p) {
  if (sorted.empty()) return undefined;
  const auto rank = ranks.among_present(quantile_rank(ranks.all(), p));
  return rank ? sorted[static_cast<std::size_t>(*rank - 1)] : undefined;
}

std::optional<Standard> standard_of(std::span<const double> values) {
  if (values.size() < 2 || !varies(values)) return std::nullopt;
  const ShiftedMean mean = shifted_mean(values);
  Standard standard{mean.shift, mean.rest, largest_deviation(values, mean), 0};
  Sum squares;
  for (const double value : values) {
    const double z = standard.of(value);
    squares.add(z * z);
  }
  standard.squares = squares.value();
  return standard;
}

double sum_of_products(std::span<const double> x, const Standard& of_x, std::span<const double> y,
                       const Standard& of_y) {
  Sum products;
  for (std::size_t i = 0; i < x.size(); ++i) products.add(of_x.of(x[i]) * of_y.of(y[i]));
  return products.value();
}

double pearson(const Standard& x, const Standard& y, double products) {
  return std::clamp(products / std::sqrt(x.squares * y.squares), -1.0, 1.0);
}

double pearson(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  const auto standard_x = standard_of(x), standard_y = standard_of(y);
  if (!standard_x || !standard_y) return undefined;
  return pearson(*standard_x, *standard_y, sum_of_products(x, *standard_x, y, *standard_y));
}

} // namespace wingspread
