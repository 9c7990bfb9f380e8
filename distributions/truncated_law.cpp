#include "distributions/truncated_law.hpp"

#include <algorithm>

namespace wingspread {
namespace {

/// The probability between two points of a law, from the tails that are small at both.
double between(Tails a, Tails b) {
  if (b.below <= 0.5) return b.below - a.below;
  if (a.above <= 0.5) return a.above - b.above;
  return (0.5 - a.below) + (0.5 - b.above);
}

double inverse(const TruncatedLaw& law, Tails at) {
  if (at.below <= 0) return law.bounds.lower;
  if (at.above <= 0) return law.bounds.upper;
  const Tails of_law{law.lower.below + law.mass * at.below,  // (1)
                     law.upper.above + law.mass * at.above}; // (2)
  return std::clamp(inverse(law.law, of_law), law.bounds.lower, law.bounds.upper);
}

} // namespace

TruncatedLaw truncated(const ContinuousLaw& law, Truncation truncation) {
  const Support whole = support(law);
  const Support bounds{std::max(whole.lower, truncation.lower),
                       std::min(whole.upper, truncation.upper)};
  const Tails lower = tails(law, bounds.lower);
  const Tails upper = tails(law, bounds.upper);
  return {law, bounds, lower, upper, between(lower, upper)};
}

double quantile(const TruncatedLaw& law, double u) { return inverse(law, {u, 1 - u}); }

double quantile_complement(const TruncatedLaw& law, double q) { return inverse(law, {1 - q, q}); }

double cdf(const TruncatedLaw& law, double x) {
  const Support within = law.bounds;
  return between(law.lower, tails(law.law, std::clamp(x, within.lower, within.upper))) / law.mass;
}

double cdf_complement(const TruncatedLaw& law, double x) {
  const Support within = law.bounds;
  return between(tails(law.law, std::clamp(x, within.lower, within.upper)), law.upper) / law.mass;
}

} // namespace wingspread
