#include "montecarlo/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace wingspread {

namespace {

/// The mean as shift + rest: the shift takes away what all values have in common, exactly where it
/// is large, so that deviations do not cancel.
struct ShiftedMean {
  double shift, rest;
  [[nodiscard]] double deviation(double value) const { return (value - shift) - rest; }
};

ShiftedMean shifted_mean(std::span<const double> values) {
  Sum sum;
  for (const double value : values) sum.add(value - values.front());
  return {values.front(), sum.value() / static_cast<double>(values.size())};
}

/// Largest |deviation|: sums of its powers neither overflow nor vanish once it is divided out.
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
  if (n > 2) result.skewness = m3 / (m2 * std::sqrt(m2)) * std::sqrt(n * (n - 1)) / (n - 2);
  if (n > 3) result.kurtosis = (n - 1) / ((n - 2) * (n - 3)) * ((n + 1) * (m4 / (m2 * m2) - 3) + 6);
}

/// Mid-ranks, at their own places, of the values that `order` lists, smallest first.
std::vector<double> mid_ranks(std::span<const double> values,
                              std::span<const std::uint32_t> order) {
  std::vector<double> ranks(values.size(), undefined);
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    // The tied values take up the ranks first + 1 … end, and share their mean.
    const double rank = static_cast<double>(first + 1 + end) / 2;
    for (const std::uint32_t tied : order.subspan(first, end - first)) ranks[tied] = rank;
    first = end;
  }
  return ranks;
}

std::vector<double> kept(std::span<const double> values, const std::vector<bool>& keep) {
  std::vector<double> result;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (keep[i]) result.push_back(values[i]);
  return result;
}

bool constant(std::span<const double> values) {
  return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
}

} // namespace

void Sum::add(double term) {
  const double next = sum_ + term;
  lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
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

std::vector<double> sorted_present(std::span<const double> values) {
  std::vector<double> present;
  std::ranges::copy_if(values, std::back_inserter(present),
                       [](double v) { return !std::isnan(v); });
  std::ranges::sort(present);
  return present;
}

long quantile_rank(long n, double p) {
  assert(n > 0 && p >= 0 && p <= 1);
  const double product = static_cast<double>(n) * p;
  // p and the product each carry half a unit in the last place.
  const double slack = 2 * std::numeric_limits<double>::epsilon() * product;
  return std::clamp(std::lround(std::ceil(product - slack)), 1L, n);
}

double quantile(std::span<const double> sorted, double p) {
  if (sorted.empty()) return undefined;
  return sorted[static_cast<std::size_t>(quantile_rank(static_cast<long>(sorted.size()), p) - 1)];
}

double pearson(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  if (x.size() < 2 || constant(x) || constant(y)) return undefined;
  const ShiftedMean mean_x = shifted_mean(x), mean_y = shifted_mean(y);
  const double scale_x = largest_deviation(x, mean_x), scale_y = largest_deviation(y, mean_y);
  Sum xx, yy, xy;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = mean_x.deviation(x[i]) / scale_x, dy = mean_y.deviation(y[i]) / scale_y;
    xx.add(dx * dx);
    yy.add(dy * dy);
    xy.add(dx * dy);
  }
  return std::clamp(xy.value() / std::sqrt(xx.value() * yy.value()), -1.0, 1.0);
}

RankedColumn::RankedColumn(std::span<const double> values) : values_(values) {
  assert(values.size() <= std::numeric_limits<std::uint32_t>::max());
  for (std::uint32_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i])) order_.push_back(i);
  std::ranges::stable_sort(order_, {}, [&](std::uint32_t i) { return values[i]; });
  if (complete()) ranks_ = mid_ranks(values_, order_);
}

std::vector<double> RankedColumn::ranks_where(const std::vector<bool>& keep) const {
  std::vector<std::uint32_t> order;
  std::ranges::copy_if(order_, std::back_inserter(order), [&](std::uint32_t i) { return keep[i]; });
  return kept(mid_ranks(values_, order), keep);
}

Correlation correlation(const RankedColumn& x, const RankedColumn& y) {
  assert(x.values().size() == y.values().size());
  const std::size_t n = x.values().size();
  if (x.complete() && y.complete())
    return {static_cast<long>(n), pearson(x.values(), y.values()), pearson(x.ranks(), y.ranks())};
  std::vector<bool> both(n);
  for (std::size_t i = 0; i < n; ++i)
    both[i] = !std::isnan(x.values()[i]) && !std::isnan(y.values()[i]);
  return {static_cast<long>(std::ranges::count(both, true)),
          pearson(kept(x.values(), both), kept(y.values(), both)),
          pearson(x.ranks_where(both), y.ranks_where(both))};
}

} // namespace wingspread
