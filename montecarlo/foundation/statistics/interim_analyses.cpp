#include "montecarlo/foundation/statistics/interim_analyses.hpp"

#include "distributions/math_policy.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"

#include <boost/math/distributions/binomial.hpp>

#include <algorithm>

namespace wingspread {
namespace {

/// Probabilities of first, first + 1, … failures.
struct Failures {
  long first = 0;
  std::vector<double> probability{};

  [[nodiscard]] long last() const { return first + std::ssize(probability) - 1; }
};

/// Bin(n, q), without numbers of failures whose probability is below 1e-22: even 10⁹ of them do not change a risk in
/// its tenth digit. From the mode outwards by the ratio of neighbours.
Failures binomial(long n, double q) {
  constexpr double negligible = 1e-22;
  using Binomial = boost::math::binomial_distribution<double, MathPolicy>;
  const long mode = std::min(n, static_cast<long>(static_cast<double>(n + 1) * q));
  const double peak = pdf(Binomial(static_cast<double>(n), q), static_cast<double>(mode));
  const auto up = [&](long j) { // P(j + 1)/P(j)
    return static_cast<double>(n - j) / static_cast<double>(j + 1) * (q / (1 - q));
  };
  std::vector<double> below, above{peak};
  double probability = peak;
  for (long j = mode; j > 0 && (probability /= up(j - 1)) > negligible; --j)
    below.push_back(probability);
  probability = peak;
  for (long j = mode; j < n && (probability *= up(j)) > negligible; ++j)
    above.push_back(probability);
  Failures found{mode - std::ssize(below), {below.rbegin(), below.rend()}};
  found.probability.insert(found.probability.end(), above.begin(), above.end());
  return found;
}

/// The sum of two independent numbers of failures, up to `most`.
Failures sum_of(const Failures& a, const Failures& b, long most) {
  Failures sum{a.first + b.first, {}};
  const long size = std::min(a.last() + b.last(), most) - sum.first + 1;
  if (a.probability.empty() || b.probability.empty() || size <= 0) return {most + 1, {}};
  sum.probability.assign(static_cast<std::size_t>(size), 0.0);
  for (long i = 0; i < std::min(std::ssize(a.probability), size); ++i) {
    const double weight = a.probability[static_cast<std::size_t>(i)];
    const long count = std::min(std::ssize(b.probability), size - i);
    double* to = sum.probability.data() + i;
    for (long j = 0; j < count; ++j) to[j] += weight * b.probability[static_cast<std::size_t>(j)];
  }
  return sum;
}

/// The paths of F_1, F_2, … that have not passed.
class OpenPaths {
public:
  /// @param most the largest a_k: paths with more failures pass no more
  OpenPaths(double q, long most) : q_(q), most_(most), paths_{0, {1.0}} {}

  void go_on_to(long runs) {
    paths_ = sum_of(paths_, binomial(runs - runs_, q_), most_);
    runs_ = runs;
  }
  /// The largest a with P(open, F ≤ a) ≤ budget, −1 for none.
  [[nodiscard]] long most_within(double budget) const {
    double risk = 0;
    long allowed = std::min(paths_.first - 1, most_);
    for (const double probability : paths_.probability) {
      risk += probability;
      if (risk > budget) break;
      ++allowed;
    }
    return allowed;
  }
  /// Ends the paths with at most `allowed` failures. @return their probability
  double pass(long allowed) {
    const long passing =
        std::clamp(allowed - paths_.first + 1, 0L, static_cast<long>(paths_.probability.size()));
    double risk = 0;
    for (long i = 0; i < passing; ++i) risk += paths_.probability[static_cast<std::size_t>(i)];
    paths_.probability.erase(paths_.probability.begin(), paths_.probability.begin() + passing);
    paths_.first += passing;
    return risk;
  }

private:
  double q_;
  long most_, runs_ = 0;
  Failures paths_;
};

double risk_alone(std::span<const long> runs, long most, double p, double c) {
  OpenPaths paths(1 - p, most);
  double risk = 0;
  for (const long n : runs) {
    paths.go_on_to(n);
    if (const auto allowed = allowed_failures(n, p, c)) risk += paths.pass(*allowed);
  }
  return risk;
}

/// The confidence at which a single analysis of n runs allows k failures.
double confidence_alone(long n, double p, long k) {
  using Binomial = boost::math::binomial_distribution<double, MathPolicy>;
  return k >= n ? 0
                : cdf(complement(Binomial(static_cast<double>(n), 1 - p), static_cast<double>(k)));
}

/// A confidence below 1: with 1 no bound of a share would exist.
constexpr double most_sure = 1 - 1e-15;

/// (1) and (2). @param runs n_k, ascending
PassingRule extended_rule(std::span<const long> runs, double p, double c) {
  long most = -1;
  for (const long n : runs) most = std::max(most, allowed_failures(n, p, c).value_or(-1));
  const double alpha = 1 - c;
  PassingRule rule{{}, c, PassingRule::Joint{}};
  double& risk = rule.joint->risk;
  OpenPaths paths(1 - p, most);
  bool first = true; // no analysis so far could pass
  for (const long n : runs) {
    paths.go_on_to(n);
    rule.allowed = allowed_failures(n, p, c);
    if (!first) rule.allowed = paths.most_within((alpha - risk) / 2);
    if (!rule.allowed) continue;
    risk += paths.pass(*rule.allowed);
    first = false;
  }
  if (rule.allowed)
    rule.confidence = std::clamp(confidence_alone(runs.back(), p, *rule.allowed), c, most_sure);
  rule.joint->risk_alone = risk_alone(runs, most, p, c);
  rule.joint->allowed_alone = allowed_failures(runs.back(), p, c);
  return rule;
}

} // namespace

double InterimAnalyses::confidence_of_bound(double confidence) const {
  const long k = count();
  return before.empty() ? at_each_of(confidence, planned) : at_each_of(confidence, k * (k - 1));
}

PassingRule passing_rule(const InterimAnalyses& interim, long n, double p, double c) {
  std::vector<long> runs;
  for (const long earlier : interim.before)
    if (earlier < n) runs.push_back(earlier);
  if (!runs.empty()) {
    runs.push_back(n);
    return extended_rule(runs, p, c);
  }
  const double at_each = at_each_of(c, interim.planned);
  return {allowed_failures(n, p, at_each), at_each};
}

bool is_disproved(const InterimAnalyses& interim, long n, double p, double c, long k) {
  const auto allowed = passing_rule(interim, n, 1 - p, c).allowed;
  return k > 0 && allowed && n - k <= *allowed;
}

} // namespace wingspread
