#include "montecarlo/report/data/distribution_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// Half the width of the band for n values.
double band_width(double n, double confidence) {
  return std::sqrt(std::log(2 / (1 - confidence)) / (2 * n));
}

/// The numbers of values ≤ x of each replicate, for ascending x.
class ReplicateCounts {
public:
  ReplicateCounts(std::span<const ReplicateValue> sorted, int replicates)
      : sorted_(sorted), hits_(static_cast<std::size_t>(replicates), 0), sizes_(hits_) {
    for (const ReplicateValue& value : sorted) ++sizes_[static_cast<std::size_t>(value.replicate)];
  }

  [[nodiscard]] Bounds bounds_at(double x, double confidence) {
    for (; next_ < sorted_.size() && sorted_[next_].value <= x; ++next_)
      ++hits_[static_cast<std::size_t>(sorted_[next_].replicate)];
    return replicate_proportion_bounds(hits_, sizes_, confidence);
  }

private:
  std::span<const ReplicateValue> sorted_;
  std::vector<long> hits_, sizes_;
  std::size_t next_ = 0;
};

/// The distinct values, smallest first, or as many of them as asked for.
std::vector<double> first_distinct(std::span<const double> sorted, std::size_t most) {
  std::vector<double> distinct;
  for (auto next = sorted.begin(); next != sorted.end() && distinct.size() < most;
       next = std::upper_bound(next, sorted.end(), distinct.back()))
    distinct.push_back(*next);
  return distinct;
}

/// The distinct values at curve_ranks.
std::vector<double> values_at_ranks(std::span<const double> sorted, std::size_t most) {
  std::vector<double> values;
  for (const long rank : curve_ranks(std::ssize(sorted), most))
    values.push_back(sorted[static_cast<std::size_t>(rank - 1)]);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

} // namespace

std::vector<long> curve_ranks(long n, std::size_t most) {
  const auto quarter = static_cast<long>(most) / 4, half = static_cast<long>(most) - 2 * quarter;
  std::vector<long> ranks;
  for (long i = 0; i < half; ++i)
    ranks.push_back(1 + std::lround(static_cast<double>(n - 1) * static_cast<double>(i) /
                                    static_cast<double>(half - 1)));
  const double first = std::max(1.0, static_cast<double>(n) / static_cast<double>(half));
  for (long i = 0; i < quarter; ++i) {
    const auto from_end = static_cast<long>(
        std::pow(first, static_cast<double>(i + 1) / static_cast<double>(quarter)));
    ranks.push_back(from_end);
    ranks.push_back(n + 1 - from_end);
  }
  std::ranges::sort(ranks);
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  return ranks;
}

DistributionCurve distribution_curve(std::span<const double> sorted,
                                     std::span<const ReplicateValue> replicated, int replicates,
                                     double confidence, std::size_t most) {
  DistributionCurve curve;
  std::vector<double> places = first_distinct(sorted, most + 1);
  curve.steps = places.size() <= most;
  if (!curve.steps) places = values_at_ranks(sorted, most);
  const auto n = static_cast<double>(sorted.size());
  const double width = band_width(n, confidence);
  ReplicateCounts counts(replicated, replicates);
  for (const double x : places) {
    const auto below = std::ranges::upper_bound(sorted, x) - sorted.begin();
    const double p = static_cast<double>(below) / n;
    curve.knots.push_back({x, p,
                           replicates > 0
                               ? counts.bounds_at(x, confidence)
                               : Bounds{std::max(0.0, p - width), std::min(1.0, p + width)}});
  }
  return curve;
}

DistributionCurve distribution_curve(const RankedPopulation& values, double confidence,
                                     std::size_t most) {
  if (values.count() <= 2 * static_cast<long>(kept_extremes)) { // each of them is known
    std::vector<double> sorted;
    for (long rank = 1; rank <= values.count(); ++rank) sorted.push_back(values.at(rank).value);
    return distribution_curve(sorted, {}, 0, confidence, most);
  }
  DistributionCurve curve{{}, false};
  const auto n = static_cast<double>(values.count());
  const double width = band_width(n, confidence);
  for (const long rank : curve_ranks(values.count(), most)) {
    const double x = values.at(rank).value, p = static_cast<double>(rank) / n;
    if (!curve.knots.empty() && curve.knots.back().x == x)
      curve.knots.pop_back(); // the last of equal values counts
    curve.knots.push_back({x, p, {std::max(0.0, p - width), std::min(1.0, p + width)}});
  }
  return curve;
}

std::string band_name(int replicates, double confidence) {
  if (replicates == 0) return fmt::format("Dvoretzky-Kiefer-Wolfowitz, {:g} %", 100 * confidence);
  if (replicates == 1) return "none: the draws of one replicate depend on each other";
  return fmt::format("Korn-Graubard over {} replicates, {:g} % at each value by itself", replicates,
                     100 * confidence);
}

} // namespace wingspread
