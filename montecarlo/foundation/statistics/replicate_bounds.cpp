#include "montecarlo/foundation/statistics/replicate_bounds.hpp"

#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace wingspread {
namespace {

/// A proportion over replicates, and its standard error.
struct Share {
  double value, error;
};

/// F = Σh/Σn of replicates with sizes n_r and hits h_r, with the error of a ratio estimator:
/// s² = R/(R − 1) · Σ(h_r − F n_r)² / (Σn)² (W. G. Cochran, Sampling Techniques, 3rd ed. (1977),
/// eq. 6.13 without the finite-population factor). The differences times Σn are whole numbers,
/// so the error is exactly 0 if all replicates agree.
Share share_of(std::span<const long> hits, std::span<const long> sizes) {
  const auto hit = static_cast<double>(std::reduce(hits.begin(), hits.end()));
  const auto all = static_cast<double>(std::reduce(sizes.begin(), sizes.end()));
  double squares = 0;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    const double difference =
        static_cast<double>(hits[r]) * all - hit * static_cast<double>(sizes[r]);
    squares += difference * difference;
  }
  const auto replicates = static_cast<double>(sizes.size());
  return {hit / all, std::sqrt(squares * replicates / (replicates - 1)) / (all * all)};
}

std::vector<long> replicate_sizes(std::span<const ReplicateValue> values, int replicates) {
  std::vector<long> sizes(static_cast<std::size_t>(replicates), 0);
  for (const ReplicateValue& each : values) ++sizes[static_cast<std::size_t>(each.replicate)];
  return sizes;
}

} // namespace

Bounds replicate_quantile_bounds(std::span<const ReplicateValue> sorted, int replicates, double p,
                                 double confidence, const MissingOfReplicates& missing) {
  if (replicates < 2 || sorted.empty()) return {};
  if (missing.end == MissingRank::either) {
    const auto bounds = [&](MissingRank end) {
      return replicate_quantile_bounds(sorted, replicates, p, confidence, {missing.counts, end});
    };
    return {bounds(MissingRank::below).lower, bounds(MissingRank::above).upper};
  }
  const bool below = missing.end == MissingRank::below;
  const PartialRanks ranks{std::ssize(sorted),
                           std::reduce(missing.counts.begin(), missing.counts.end()), missing.end};
  const long n = ranks.all();
  const auto sizes_of = [&](auto end, bool with_missing) {
    std::vector<long> sizes = replicate_sizes({sorted.begin(), end}, replicates);
    for (std::size_t r = 0; with_missing && r < missing.counts.size(); ++r)
      sizes[r] += missing.counts[r];
    return sizes;
  };
  const std::vector<long> sizes = sizes_of(sorted.end(), true);
  const auto error_below = [&](auto end) { return share_of(sizes_of(end, below), sizes).error; };
  const auto place = ranks.among_present(quantile_rank(n, p));
  const auto edge = below ? sorted.begin() : sorted.end(); // next to the missing values
  const auto tied =
      place ? std::ranges::equal_range(sorted, sorted[static_cast<std::size_t>(*place - 1)].value,
                                       {}, &ReplicateValue::value)
            : std::ranges::subrange(edge, edge);
  const double error = std::max(error_below(tied.begin()), error_below(tied.end()));
  if (!(error > 0)) return {};
  const double reach = two_sided_student(replicates - 1, confidence) * error;
  const auto at_share = [&](double share) -> std::optional<double> {
    const double rank = std::ceil(static_cast<double>(n) * share);
    if (rank < 1 || rank > static_cast<double>(n)) return std::nullopt;
    const auto found = ranks.among_present(static_cast<long>(rank));
    return found ? std::optional(sorted[static_cast<std::size_t>(*found - 1)].value) : std::nullopt;
  };
  return {at_share(p - reach), at_share(p + reach)};
}

double replicate_mean_error(std::span<const ReplicateValue> values, int replicates, double mean) {
  if (replicates < 2 || values.empty()) return undefined;
  std::vector<double> deviations(static_cast<std::size_t>(replicates), 0.0);
  for (const auto& [value, replicate] : values)
    deviations[static_cast<std::size_t>(replicate)] += value - mean;
  const double squares =
      std::inner_product(deviations.begin(), deviations.end(), deviations.begin(), 0.0);
  return std::sqrt(squares * replicates / (replicates - 1.0)) / static_cast<double>(values.size());
}

Bounds replicate_proportion_bounds(std::span<const long> hits, std::span<const long> sizes,
                                   double confidence) {
  assert(hits.size() == sizes.size());
  if (sizes.size() < 2) return {};
  const auto [share, error] = share_of(hits, sizes);
  if (!(error > 0)) return {};
  const long n = std::reduce(sizes.begin(), sizes.end());
  const double t_ratio =
      two_sided_student(n - 1, confidence) / two_sided_student(std::ssize(sizes) - 1, confidence);
  const double effective = share * (1 - share) / (error * error) * t_ratio * t_ratio;
  const Interval interval = clopper_pearson_of_share(share, effective, confidence);
  return {interval.lower, interval.upper};
}

} // namespace wingspread
