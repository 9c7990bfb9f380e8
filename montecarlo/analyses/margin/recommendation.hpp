/// Which scale of a window to take: the one whose worse side is best.
///
/// | symbol   | meaning                                                                        |
/// |----------|--------------------------------------------------------------------------------|
/// | k, n     | runs that break a condition at a scale, of all runs there                      |
/// | 1 − p    | the share that may break it, by its requirement                                |
/// | σ(s)     | strain, max over the conditions of k / (n (1 − p)), as observed                |
///
/// Weak springs strain the conditions of one side (deployment, static margins), strong ones those of the
/// other (moments, rates), so that σ has its least between the edges, not in their middle. Where several
/// neighbouring scales have the least (often 0: nothing fails), the present springs are kept if they are among
/// them; else the middle of the widest stretch is taken, by ratio. Where even
/// the least is above 0, or one scale alone has it, the cells beside it are halved down to the tolerance.
///
/// Nothing is recommended where the window lacks an edge: it is not known how far the other side is. Scales
/// that may not be advised (weaker_springs.hpp) are passed over, and the best of them is said.
#pragma once

#include "montecarlo/analyses/margin/margin_result.hpp"

#include <functional>

namespace wingspread {

/// k / (n (1 − p)).
[[nodiscard]] double strain(const Verdict& verdict);
/// σ of what was seen at a scale.
[[nodiscard]] double strain(const ScaleLook& look);

/// What a recommendation takes.
struct RecommendationMeans {
  double tolerance; ///< of scales, as of the window's edges
  /// Makes the runs at a scale that was not looked at, and keeps them in `seen`.
  std::function<void(double)> look;
  /// What speaks against advising the scale, if anything.
  std::function<std::optional<Shortfall>(double)> shortfall;
};

/// Sets `recommended`, or why there is none, and what was passed over.
void recommend(const RecommendationMeans& means, MarginSearch& search);

} // namespace wingspread
