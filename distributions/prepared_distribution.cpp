#include "distributions/prepared_distribution.hpp"

#include <cassert>

namespace wingspread {
namespace {

std::variant<TruncatedLaw, StepLaw> prepared(const Distribution& distribution) {
  assert(faults(distribution).empty());
  return std::visit(
      [&]<class L>(const L& law) -> std::variant<TruncatedLaw, StepLaw> {
        if constexpr (Continuous<L>)
          return truncated(law, distribution.truncate.value_or(Truncation{}));
        else
          return step_law(law);
      },
      distribution.law);
}

} // namespace

PreparedDistribution::PreparedDistribution(const Distribution& distribution)
    : law_(prepared(distribution)) {}

double PreparedDistribution::quantile(double u) const {
  assert(0 <= u && u <= 1);
  return std::visit([u](const auto& law) { return wingspread::quantile(law, u); }, law_);
}

double PreparedDistribution::quantile_complement(double q) const {
  assert(0 <= q && q <= 1);
  return std::visit([q](const auto& law) { return wingspread::quantile_complement(law, q); }, law_);
}

double PreparedDistribution::quantile(Tails at) const {
  return at.below <= at.above ? quantile(at.below) : quantile_complement(at.above);
}

double PreparedDistribution::cdf(double x) const {
  return std::visit([x](const auto& law) { return wingspread::cdf(law, x); }, law_);
}

double PreparedDistribution::cdf_complement(double x) const {
  return std::visit([x](const auto& law) { return wingspread::cdf_complement(law, x); }, law_);
}

} // namespace wingspread
