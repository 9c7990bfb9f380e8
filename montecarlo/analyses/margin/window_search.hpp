/// The window of scales in which several conditions hold at once: which of them fails where, each
/// edge located to a tolerance, with what was seen on either side of it.
///
/// A grid over the range comes first, so that a condition that comes and goes is noticed. Then
/// cells between neighbouring scales are halved (by ratio) down to the tolerance, those and only
/// those that may hold an edge of the window:
///
///     F(a) ∩ F(b) = ∅, not both empty,   F(s): the conditions that fail at scale s             (1)
///
/// A condition that fails at both ends of a cell fails all through it, unless it comes and goes
/// within the cell; where each one fails at one end only, or none at one end, a window may begin or
/// end, or lie within. So a window is not missed for being narrower than a cell, and where there is
/// none, every cell has a condition that rules it out. Then, for the sake of the proof, the edges
/// of every single condition are located as well.
///
/// An end of the range is no edge. Where nothing fails there that holds anywhere further in,
///
///     F(end) ∩ ⋃_s H(s) = ∅,    H(s): the conditions that hold at scale s                      (2)
///
/// looks go on outwards, each by a factor of √2, until (2) is no longer so or a limit is reached: then a
/// window may end without an edge, and says so.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace wingspread {

/// The conditions that fail at a scale, by number.
using Failing = std::set<std::size_t>;
/// What was seen, by scale.
using Looks = std::map<double, Failing>;

struct SearchRange {
  double lower, upper; ///< 0 < lower < upper
  long points;         ///< of the grid, evenly by ratio, ≥ 2
  double tolerance;    ///< largest ratio of an edge's two sides, less 1; > 0
  /// How far it may be widened; by default not at all.
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
};

/// Neighbouring scales that pass.
struct Window {
  double lower, upper;         ///< the outermost that were seen to pass
  std::optional<double> below; ///< the next scale down, which fails; none where the search ended
  std::optional<double> above; ///< the next one up
};

/// Looks at the grid, at 1 (the present springs, with which all is compared), and at as many scales more
/// as it takes. Scales are numbers of few digits, so that they are what a report prints.
/// @param judge pure; what it throws ends the search
[[nodiscard]] Looks search_window(const SearchRange& range,
                                  const std::function<Failing(double)>& judge);

/// The scales that are looked at whatever they come to, in their order: the grid and 1.
[[nodiscard]] std::vector<double> first_scales(const SearchRange& range);

/// No more scales than this will have been looked at in all, with those that a recommendation takes: every cell that
/// may still be halved taken down to the tolerance. It falls as looks are taken.
/// @param looks so far, the first scales first
[[nodiscard]] long most_looks(const Looks& looks, const SearchRange& range);

/// The windows at whose scales `passes` holds, upwards.
[[nodiscard]] std::vector<Window> windows_where(const Looks& looks,
                                                const std::function<bool(const Failing&)>& passes);
/// Those of all conditions together, and those of a single one.
[[nodiscard]] std::vector<Window> windows_of(const Looks& looks);
[[nodiscard]] std::vector<Window> windows_of(const Looks& looks, std::size_t condition);

/// The widest, by ratio; the lowest of equals. Null without any.
[[nodiscard]] const Window* widest(const std::vector<Window>& windows);

/// A number of few digits near the scale, far within the tolerance.
[[nodiscard]] double rounded_scale(double scale, double tolerance);

/// The fewest conditions that leave no scale to pass, of the lowest numbers: one that never holds,
/// else two that never hold together, else all that ever fail. Empty when there is a window.
[[nodiscard]] std::vector<std::size_t> closed_by(const Looks& looks);

} // namespace wingspread
