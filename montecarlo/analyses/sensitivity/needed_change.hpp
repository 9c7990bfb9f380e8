/// Estimates from rows how far dispersed inputs must move for a requirement to pass: quadratic for a limit, first-order
/// for deployment.
///
///   symbol  meaning
///   x_ij    draw j of run i
///   y_i     the requirement's output; for deployment 1 of a run that did not deploy, else 0
///   b_j     slope: least squares of y on all draws
///   L, m    the limit; number of runs that may break it
///   t       the change: of inputs that are scaled x → (1 + t) x, else x → x + t
///   d_i     change of y_i for t = 1: Σ b_j x_ij, or Σ b_j, over the inputs that move together
///   q, r    share of broken runs now; the share that may break, m/n
///   φ, Φ    density and distribution function of the standard normal law
///
/// For a limit, the change is the smallest |t| at which at most m runs are beyond,
///
///   #{ i : y_i(t) > L } ≤ m                                                                    (1)
///
/// with y_i(t) quadratic in the change (lever_response.hpp). The runs are judged by the rule of the requirement's
/// verdict.
///
/// For deployment, let a run fail where a linear index of the draws passes a threshold. For normal draws the slope of
/// the indicator is that of the standardised index times φ(Φ⁻¹(q)) (D. R. Brillinger, in: A Festschrift for Erich L.
/// Lehmann (1983) 97–114). The share r fails where
///
///   Φ⁻¹(q) + t d̄/φ(Φ⁻¹(q)) = Φ⁻¹(r) s(t)                                                      (2)
///
/// with s the index's standard deviation after the change: 1 of a shift; a factor multiplies the spread of the moved
/// draws too, s² = 1 + (2t + t²) var(u)/φ² + 2t cov(u, r)/φ², u and r the moved part of the linear fit and the rest.
///
/// The runs must show it without the normal law. Let p(u) be the share that fails where the moved draws make the part u
/// of the linear fit (failure_curve.hpp). If the other draws do not depend on these,
///
///   Σ p(u_i + t d_i)                                                                          (3)
///
/// runs fail after the change. If (3) falls by less than half of what (2) promises, there is no estimate.
///
/// At this edge a new campaign of n runs passes in every second case only. If k of n runs break it here, at most m of n
/// new runs do with probability
///
///   P(≤ m | k) = I_½(k + 1, m + 1)                                                             (4)
///
/// (negative binomial, from a flat prior of the rate). The bounds are the changes for the largest k with P at least
/// (1 ∓ c)/2, widened by the jackknife's bounds of the slope. The far bound is the change to try.
///
/// A change is known only within the draws: at least 10 runs were drawn beyond the changed mean, and of those no larger
/// share than the requirement allows did not deploy; nor is (3) larger. Beyond, neither the output nor the deployment is
/// known.
#pragma once

#include "montecarlo/results/summary/replication.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// Draws that a change moves together.
struct MovedDraws {
  std::vector<std::size_t> columns; ///< of Results::draws
  bool scaled = true;               ///< the change multiplies them; else it is added to each
};

/// The change of some draws by which the requirement would pass: a factor of the draws if scaled (1 + t), else the
/// shift t.
struct NeededChange {
  double now = 0;  ///< mean of the draws
  double edge = 0; ///< change at which the allowed number of runs break it
  double change =
      0; ///< at which a new campaign passes at the confidence; the edge if that is not known
  bool known = false;         ///< whether the draws show that the change is enough
  Bounds bounds{};            ///< of the change; without the far one if it is not known
  double least = 0, most = 0; ///< changes that keep the mean of each draw within the values drawn
  long beyond_runs = 0,
       beyond_undeployed = 0; ///< runs drawn beyond the changed mean; of those, not deployed
  /// Means over the runs that break the requirement and over the others, relative to `now` if scaled, else as they are.
  double of_broken = 0, of_others = 0;
};

enum class NeededFor { limit, deployment };

struct NeededChanges {
  NeededFor what = NeededFor::limit;
  long runs = 0;        ///< of the estimate
  double explained = 0; ///< R² of the linear fit, adjusted for the number of draws
  /// One for each MovedDraws. Nothing if no change within the draws is enough. Nothing also if the slope's bounds include
  /// 0 at the confidence shared over all MovedDraws (Bonferroni): otherwise the most effective of many would often be
  /// due to chance.
  std::vector<std::optional<NeededChange>> changes;
};

/// The estimate; nothing if no run or every run breaks the requirement, if the draws are linear combinations of each
/// other, or if there are fewer than 10 runs more than draws. Cost O(n k²) for n runs and k draws.
/// @param what       limit: uses the deployed runs with a value; if the other runs alone are too many, the share
///                   1 − p of the deployed ones may break it
/// @param confidence of the bounds
/// @pre the verdict was decided from these rows; for `limit` the requirement has a limit on one of their outputs
[[nodiscard]] std::optional<NeededChanges> needed_changes(NeededFor what, const Verdict& verdict,
                                                          const Results& results,
                                                          const Replication& replication,
                                                          std::span<const MovedDraws> moved,
                                                          double confidence);

} // namespace wingspread
