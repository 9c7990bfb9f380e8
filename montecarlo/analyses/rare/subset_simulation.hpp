/// Subset simulation: estimates of probabilities too small to count.
///
/// The event is g(z) < 0, with z standard normal and independent in d dimensions. The simulation approaches it through
/// more likely events {g ≤ b_1} ⊃ {g ≤ b_2} ⊃ …, each with about a tenth of the probability of the previous one:
///
///     P = Π P_j,    P_j = n_j / N                                                              (1)
///
///   symbol  meaning
///   N       number of points of a level
///   n_j     number of points of level j in the next event (at the last level: g < 0)
///   c, L    number of chains of a level, and of points of a chain: c L = N, L = 10
///   δ       coefficient of variation of an estimate
///   γ_j     increase of the variance because a chain's points are correlated
///
/// The first level is plain sampling. Each later level starts c chains. Their first points (seeds) are the points of
/// the previous level that lie in {g ≤ b_j}. Conditional sampling moves them:
///
///     z' = ρ z + √(1 − ρ²) ξ,  ξ standard normal; z' is taken if g(z') ≤ b_j, else z stays  (2)
///
/// This leaves the normal law restricted to {g ≤ b_j} invariant. 1 − ρ² = λ², and λ ≤ 1 is adapted so that 44 % of the
/// moves are accepted. A λ of each coordinate in proportion to the seeds' standard deviation there (Papaioannou et al.)
/// was ruled out: that deviation follows the seeds' own values, so the largest coordinates shrink the most. With |z|² of
/// 24 coordinates as the limit state and N = 500, estimates were 22 % too small, and 16.6 % of 95 % upper bounds below
/// P. With one λ they are 6 % too large, and 1.5 % are; other limit states have the same δ by either.
///
/// A coordinate that chooses a row of a table or one of a few values is a label: neighbours have nothing in common. One
/// row may be the only way to the event, a narrow interval of its coordinate, and nearly every step of (2) leaves it. With
/// labels, a step therefore either moves all other coordinates by (2) or draws a share q of the labels anew, at least one.
/// Both leave the law invariant. λ and q are adapted each to the steps of its own kind.
///
///     δ² = Σ δ_j²,  δ_j² = (1 − P_j)/(P_j N) (1 + γ_j)                                      (3)
///     γ_j = 2 Σ_k (1 − k/L) r_j(k)                                                          (4)
///
/// with r_j(k) the correlation between points of a chain that are k steps apart.
///
/// Bias: on average the estimate exceeds P by about 0.5 δ² P (δ of one repetition), because thresholds and shares come
/// from the same points. README.md has the measurements: +0.3 to +0.6 δ². The bias decreases as 1/N; averaging
/// repetitions does not reduce it. Adapting λ within a level is not the cause: with λ fixed per level it was as large.
///
/// An event that is not rare: a repetition ends at its first level if n_1 ≥ c. If one does, or if none has a second
/// level, the first levels of all R repetitions are pooled: N R independent draws, of which `hits` have the event, with
/// Clopper–Pearson bounds. (3) has no meaning for P → 1, where δ → 0 in every repetition without a miss.
///
/// An atom: if g is equal at nine tenths of a level's points, the next level starts from the other points if there are at
/// least 30, so that some start several chains; δ_j² of that level is larger by the chains a point starts. From fewer
/// points no further level starts (`stuck`). The estimate is then the share of the level's points in the event, which may
/// be 0. It is unbiased, but for a share of 0 its δ is unknown. The interval therefore contains a Clopper–Pearson
/// interval: that of as many runs of plain sampling as have the variation found.
///
/// If no repetition reaches the event, the last level's probability is an upper bound, and the first levels' 0 hits are
/// another. The estimate is by the smaller bound.
///
/// Sources: S.-K. Au, J. L. Beck, Probabilistic Engineering Mechanics 16 (2001) 263–277: (1), (3),
/// (4); I. Papaioannou, W. Betz, K. Zwirglmaier, D. Straub, ibid. 41 (2015) 89–103: (2), and 44 %.
/// (3) neglects the correlation between chains with similar seeds; the spread of independent repetitions includes it.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace wingspread {

using NormalPoint = std::vector<double>; ///< z

/// Returns g of each point. g < 0 means the event; NaN counts as the event. Any g with the right sign gives a correct
/// estimate; a g that decreases towards the event needs fewer runs.
using LimitStateFunction = std::function<std::vector<double>(std::span<const NormalPoint>)>;

struct SubsetOptions {
  long samples = 1000;     ///< N, a multiple of 10, ≥ 100
  double smallest = 1e-10; ///< no further level once a level's probability is at most this
  std::uint64_t seed = 1;
  std::uint64_t repetition = 0;      ///< repetitions with different numbers are independent
  std::vector<std::size_t> labels{}; ///< coordinates that steps draw anew (see above)
};

/// One level.
struct SubsetLevel {
  double threshold;   ///< b_j; 0 for the last
  double share;       ///< P_j
  double correlation; ///< γ_j
  double variation;   ///< δ_j
  double taken;       ///< share of accepted moves; NaN at the first level
};

struct SubsetEstimate {
  double probability = 0; ///< P by (1); 0 if the simulation was stuck with no point in the event
  /// The probability of the last level, which contains the event: if the event was not reached, an estimated upper
  /// bound, not guaranteed.
  double last_level = 1;
  double variation = 0; ///< δ
  bool reached = false; ///< whether points of the last level lie in the event
  bool stuck = false;   ///< g is equal at the points of the last level, so no further level exists
  long evaluations = 0; ///< of g
  long first_points = 0, first_hits = 0; ///< points of the first level, and those in the event
  std::vector<SubsetLevel> levels;
  std::vector<NormalPoint> inside; ///< the last level's points in the event
};

/// One subset simulation. Pure if g is. Calls g with all points of a step at once: N points for the first level, then c
/// points for each step of the chains.
[[nodiscard]] SubsetEstimate subset_simulation(const LimitStateFunction& g, std::size_t dimensions,
                                               const SubsetOptions& options);

/// Whether repetitions differ by far more than their own variations explain: by 7 standard errors between the
/// logarithms of two probabilities, or by a spread of twice the variation by (3). Also true if only some reached the
/// event.
[[nodiscard]] bool repetitions_disagree(std::span<const SubsetEstimate> estimates);

/// An upper bound of the number of evaluations of g, unless many points have equal g: then a level divides the
/// probability by less than 10.
[[nodiscard]] long most_evaluations(const SubsetOptions& options);

/// The combined estimate of independent repetitions.
struct RareEstimate {
  double probability = 0; ///< their mean; the last levels' if none reached the event
  /// Whether the event is not rare: the estimate is the share of the pooled first levels, with Clopper–Pearson bounds.
  bool plain = false;
  long hits = 0, draws = 0; ///< points of the first levels in the event, and all of them
  double variation = 0;     ///< coefficient of variation of the mean: the larger of the next two
  double from_chains = 0;   ///< by (3)
  double from_spread = 0;   ///< from the spread of the repetitions; NaN for a single repetition
  Interval interval;        ///< of P
  bool reached =
      false; ///< whether every repetition reached the event or was stuck, and one reached it
  /// Relative bias of the mean (see above); 0 for plain sampling.
  double bias = 0;
  long evaluations = 0;
  /// Number of runs of plain sampling with the same variation, (1 − P)/(P δ²); `draws` for a plain estimate.
  double plain_runs = 0;
  [[nodiscard]] bool plain_is_enough() const {
    return plain || (reached && plain_runs <= static_cast<double>(evaluations));
  }
};

/// The mean of the estimates. Its interval is P exp(± q δ), the wider of two: δ by (3) with the normal quantile q, and
/// δ from the spread with Student's; the lower end is less by the bias. If the event was not reached, the interval starts
/// at 0 and its upper end is estimated, not guaranteed. An event that is not rare, and an atom: see above.
/// @pre at least one estimate; all have the same number of samples
[[nodiscard]] RareEstimate combined(std::span<const SubsetEstimate> estimates, double confidence);

} // namespace wingspread
