#include "montecarlo/confidence.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <ranges>

namespace wingspread {

namespace {

using Binomial = boost::math::binomial_distribution<double>;

/// Student's t that leaves (1 − confidence)/2 above it.
double student_quantile(int replicates, double confidence) {
  const boost::math::students_t student(replicates - 1);
  return boost::math::quantile(boost::math::complement(student, (1 - confidence) / 2));
}

/// A proportion over replicates of sizes n_r with hits h_r, F = Σh/Σn, kept up as hits come in.
/// Standard error of a ratio estimator: s² = R/(R − 1) · Σ(h_r − F n_r)² / (Σn)²
/// (W. G. Cochran, Sampling Techniques, 3rd ed. (1977), eq. 6.13 without the finite-population
/// factor). The sums are of whole numbers, hence exact.
class ReplicateShare {
public:
  explicit ReplicateShare(std::span<const long> sizes)
      : sizes_(sizes.begin(), sizes.end()), hits_(sizes.size(), 0.0),
        total_(std::reduce(sizes_.begin(), sizes_.end())),
        nn_(std::inner_product(sizes_.begin(), sizes_.end(), sizes_.begin(), 0.0)) {}

  void add(std::size_t replicate, double count) {
    double& h = hits_[replicate];
    hh_ += count * (2 * h + count);
    hn_ += count * sizes_[replicate];
    h += count;
    sum_ += count;
  }
  [[nodiscard]] double value() const { return sum_ / total_; }
  [[nodiscard]] double standard_error() const {
    const double replicates = static_cast<double>(sizes_.size());
    const double residual = hh_ - 2 * value() * hn_ + value() * value() * nn_;
    return std::sqrt(std::max(0.0, residual) * replicates / (replicates - 1)) / total_;
  }

private:
  std::vector<double> sizes_, hits_;
  double total_, nn_, sum_ = 0, hh_ = 0, hn_ = 0;
};

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
  const double t = student_quantile(replicates, confidence);
  ReplicateShare share(replicate_sizes(sorted, replicates));
  Bounds bounds;
  for (std::size_t i = 0; i < sorted.size() && !bounds.upper; ++i) {
    share.add(static_cast<std::size_t>(sorted[i].replicate), 1);
    if (i + 1 < sorted.size() && sorted[i + 1].value == sorted[i].value) continue;
    const double reach = t * share.standard_error();
    if (!bounds.lower && share.value() + reach >= p) bounds.lower = sorted[i].value;
    if (share.value() - reach >= p) bounds.upper = sorted[i].value;
  }
  return bounds;
}

Bounds replicate_proportion_bounds(std::span<const long> hits, std::span<const long> sizes,
                                   double confidence) {
  assert(hits.size() == sizes.size());
  if (sizes.size() < 2) return {};
  ReplicateShare share(sizes);
  for (std::size_t r = 0; r < hits.size(); ++r) share.add(r, static_cast<double>(hits[r]));
  const double error = share.standard_error();
  if (!(error > 0)) return {};
  const double reach = student_quantile(static_cast<int>(sizes.size()), confidence) * error;
  return {std::max(0.0, share.value() - reach), std::min(1.0, share.value() + reach)};
}

} // namespace wingspread
