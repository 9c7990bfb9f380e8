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
bool is_open(const Looks& looks, const Failing& at_end) {
  return std::ranges::none_of(at_end, [&](std::size_t condition) {
    return std::ranges::any_of(looks,
                               [&](const auto& look) { return !look.second.contains(condition); });
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
std::vector<double> all_ends(const Looks& looks, const SearchRange& range) {
  std::set<double> scales;
  for (const auto& [scale, failing] : looks) scales.insert(scale);
  for (const double scale : first_scales(range)) scales.insert(scale);
  const auto may_go_on = [&](double end) {
    const auto look = looks.find(end);
    return look == looks.end() || is_open(looks, look->second);
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

  Looks run() {
    look_at_grid();
    do widen();
    while (refine(may_hold_edge) || (windows_of(looks_).empty() && refine(differ)));
    return std::move(looks_);
  }

private:
  void look_at_grid() {
    for (const double scale : first_scales(range_)) look(scale);
  }

  /// Extends the range at open ends (2).
  void widen() {
    for (std::size_t before = 0;
         before != looks_.size();) { // a scale added at one end can make (2) false at the other
      before = looks_.size();
      while (looks_.begin()->first > range_.lowest && is_open(looks_, looks_.begin()->second))
        look(further_down(looks_.begin()->first, range_));
      while (looks_.rbegin()->first < range_.highest && is_open(looks_, looks_.rbegin()->second))
        look(further_up(looks_.rbegin()->first, range_));
    }
  }

  void look(double scale) {
    if (!looks_.contains(scale)) looks_[scale] = judge_(scale);
  }

  /// Halves the wide cells that `wanted` selects until there are none. @return whether there were any
  bool refine(const Cell& wanted) {
    const std::size_t before = looks_.size();
    for (auto a = looks_.begin(); std::next(a) != looks_.end();) {
      const auto b = std::next(a);
      const bool wide = b->first > a->first * (1 + range_.tolerance);
      const double middle = rounded_scale(std::sqrt(a->first * b->first), range_.tolerance);
      if (wide && wanted(a->second, b->second) && a->first < middle && middle < b->first)
        look(middle); // then this cell again, now half as wide
      else
        ++a;
    }
    return looks_.size() > before;
  }

  const SearchRange& range_;
  const std::function<Failing(double)>& judge_;
  Looks looks_;
};

/// Whether at least one of the conditions fails at every scale.
bool closes(const Looks& looks, const Failing& conditions) {
  return std::ranges::all_of(looks,
                             [&](const auto& look) { return share_any(conditions, look.second); });
}

Failing ever_failing(const Looks& looks) {
  Failing all;
  for (const auto& [scale, failing] : looks) all.insert(failing.begin(), failing.end());
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

long most_looks(const Looks& looks, const SearchRange& range) {
  constexpr long middles =
      2; // a recommendation evaluates at most two middles of stretches with equal strain
  const bool has_window = !windows_of(looks).empty();
  const std::vector<double> ends = all_ends(looks, range);
  long most = std::ssize(ends) + middles;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const auto a = looks.find(ends[k]), b = looks.find(ends[k + 1]);
    const bool is_ruled_out = a != looks.end() && b != looks.end() &&
                              share_any(a->second, b->second) &&
                              (has_window || a->second == b->second);
    if (!is_ruled_out) most += most_halvings(ends[k], ends[k + 1], range.tolerance);
  }
  return most;
}

Looks search_window(const SearchRange& range, const std::function<Failing(double)>& judge) {
  return Search(range, judge).run();
}

std::vector<Window> windows_where(const Looks& looks,
                                  const std::function<bool(const Failing&)>& passes) {
  std::vector<Window> windows;
  std::optional<double> failed; // the scale before, if it does not pass
  bool open = false;
  for (const auto& [scale, failing] : looks) {
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

std::vector<Window> windows_of(const Looks& looks) {
  return windows_where(looks, [](const Failing& failing) { return failing.empty(); });
}

std::vector<Window> windows_of(const Looks& looks, std::size_t condition) {
  return windows_where(looks, [&](const Failing& failing) { return !failing.contains(condition); });
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

std::vector<std::size_t> closed_by(const Looks& looks) {
  if (!windows_of(looks).empty()) return {};
  const Failing all = ever_failing(looks);
  for (const std::size_t one : all)
    if (closes(looks, {one})) return {one};
  for (const std::size_t one : all)
    for (const std::size_t other : all)
      if (closes(looks, {one, other})) return {one, other};
  return {all.begin(), all.end()};
}

} // namespace wingspread
