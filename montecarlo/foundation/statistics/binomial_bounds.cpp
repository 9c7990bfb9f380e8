#include "montecarlo/foundation/statistics/binomial_bounds.hpp"

#include "distributions/math_policy.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/beta.hpp>

#include <cassert>
#include <ranges>

namespace wingspread {
namespace {

using Binomial = boost::math::binomial_distribution<double, MathPolicy>;

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
  return {hits > 0 ? boost::math::ibeta_inv(hits, n - hits + 1, tail, MathPolicy()) : 0,
          hits < n ? boost::math::ibetac_inv(hits + 1, n - hits, tail, MathPolicy()) : 1};
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

RankBounds quantile_rank_bounds(const PartialRanks& ranks, double p, double confidence) {
  const RankBounds all = quantile_rank_bounds(ranks.all(), p, confidence);
  const auto among_present = [&](std::optional<long> rank, MissingRank end) {
    if (ranks.end != MissingRank::either) end = ranks.end;
    return rank ? PartialRanks{ranks.present, ranks.missing, end}.among_present(*rank)
                : std::nullopt;
  };
  return {among_present(all.lower, MissingRank::below),
          among_present(all.upper, MissingRank::above)};
}

Bounds quantile_bounds(std::span<const double> sorted, const PartialRanks& ranks, double p,
                       double confidence) {
  const RankBounds found = quantile_rank_bounds(ranks, p, confidence);
  Bounds bounds;
  if (found.lower) bounds.lower = sorted[static_cast<std::size_t>(*found.lower - 1)];
  if (found.upper) bounds.upper = sorted[static_cast<std::size_t>(*found.upper - 1)];
  return bounds;
}

Bounds quantile_bounds(std::span<const double> sorted, double p, double confidence) {
  return quantile_bounds(sorted, {std::ssize(sorted)}, p, confidence);
}

} // namespace wingspread
