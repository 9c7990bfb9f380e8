/// The window of scales in which several conditions hold at once. Every edge is located to a tolerance and keeps the
/// failing conditions on both sides.
///
/// First a grid over the range is evaluated, so that a condition with several windows is noticed. Then cells between
/// neighbouring scales are halved (by ratio) down to the tolerance, if and only if they may contain an edge of the
/// window:
///
///     F(a) ∩ F(b) = ∅, not both empty,   F(s): the conditions that fail at scale s             (1)
///
/// A condition that fails at both ends of a cell is assumed to fail throughout the cell, so no window lies in it.
/// Without such a condition a window may begin or end in the cell, or lie within it. So the search also finds a window
/// that is narrower than a cell. A cell at both of whose ends all conditions hold is not halved: a condition that fails
/// only inside is not seen. Loads have such peaks where the latches of two hinges meet: of the three-panel flight wing
/// root.peak_force is 343 N and 409 N where the tip's springs are scaled by 1.291 and 1.409, and 1370 N at 1.385. The
/// report states the widest cell in the window, and the recommended scale is run. If there is no window, every cell has
/// a condition that rules it out. The edges of each single condition are then located too, as evidence.
///
/// An end of the range is not an edge. If each condition that fails there fails at every scale,
///
///     F(end) ∩ ⋃_s H(s) = ∅,    H(s): the conditions that hold at scale s                      (2)
///
/// the range is extended by factors of √2 until (2) is false or a limit is reached. A window at the limit has no edge.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace wingspread {

/// The indices of the conditions that fail at a scale.
using Failing = std::set<std::size_t>;
/// The failing conditions by scale.
using FailingByScale = std::map<double, Failing>;

struct SearchRange {
  double lower, upper; ///< 0 < lower < upper
  long points;         ///< of the grid, evenly by ratio, ≥ 2
  double tolerance;    ///< largest ratio of an edge's two scales, minus 1; > 0
  /// Limits of the extension. The default values allow no extension.
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
};

/// Neighbouring scales that pass.
struct Window {
  double lower, upper;         ///< the outermost passing scales
  std::optional<double> below; ///< the next scale down, which fails; none at the end of the search
  std::optional<double> above; ///< the next scale up, likewise
};

/// Evaluates the grid, scale 1 (the present springs, for comparison) and the scales that (1) and (2) require. Scales
/// are rounded to few digits, so that a report prints them exactly.
/// @param judge the failing conditions at a scale; pure; its exceptions end the search
[[nodiscard]] FailingByScale search_window(const SearchRange& range,
                                           const std::function<Failing(double)>& judge);

/// The scales that are always evaluated, in their order: the grid and 1.
[[nodiscard]] std::vector<double> first_scales(const SearchRange& range);

/// An upper bound of the number of scales that the search and the recommendation evaluate. Every cell that is not ruled
/// out counts as halved down to the tolerance. The bound decreases as scales are evaluated.
/// @param by_scale the scales so far, first_scales() first
[[nodiscard]] long most_scales(const FailingByScale& by_scale, const SearchRange& range);

/// The stretches of scales at which `passes` holds, ascending.
[[nodiscard]] std::vector<Window> windows_where(const FailingByScale& by_scale,
                                                const std::function<bool(const Failing&)>& passes);
/// The windows of all conditions together, and of a single condition.
[[nodiscard]] std::vector<Window> windows_of(const FailingByScale& by_scale);
[[nodiscard]] std::vector<Window> windows_of(const FailingByScale& by_scale, std::size_t condition);

/// The widest window by ratio, the lowest of equally wide ones; null if there is no window.
[[nodiscard]] const Window* widest(const std::vector<Window>& windows);

/// The cells of (1) of which both ends fail. A window may lie inside: if the search has found none, its tolerance was too
/// coarse for them.
[[nodiscard]] std::vector<std::pair<double, double>>
unresolved_cells(const FailingByScale& by_scale);

/// The scale rounded to two digits more than the tolerance has.
[[nodiscard]] double rounded_scale(double scale, double tolerance);

/// Conditions that rule out every evaluated scale: all that never hold; else the first two that never hold at the same
/// scale; else all that fail at any scale. Empty if there is a window.
[[nodiscard]] std::vector<std::size_t> closed_by(const FailingByScale& by_scale);

} // namespace wingspread
