#include "montecarlo/statistics/confidence.hpp"

#include "montecarlo/statistics/statistics.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <ranges>

namespace wingspread {

namespace {

using Binomial = boost::math::binomial_distribution<double>;

/// Student's t that leaves (1 − confidence)/2 above it.
double student_quantile(long degrees, double confidence) {
  const boost::math::students_t student(static_cast<double>(degrees));
  return boost::math::quantile(boost::math::complement(student, (1 - confidence) / 2));
}

/// A proportion over replicates, and its standard error.
struct Share {
  double value, error;
};

/// Of replicates of sizes n_r with hits h_r, F = Σh/Σn. As of a ratio estimator:
/// s² = R/(R − 1) · Σ(h_r − F n_r)² / (Σn)² (W. G. Cochran, Sampling Techniques, 3rd ed. (1977),
/// eq. 6.13 without the finite-population factor). The differences, times Σn, are of whole numbers:
/// where the replicates agree the error is exactly 0.
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

double clopper_pearson_lower(long hits, long n, double confidence) {
  assert(0 <= hits && hits <= n);
  if (hits == 0) return 0;
  return Binomial::find_lower_bound_on_p(static_cast<double>(n), static_cast<double>(hits),
                                         1 - confidence);
}

double clopper_pearson_upper(long hits, long n, double confidence) {
  assert(0 <= hits && hits <= n);
  if (hits == n) return 1;
  return Binomial::find_upper_bound_on_p(static_cast<double>(n), static_cast<double>(hits),
                                         1 - confidence);
}

Interval clopper_pearson(long hits, long n, double confidence) {
  const double one_sided = (1 + confidence) / 2;
  return {clopper_pearson_lower(hits, n, one_sided), clopper_pearson_upper(hits, n, one_sided)};
}

Interval clopper_pearson_of_share(double share, double n, double confidence) {
  const double hits = share * n, tail = (1 - confidence) / 2;
  return {hits > 0 ? boost::math::ibeta_inv(hits, n - hits + 1, tail) : 0,
          hits < n ? boost::math::ibetac_inv(hits + 1, n - hits, tail) : 1};
}

RankBounds quantile_rank_bounds(long n, double p, double confidence) {
  assert(n >= 0 && p > 0 && p < 1 && confidence > 0 && confidence < 1);
  const Binomial below(static_cast<double>(n), p);
  const double tail = (1 - confidence) / 2;
  const auto fewer = [&](long l) { return cdf(below, static_cast<double>(l - 1)); };
  const auto at_least = [&](long u) {
    return cdf(boost::math::complement(below, static_cast<double>(u - 1)));
  };
  const auto ranks = std::views::iota(1L, n + 1);
  const auto first_not_lower =
      std::ranges::partition_point(ranks, [&](long l) { return fewer(l) <= tail; });
  const auto first_upper =
      std::ranges::partition_point(ranks, [&](long u) { return at_least(u) > tail; });
  RankBounds bounds;
  if (first_not_lower != ranks.begin()) bounds.lower = first_not_lower - ranks.begin();
  if (first_upper != ranks.end()) bounds.upper = *first_upper;
  return bounds;
}

Bounds quantile_bounds(std::span<const double> sorted, double p, double confidence) {
  const RankBounds ranks = quantile_rank_bounds(static_cast<long>(sorted.size()), p, confidence);
  Bounds bounds;
  if (ranks.lower) bounds.lower = sorted[static_cast<std::size_t>(*ranks.lower - 1)];
  if (ranks.upper) bounds.upper = sorted[static_cast<std::size_t>(*ranks.upper - 1)];
  return bounds;
}

Bounds replicate_quantile_bounds(std::span<const ReplicateValue> sorted, int replicates, double p,
                                 double confidence) {
  if (replicates < 2 || sorted.empty()) return {};
  const long n = std::ssize(sorted);
  const double value = sorted[static_cast<std::size_t>(quantile_rank(n, p) - 1)].value;
  const auto tied = std::ranges::equal_range(sorted, value, {}, &ReplicateValue::value);
  const std::vector<long> sizes = replicate_sizes(sorted, replicates);
  const auto error_below = [&](auto end) {
    return share_of(replicate_sizes({sorted.begin(), end}, replicates), sizes).error;
  };
  const double error = std::max(error_below(tied.begin()), error_below(tied.end()));
  if (!(error > 0)) return {};
  const double reach = student_quantile(replicates - 1, confidence) * error;
  const auto at_share = [&](double share) -> std::optional<double> {
    const double rank = std::ceil(static_cast<double>(n) * share);
    if (rank < 1 || rank > static_cast<double>(n)) return std::nullopt;
    return sorted[static_cast<std::size_t>(rank) - 1].value;
  };
  return {at_share(p - reach), at_share(p + reach)};
}

double replicate_mean_error(std::span<const ReplicateValue> values, int replicates, double mean) {
  if (replicates < 2 || values.empty()) return std::numeric_limits<double>::quiet_NaN();
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
      student_quantile(n - 1, confidence) / student_quantile(std::ssize(sizes) - 1, confidence);
  const double effective = share * (1 - share) / (error * error) * t_ratio * t_ratio;
  const Interval interval = clopper_pearson_of_share(share, effective, confidence);
  return {interval.lower, interval.upper};
}

} // namespace wingspread
