#include "montecarlo/analyses/margin/window_search.hpp"

#include "montecarlo/foundation/formats/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

namespace wingspread {
namespace {

using Cell = std::function<bool(const Failing&, const Failing&)>;

bool share_any(const Failing& a, const Failing& b) {
  return std::ranges::any_of(a, [&](std::size_t condition) { return b.contains(condition); });
}

/// Whether a cell may contain an edge of the window, by (1).
bool may_hold_edge(const Failing& a, const Failing& b) {
  return !(a.empty() && b.empty()) && !share_any(a, b);
}

bool differ(const Failing& a, const Failing& b) { return a != b; }

/// Whether the search must go on beyond this end, by (2).
bool is_open(const FailingByScale& by_scale, const Failing& at_end) {
  return std::ranges::none_of(at_end, [&](std::size_t condition) {
    return std::ranges::any_of(by_scale,
                               [&](const auto& one) { return !one.second.contains(condition); });
  });
}

double further_down(double end, const SearchRange& range) {
  return std::max(rounded_scale(end / std::numbers::sqrt2, range.tolerance), range.lowest);
}

double further_up(double end, const SearchRange& range) {
  return std::min(rounded_scale(end * std::numbers::sqrt2, range.tolerance), range.highest);
}

/// The number of scales that halve a cell and all its parts down to the tolerance.
long most_halvings(double a, double b, double tolerance) {
  constexpr double for_rounding =
      0.01; // heuristic: rounded scales make unequal halves; 0 would count one halving too few
  const double wide = std::log(b / a) / std::log1p(tolerance);
  return wide <= 1 ? 0 : (1L << static_cast<int>(std::ceil(std::log2(wide) + for_rounding))) - 1;
}

/// The evaluated scales, the grid, and all scales by which the range may still be extended. More scales only add to ⋃
/// H, so once (2) is false at an end it stays false. The range is never extended beyond such an end, even if the grid
/// is not complete.
std::vector<double> all_ends(const FailingByScale& by_scale, const SearchRange& range) {
  std::set<double> scales;
  for (const auto& [scale, failing] : by_scale) scales.insert(scale);
  for (const double scale : first_scales(range)) scales.insert(scale);
  const auto may_go_on = [&](double end) {
    const auto one = by_scale.find(end);
    return one == by_scale.end() || is_open(by_scale, one->second);
  };
  if (may_go_on(*scales.begin()))
    while (*scales.begin() > range.lowest) scales.insert(further_down(*scales.begin(), range));
  if (may_go_on(*scales.rbegin()))
    while (*scales.rbegin() < range.highest) scales.insert(further_up(*scales.rbegin(), range));
  return {scales.begin(), scales.end()};
}

/// The search in progress.
class Search {
public:
  Search(const SearchRange& range, const std::function<Failing(double)>& judge)
      : range_(range), judge_(judge) {}

  FailingByScale run() {
    judge_grid();
    do widen();
    while (refine(may_hold_edge) || (windows_of(by_scale_).empty() && refine(differ)));
    return std::move(by_scale_);
  }

private:
  void judge_grid() {
    for (const double scale : first_scales(range_)) judge_at(scale);
  }

  /// Extends the range at open ends (2).
  void widen() {
    for (std::size_t before = 0;
         before != by_scale_.size();) { // a scale added at one end can make (2) false at the other
      before = by_scale_.size();
      while (by_scale_.begin()->first > range_.lowest &&
             is_open(by_scale_, by_scale_.begin()->second))
        judge_at(further_down(by_scale_.begin()->first, range_));
      while (by_scale_.rbegin()->first < range_.highest &&
             is_open(by_scale_, by_scale_.rbegin()->second))
        judge_at(further_up(by_scale_.rbegin()->first, range_));
    }
  }

  void judge_at(double scale) {
    if (!by_scale_.contains(scale)) by_scale_[scale] = judge_(scale);
  }

  /// Halves the wide cells that `wanted` selects until there are none. @return whether there were any
  bool refine(const Cell& wanted) {
    const std::size_t before = by_scale_.size();
    for (auto a = by_scale_.begin(); std::next(a) != by_scale_.end();) {
      const auto b = std::next(a);
      const bool wide = b->first > a->first * (1 + range_.tolerance);
      const double middle = rounded_scale(std::sqrt(a->first * b->first), range_.tolerance);
      if (wide && wanted(a->second, b->second) && a->first < middle && middle < b->first)
        judge_at(middle); // then this cell again, now half as wide
      else
        ++a;
    }
    return by_scale_.size() > before;
  }

  const SearchRange& range_;
  const std::function<Failing(double)>& judge_;
  FailingByScale by_scale_;
};

/// Whether at least one of the conditions fails at every scale.
bool closes(const FailingByScale& by_scale, const Failing& conditions) {
  return std::ranges::all_of(by_scale,
                             [&](const auto& one) { return share_any(conditions, one.second); });
}

Failing ever_failing(const FailingByScale& by_scale) {
  Failing all;
  for (const auto& [scale, failing] : by_scale) all.insert(failing.begin(), failing.end());
  return all;
}

} // namespace

std::vector<double> first_scales(const SearchRange& range) {
  std::vector<double> scales;
  const auto add = [&](double scale) {
    if (std::ranges::find(scales, scale) == scales.end()) scales.push_back(scale);
  };
  const double cells = static_cast<double>(range.points - 1);
  for (long k = 0; k < range.points - 1; ++k)
    add(k == 0 ? range.lower
               : rounded_scale(range.lower * std::pow(range.upper / range.lower,
                                                      static_cast<double>(k) / cells),
                               range.tolerance));
  add(range.upper);
  add(1);
  return scales;
}

long most_scales(const FailingByScale& by_scale, const SearchRange& range) {
  constexpr long middles =
      2; // a recommendation evaluates at most two middles of stretches with equal strain
  const bool has_window = !windows_of(by_scale).empty();
  const std::vector<double> ends = all_ends(by_scale, range);
  long most = std::ssize(ends) + middles;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const auto a = by_scale.find(ends[k]), b = by_scale.find(ends[k + 1]);
    const bool is_ruled_out = a != by_scale.end() && b != by_scale.end() &&
                              share_any(a->second, b->second) &&
                              (has_window || a->second == b->second);
    if (!is_ruled_out) most += most_halvings(ends[k], ends[k + 1], range.tolerance);
  }
  return most;
}

FailingByScale search_window(const SearchRange& range,
                             const std::function<Failing(double)>& judge) {
  return Search(range, judge).run();
}

std::vector<Window> windows_where(const FailingByScale& by_scale,
                                  const std::function<bool(const Failing&)>& passes) {
  std::vector<Window> windows;
  std::optional<double> failed; // the scale before, if it does not pass
  bool open = false;
  for (const auto& [scale, failing] : by_scale) {
    if (!passes(failing)) {
      if (open) windows.back().above = scale;
      open = false;
      failed = scale;
      continue;
    }
    if (!open) windows.push_back({scale, scale, failed, {}});
    windows.back().upper = scale;
    open = true;
  }
  return windows;
}

std::vector<Window> windows_of(const FailingByScale& by_scale) {
  return windows_where(by_scale, [](const Failing& failing) { return failing.empty(); });
}

std::vector<Window> windows_of(const FailingByScale& by_scale, std::size_t condition) {
  return windows_where(by_scale,
                       [&](const Failing& failing) { return !failing.contains(condition); });
}

const Window* widest(const std::vector<Window>& windows) {
  const auto ratio = [](const Window& window) { return window.upper / window.lower; };
  const auto found = std::ranges::max_element(windows, {}, ratio);
  return found == windows.end() ? nullptr : &*found;
}

double rounded_scale(double scale, double tolerance) {
  const int digits = static_cast<int>(std::ceil(-std::log10(tolerance))) + 2;
  return parse_csv_number(fmt::format("{:.{}g}", scale, digits)).value_or(scale);
}

std::vector<std::pair<double, double>> unresolved_cells(const FailingByScale& by_scale) {
  std::vector<std::pair<double, double>> cells;
  const std::pair<const double, Failing>* before = nullptr;
  for (const auto& here : by_scale) {
    if (before && !before->second.empty() && !here.second.empty() &&
        !share_any(before->second, here.second))
      cells.emplace_back(before->first, here.first);
    before = &here;
  }
  return cells;
}

std::vector<std::size_t> closed_by(const FailingByScale& by_scale) {
  if (!windows_of(by_scale).empty()) return {};
  const Failing all = ever_failing(by_scale);
  std::vector<std::size_t> alone;
  for (const std::size_t one : all)
    if (closes(by_scale, {one})) alone.push_back(one);
  if (!alone.empty()) return alone;
  for (const std::size_t one : all)
    for (const std::size_t other : all)
      if (closes(by_scale, {one, other})) return {one, other};
  return {all.begin(), all.end()};
}

} // namespace wingspread
