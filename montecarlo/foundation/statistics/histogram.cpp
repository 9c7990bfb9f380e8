#include "montecarlo/foundation/statistics/histogram.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wingspread {

namespace {

struct Extent {
  double lower, upper;
};

Extent range_of(std::span<const double> sorted) {
  const double lower = sorted.front(), upper = sorted.back();
  if (lower < upper) return {lower, upper};
  const double half = lower == 0 ? 0.5 : std::abs(lower) / 2;
  return {lower - half, lower + half};
}

/// The number of bins that leaves at least four roundings between neighbouring edges.
int with_room(int bins, const Extent& range) {
  const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
  const double room =
      (range.upper - range.lower) / (4 * std::numeric_limits<double>::epsilon() * largest);
  return static_cast<int>(std::clamp(std::floor(room), 1.0, static_cast<double>(bins)));
}

std::vector<double> edges_of(const Extent& range, int bins) {
  std::vector<double> edges;
  for (int i = 0; i <= bins; ++i)
    edges.push_back(std::lerp(range.lower, range.upper, static_cast<double>(i) / bins));
  return edges;
}

} // namespace

long Histogram::total() const { return std::reduce(counts.begin(), counts.end()); }

double Histogram::density(std::size_t bin) const {
  return static_cast<double>(counts[bin]) / static_cast<double>(total()) /
         (edges[bin + 1] - edges[bin]);
}

int count_bins(const Bins& bins, long n, double spread, double iqr) {
  if (const int* fixed = std::get_if<int>(&bins)) return *fixed;
  if (spread == 0) return 1;
  const auto count = static_cast<double>(n);
  const double wanted =
      iqr > 0 ? std::ceil(spread / (2 * iqr) * std::cbrt(count)) : std::ceil(std::log2(count)) + 1;
  return static_cast<int>(std::clamp(wanted, 1.0, double{most_auto_bins}));
}

Histogram histogram(std::span<const double> sorted, const Bins& bins) {
  if (sorted.empty()) return {};
  const Extent range = range_of(sorted);
  const int wanted = count_bins(bins, std::ssize(sorted), sorted.back() - sorted.front(),
                                quantile(sorted, 0.75) - quantile(sorted, 0.25));
  Histogram result{edges_of(range, with_room(wanted, range)), {}};
  auto from = sorted.begin();
  for (std::size_t i = 1; i < result.edges.size(); ++i) {
    const bool last = i + 1 == result.edges.size();
    const auto to = last ? sorted.end() : std::lower_bound(from, sorted.end(), result.edges[i]);
    result.counts.push_back(to - from);
    from = to;
  }
  return result;
}

} // namespace wingspread
