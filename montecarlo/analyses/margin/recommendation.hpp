/// The recommended scale of a window: the one with the least strain.
///
/// | symbol   | meaning                                                                        |
/// |----------|--------------------------------------------------------------------------------|
/// | k, n     | runs that break a condition at a scale, and all runs there                     |
/// | 1 − p    | the share of runs that may break it, by its requirement                        |
/// | σ(s)     | strain: max of k / (n (1 − p)) over the conditions, as observed                |
///
/// Weak springs strain conditions on one side (deployment, static margins), strong springs those on the other (moments,
/// rates). So σ has its minimum between the edges. If several neighbouring scales have the minimum (often 0: nothing
/// fails), the present springs are kept if they are among them; else the geometric middle of the widest stretch is taken.
/// If the minimum is above 0, or one scale alone has it, the cells beside it are halved down to the tolerance.
///
/// No scale is recommended if the window lacks an edge, because the distance to that side is unknown. Scales with a static
/// margin below 0 (weaker_springs.hpp) are passed over; the best of them is reported.
#pragma once

#include "montecarlo/analyses/margin/margin_result.hpp"

#include <functional>

namespace wingspread {

/// The strain of one condition, k / (n (1 − p)).
[[nodiscard]] double strain(const Verdict& verdict);
/// The strain σ of a scale.
[[nodiscard]] double strain(const ScaleLook& look);

/// The functions that a recommendation calls.
struct RecommendationMeans {
  double tolerance; ///< of scales, relative; the same as of the window's edges
  /// Makes the runs at a new scale and stores them in MarginSearch::seen.
  std::function<void(double)> look;
  /// The static margin that rules the scale out, if any.
  std::function<std::optional<Shortfall>(double)> shortfall;
};

/// Sets MarginSearch::recommended, or `withheld`, and `passed_over`.
void recommend(const RecommendationMeans& means, MarginSearch& search);

} // namespace wingspread
