#include "montecarlo/foundation/statistics/interim_analyses.hpp"

#include "distributions/math_policy.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"

#include <boost/math/distributions/binomial.hpp>

#include <algorithm>
#include <numeric>
#include <stdexcept>

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

/// P(Bin ≤ k) for all k.
class CumulativeFailures {
public:
  explicit CumulativeFailures(const Failures& failures) : first_(failures.first) {
    double sum = 0;
    for (const double probability : failures.probability) sums_.push_back(sum += probability);
  }
  [[nodiscard]] double up_to(long k) const {
    if (k < first_) return 0;
    return sums_[static_cast<std::size_t>(std::min(k - first_, std::ssize(sums_) - 1))];
  }
  /// The largest k with P(Bin ≤ k) ≤ risk; for none the last k whose probability is neglected, which may be −1.
  [[nodiscard]] long most_within(double risk) const {
    return first_ - 1 + (std::ranges::upper_bound(sums_, risk) - sums_.begin());
  }

private:
  long first_;
  std::vector<double> sums_;
};

/// What the analyses of one requirement have left.
struct AnalysesSoFar {
  double left = 0;     ///< R_k
  bool first = true;   ///< no analysis so far could pass
  bool passed = false; ///< one has
  long before = 0;     ///< analyses
  long runs = 0, failed = 0;
};

/// R_k by (3), after an analysis that failed.
/// @param added failures among the runs added @param allowed a_k @param failed F_k @param further m
double left_after(const AnalysesSoFar& before, const Failures& added, long allowed, long failed,
                  const Failures& further) {
  const CumulativeFailures later(further);
  const long from = std::max(added.first, allowed - before.failed + 1);
  const double rest = before.left - CumulativeFailures(added).up_to(from - 1);
  if (!(rest > 0)) return 0;
  const auto expected = [&](long b) { // E[P(F_k + Bin ≤ b)] over failed analyses
    double sum = 0;
    for (long x = from; x <= added.last(); ++x)
      sum += added.probability[static_cast<std::size_t>(x - added.first)] *
             later.up_to(b - before.failed - x);
    return sum;
  };
  long low = before.failed - 1, high = before.failed + added.last() + further.last() + 1;
  while (high - low > 1) {
    const long middle = std::midpoint(low, high);
    (expected(middle) <= rest ? low : high) = middle;
  }
  const double share = expected(low);
  return share > 0 ? std::min(1.0, rest / share * later.up_to(low - failed)) : rest;
}

/// a_k of the next analysis, by (2).
std::optional<long> allowed_next(const AnalysesSoFar& so_far, const Failures& added, long n,
                                 double p, double c) {
  const auto alone = allowed_failures(n, p, c);
  if (so_far.passed) {
    const auto with_bounds =
        allowed_failures(n, p, at_each_of(c, so_far.before * (so_far.before + 1)));
    return with_bounds || !alone ? with_bounds : 0; // the least that can pass
  }
  if (so_far.before == 0 || !alone) return alone;
  const long most =
      CumulativeFailures(added).most_within(so_far.first ? so_far.left : so_far.left / 2);
  const long allowed = std::min(so_far.failed + most, *alone);
  return allowed < 0 ? std::nullopt : std::optional(allowed);
}

/// @param runs n_k, ascending @param failed F_k of all but the last
PassingRule extended_rule(std::span<const long> runs, std::span<const long> failed, double p,
                          double c) {
  PassingRule rule{{}, c, PassingRule::Joint{}};
  const long least = runs_to_show(p, c, 0).value_or(0);
  AnalysesSoFar so_far{1 - c};
  long most = -1;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const long n = runs[k];
    const Failures added = binomial(n - so_far.runs, 1 - p);
    rule.allowed = allowed_next(so_far, added, n, p, c);
    most = std::max(most, allowed_failures(n, p, c).value_or(-1));
    if (k == failed.size()) break;
    const long allowed = rule.allowed.value_or(-1);
    if (failed[k] <= allowed)
      so_far.passed = true;
    else if (!so_far.passed)
      so_far.left = left_after(so_far, added, allowed, failed[k],
                               binomial(std::max(3 * n, 4 * least), 1 - p));
    so_far.first = so_far.first && allowed < so_far.failed;
    ++so_far.before, so_far.runs = n, so_far.failed = failed[k];
  }
  if (rule.allowed)
    rule.confidence = std::clamp(confidence_alone(runs.back(), p, *rule.allowed), c, most_sure);
  rule.joint->risk = 1 - c;
  rule.joint->risk_alone = risk_alone(runs, most, p, c);
  rule.joint->allowed_alone = allowed_failures(runs.back(), p, c);
  return rule;
}

} // namespace

double InterimAnalyses::confidence_of_bound(double confidence) const {
  const long k = count();
  return before.empty() ? at_each_of(confidence, planned) : at_each_of(confidence, k * (k - 1));
}

PassingRule passing_rule(const InterimAnalyses& interim, long n, double p, double c,
                         std::span<const long> failed) {
  std::vector<long> runs;
  for (const long earlier : interim.before)
    if (earlier < n) runs.push_back(earlier);
  if (!runs.empty()) {
    if (failed.size() < runs.size())
      throw std::logic_error("an extension without the failures at each analysis before");
    failed = failed.first(runs.size());
    runs.push_back(n);
    return extended_rule(runs, failed, p, c);
  }
  const double at_each = at_each_of(c, interim.planned);
  return {allowed_failures(n, p, at_each), at_each};
}

bool is_disproved(const InterimAnalyses& interim, long n, double p, double c, long k,
                  std::span<const long> failed) {
  std::vector<long> met;
  for (std::size_t i = 0; i < failed.size(); ++i) met.push_back(interim.before[i] - failed[i]);
  const auto allowed = passing_rule(interim, n, 1 - p, c, met).allowed;
  return k > 0 && allowed && n - k <= *allowed;
}

} // namespace wingspread
