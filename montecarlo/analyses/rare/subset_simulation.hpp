/// Probabilities too small to be counted: subset simulation.
///
/// The event is g(z) < 0, z standard normal and independent in d dimensions. It is reached by way
/// of likelier ones, {g ≤ b_1} ⊃ {g ≤ b_2} ⊃ …, each a tenth or so of the one before:
///
///     P = Π P_j,    P_j = n_j / N                                                              (1)
///
///   symbol  meaning
///   N       points of a level
///   n_j     of those of level j, how many are in the next event (at the last: g < 0)
///   c, L    chains of a level, and points of a chain: c L = N, L = 1/0.1
///   δ       coefficient of variation of an estimate
///   γ_j     what is lost because a chain's points resemble each other
///
/// The first level is plain sampling. Each of the others starts c chains from points of the level
/// before that are in its event, and moves them by conditional sampling:
///
///     z' = ρ z + √(1 − ρ²) ξ,  ξ standard normal; z' is taken if g(z') ≤ b_j, else z stays  (2)
///
/// which leaves the normal law restricted to the event as it is, for any ρ_i of any coordinate.
/// Coordinates in which the seeds lie close together move less (1 − ρ_i² = min(1, λ s_i)², s_i the
/// seeds' own spread), and λ is led to where 44 % of the moves are taken.
///
///     δ² = Σ δ_j²,  δ_j² = (1 − P_j)/(P_j N) (1 + γ_j)                                      (3)
///     γ_j = 2 Σ_k (1 − k/L) r_j(k)                                                          (4)
///
/// with r_j(k) the correlation along the chains at distance k.
///
/// The estimate is too large on average, by about 0.4 δ² (δ of one repetition, in units of P), because thresholds and
/// shares come from the same points. That is measured, on events of known probability 8e-4: +1.6 ± 0.9 % with N = 2000,
/// +4.7 ± 1.2 % with N = 500. An average over repetitions keeps it, and a larger N takes it away as 1/N. That λ is led
/// within a level, by the chains' own moves, is not the reason: fixed for each level it gave +3.9 ± 1.3 %.
///
/// Sources: S.-K. Au, J. L. Beck, Probabilistic Engineering Mechanics 16 (2001) 263–277: (1), (3),
/// (4); I. Papaioannou, W. Betz, K. Zwirglmaier, D. Straub, the same 41 (2015) 89–103: (2). (3)
/// knows nothing of chains that resemble each other because their seeds do: independent repetitions
/// do, so they are made as well.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace wingspread {

using NormalPoint = std::vector<double>; ///< z

/// g of each of the points: < 0 in the event, and the smaller elsewhere the nearer to it. Any g
/// with the right sign gives a right estimate; one that falls towards the event gives it sooner. A
/// g that is NaN counts as in the event.
using LimitStateFunction = std::function<std::vector<double>(std::span<const NormalPoint>)>;

struct SubsetOptions {
  long samples = 1000;     ///< N, a multiple of 10, ≥ 100
  double smallest = 1e-10; ///< no further than to probabilities of this size
  std::uint64_t seed = 1;
  std::uint64_t repetition = 0; ///< those with different numbers are independent
};

/// One of the events on the way.
struct SubsetLevel {
  double threshold;   ///< b_j; 0 for the last
  double share;       ///< P_j
  double correlation; ///< γ_j
  double variation;   ///< δ_j
  double taken;       ///< share of the moves that were taken; NaN at the first level
};

struct SubsetEstimate {
  /// P; when the event was not reached, that of the last level which was, of which the event is a part: an
  /// estimate too, and no bound that P keeps to for certain
  double probability = 0;
  double variation = 0; ///< δ
  bool reached = false; ///< whether there are points in the event
  bool stuck = false;   ///< g tells the points of the last level apart no more
  long evaluations = 0; ///< of g
  std::vector<SubsetLevel> levels;
  std::vector<NormalPoint> inside; ///< points of the last level in the event
};

/// One subset simulation. Pure if g is; the points of a step, N of the first level and c of every
/// other, are handed over together.
[[nodiscard]] SubsetEstimate subset_simulation(const LimitStateFunction& g, std::size_t dimensions,
                                               const SubsetOptions& options);

/// No more evaluations than this, unless many points have the very same g.
[[nodiscard]] long most_evaluations(const SubsetOptions& options);

/// Independent repetitions taken together.
struct RareEstimate {
  double probability = 0; ///< their mean
  double variation = 0;   ///< of it: the larger of the next two
  double from_chains = 0; ///< by (3)
  double from_spread = 0; ///< by how much they differ; NaN for one
  Interval interval;      ///< of P
  bool reached = false;   ///< by all
  /// By how much the mean is too large on average, in units of it: see above. 0 for plain sampling.
  double bias = 0;
  long evaluations = 0;
  /// How many runs plain sampling takes for the same variation, (1 − P)/(P δ²).
  double plain_runs = 0;
  [[nodiscard]] bool plain_is_enough() const {
    return reached && plain_runs <= static_cast<double>(evaluations);
  }
};

/// The mean of the estimates. Its interval is P exp(± q δ), the wider of two: δ by (3) with the
/// normal law's q, or from their spread with Student's. Where one did not reach the event, there is only an upper
/// bound, of the levels that were reached: an estimate, as they are.
/// @pre at least one
[[nodiscard]] RareEstimate combined(std::span<const SubsetEstimate> estimates, double confidence);

} // namespace wingspread
