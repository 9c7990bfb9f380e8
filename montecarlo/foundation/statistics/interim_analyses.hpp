/// Interim analyses: verdicts and bounds from draws that were analysed before with fewer runs.
///
///   symbol     meaning
///   n_k, F_k   runs at analysis k of m, failures among them; the runs of an analysis include those of the ones before
///   p, c, α    probability to be shown, confidence, α = 1 − c
///   a_k        most failures with which analysis k passes
///   ρ_k        risk of a wrong pass at analysis k and at none before, for the worst case P = p
///
///   ρ_k = P(F_1 > a_1, …, F_{k−1} > a_{k−1}, F_k ≤ a_k)                                       (1)
///
/// Planned analyses (those of `until`) share α equally (bonferroni.hpp). An extension is not planned: whoever
/// adds runs after "fail" has the chance of another pass. The first analysis that can pass at all has spent up to α by
/// itself, because it was a fixed number of runs. Each later one spends at most half of what is left of α:
///
///   ρ_k ≤ (α − ρ_1 − … − ρ_{k−1})/2                                                           (2)
///
/// So Σ ρ_k ≤ α for any number of extensions, and another one is always possible. (1) is exact: the distribution of F_k
/// on the paths that have not passed follows from that of F_{k−1} by adding Bin(n_k − n_{k−1}, 1 − p). A path with
/// fewer failures passes no later, so P = p is the worst case of P ≤ p. Half is a choice: any share below 1 keeps Σ ρ_k
/// ≤ α.
///
/// Bounds of extension k (k ≥ 2) use the risk α/(k(k − 1)), in sum α: those of all extensions hold together at c.
/// Source: C. Jennison, B. W. Turnbull, Group Sequential Methods (2000), chapters 7 (spending) and 12 (binomial).
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// How often the draws are analysed. Either `planned` > 1 or `before` is not empty, not both.
struct InterimAnalyses {
  long planned = 1;           ///< interim analyses, at any of which the campaign may stop
  std::vector<long> before{}; ///< numbers of runs of the analyses before extensions, ascending

  [[nodiscard]] long count() const { return planned + std::ssize(before); }
  /// The confidence of a bound at this analysis, so that bounds hold together at `confidence`.
  [[nodiscard]] double confidence_of_bound(double confidence) const;
  friend bool operator==(const InterimAnalyses&, const InterimAnalyses&) = default;
};

/// When a requirement P ≥ p passes at an analysis.
struct PassingRule {
  std::optional<long> allowed; ///< a_m; nothing if no number of failures is small enough
  double confidence = 0;       ///< at which a single analysis allows as many

  /// An extension's risk of a wrong pass at any analysis so far.
  struct Joint {
    double risk = 0;                   ///< Σ ρ_k ≤ α
    double risk_alone = 0;             ///< the same if each analysis were judged by itself at c
    std::optional<long> allowed_alone; ///< most failures, if this were the only analysis
  };
  std::optional<Joint> joint{}; ///< present after an extension
};

/// The rule at the analysis of n runs.
/// Cost after an extension: O(m n p (1 − p)) operations, 0.1 s for 10⁶ runs and p = 0.95.
/// @pre n ≥ 0, 0 < p < 1, 0 < c < 1
[[nodiscard]] PassingRule passing_rule(const InterimAnalyses& interim, long n, double p, double c);

/// Whether k failures in n runs show P < p at confidence c: the rule for the probability 1 − p of a failure.
/// @pre 0 ≤ k ≤ n
[[nodiscard]] bool is_disproved(const InterimAnalyses& interim, long n, double p, double c, long k);

} // namespace wingspread
