/// Interim analyses: verdicts and bounds from draws that were analysed before with fewer runs.
///
///   symbol     meaning
///   n_k, F_k   runs at analysis k, failures among them; the runs of an analysis include those of the ones before
///   p, c, α    probability to be shown, confidence, α = 1 − c
///   a_k        most failures with which analysis k passes
///   R_k        risk that is left to the analyses after k; R_0 = α
///
/// Planned analyses (those of `until`) share α equally (bonferroni.hpp). An extension is not planned: whoever adds runs
/// after "fail" has the chance of another pass, and may choose the number of runs by the failures seen. So risks are
/// bounded given what was seen: for P = p and given F_{k−1}
///
///   P(F_k ≤ a_k) + E[R_k if F_k > a_k] ≤ R_{k−1}                                              (1)
///
/// By induction from the last analysis backwards, the probability of a pass at any analysis after k is at most R_k, by
/// whatever rule the numbers of runs follow from the failures so far; at any analysis at all it is at most α. The first
/// analysis that can pass may risk all that is left (α, if none was before it); a later one half of it:
///
///   P(F_k ≤ a_k) ≤ R_{k−1}/2                                                                  (2)
///
/// and no analysis allows more failures than it would by itself. What is left goes to the F_k that may pass later:
/// with m more runs, the largest b for which (1) holds with C = 1, and the C for which it then is an equation,
///
///   R_k = min(1, C P(F_k + Bin(m, 1 − p) ≤ b)),   m = max(3 n_k, 4 times the least runs that can pass) (3)
///
/// or, where no b ≥ 0 is small enough, R_k = R_{k−1} − P(F_k ≤ a_k) for all F_k. R_k never rises with F_k and is at
/// most 1, a pass: so P = p is the worst case of P ≤ p. After analyses of few runs, (3) may leave too little for n
/// runs to pass that could pass alone. The half, m and the form of (3) are choices: they change how often a good
/// wing passes, not the promise. A requirement that has passed can pass wrongly no more; from then on it is judged
/// with the confidence of bounds, for its tolerance limit is one (with none allowed where that could not pass).
///
/// Bounds of extension k (k ≥ 2) use the risk α/(k(k − 1)), in sum α: those of all extensions hold together at c if the
/// numbers of runs are not chosen by the results.
/// Sources: C. Jennison, B. W. Turnbull, Group Sequential Methods (2000), chapters 7 (spending) and 12 (binomial); H.-H.
/// Müller, H. Schäfer, Biometrics 57 (2001) 886–891 (what a later analysis may risk given the data so far).
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
  std::optional<long> allowed; ///< a_k; nothing if no number of failures is small enough
  double confidence = 0;       ///< at which a single analysis allows as many

  /// An extension's risk of a wrong pass at any analysis so far.
  struct Joint {
    double risk = 0;       ///< at most this: α
    double risk_alone = 0; ///< if each analysis were judged by itself at c; exact for these n_k
    std::optional<long> allowed_alone; ///< most failures, if this were the only analysis
  };
  std::optional<Joint> joint{}; ///< present after an extension
};

/// The rule at the analysis of n runs.
/// Cost after an extension: O(n p (1 − p)) operations for each analysis.
/// @param failed F_k of each analysis in interim.before; only those with fewer than n runs count
/// @pre n ≥ 0, 0 < p < 1, 0 < c < 1
[[nodiscard]] PassingRule passing_rule(const InterimAnalyses& interim, long n, double p, double c,
                                       std::span<const long> failed = {});

/// Whether k failures in n runs show P < p at confidence c: the rule for the probability 1 − p of a failure.
/// @param failed as of `passing_rule` @pre 0 ≤ k ≤ n
[[nodiscard]] bool is_disproved(const InterimAnalyses& interim, long n, double p, double c, long k,
                                std::span<const long> failed = {});

} // namespace wingspread
