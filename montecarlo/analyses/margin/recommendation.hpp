/// The recommended scale of a window: the one with the least strain.
///
/// | symbol   | meaning                                                                        |
/// |----------|--------------------------------------------------------------------------------|
/// | k, n     | numbers of runs that break a condition at a scale, and of all runs there       |
/// | 1 − p    | the share of runs that may break it, by its requirement                        |
/// | σ(s)     | strain: max of k / (n (1 − p)) over the conditions, as observed                |
///
/// Weak springs strain some conditions (deployment, static margins), strong springs strain others (moments, rates). So σ
/// has its minimum between the edges. Neighbouring scales may share the minimum; often it is 0, because no run breaks any
/// condition. Then the present springs are kept if they lie among these scales; else the geometric mean of the ends of the
/// widest such stretch is taken. The cells beside the stretch are halved down to the tolerance, so that its ends, and with
/// them the mean, do not depend on the grid.
///
/// No scale is recommended if the window lacks an edge, because the distance to that edge is unknown. Scales that a
/// static margin below 0 rules out (weaker_springs.hpp) are passed over. The best of them is reported if it has less
/// strain than the recommended scale.
#pragma once

#include "montecarlo/analyses/margin/margin_result.hpp"

#include <functional>

namespace wingspread {

/// The strain of one condition, k / (n (1 − p)).
[[nodiscard]] double strain(const Verdict& verdict);
/// The strain σ of a scale.
[[nodiscard]] double strain(const ScaleResult& cases);

/// The functions that a recommendation calls.
struct RecommendationCallbacks {
  double tolerance; ///< relative tolerance of scales, the same as for the window's edges
  /// Makes the runs at a new scale and stores them in MarginSearch::seen.
  std::function<void(double)> run_at;
  /// The static margin that rules the scale out, if any.
  std::function<std::optional<Shortfall>(double)> shortfall;
};

/// Sets MarginSearch::recommended and `as_good`, or `withheld`, and `passed_over`.
void recommend(const RecommendationCallbacks& means, MarginSearch& search);

} // namespace wingspread
