#include "montecarlo/margin/window_search.hpp"

#include "montecarlo/formats/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace wingspread {
namespace {

using Cell = std::function<bool(const Failing&, const Failing&)>;

bool share_any(const Failing& a, const Failing& b) {
  return std::ranges::any_of(a, [&](std::size_t condition) { return b.contains(condition); });
}

/// (1)
bool may_hold_edge(const Failing& a, const Failing& b) {
  return !(a.empty() && b.empty()) && !share_any(a, b);
}

bool differ(const Failing& a, const Failing& b) { return a != b; }

/// The search as it goes on.
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
    const double cells = static_cast<double>(range_.points - 1);
    for (long k = 0; k < range_.points - 1; ++k)
      look(k == 0 ? range_.lower
                  : rounded_scale(range_.lower * std::pow(range_.upper / range_.lower,
                                                          static_cast<double>(k) / cells),
                                  range_.tolerance));
    look(range_.upper);
    look(1);
  }

  /// Beyond ends that are no edges.
  void widen() {
    constexpr double step = std::numbers::sqrt2;
    for (std::size_t before = 0;
         before != looks_.size();) { // what holds at one end matters at the other
      before = looks_.size();
      while (looks_.begin()->first > range_.lowest && is_open(looks_.begin()->second))
        look(
            std::max(rounded_scale(looks_.begin()->first / step, range_.tolerance), range_.lowest));
      while (looks_.rbegin()->first < range_.highest && is_open(looks_.rbegin()->second))
        look(std::min(rounded_scale(looks_.rbegin()->first * step, range_.tolerance),
                      range_.highest));
    }
  }

  /// (2)
  [[nodiscard]] bool is_open(const Failing& at_end) const {
    return std::ranges::none_of(at_end, [&](std::size_t condition) {
      return std::ranges::any_of(
          looks_, [&](const auto& look) { return !look.second.contains(condition); });
    });
  }

  void look(double scale) {
    if (!looks_.contains(scale)) looks_[scale] = judge_(scale);
  }

  /// Halves the wide cells that `wanted` names until there are none. @return whether there were any
  bool refine(const Cell& wanted) {
    const std::size_t before = looks_.size();
    for (auto a = looks_.begin(); std::next(a) != looks_.end();) {
      const auto b = std::next(a);
      const bool wide = b->first > a->first * (1 + range_.tolerance);
      const double middle = rounded_scale(std::sqrt(a->first * b->first), range_.tolerance);
      if (wide && wanted(a->second, b->second) && a->first < middle && middle < b->first)
        look(middle); // and this cell again, which is smaller now
      else
        ++a;
    }
    return looks_.size() > before;
  }

  const SearchRange& range_;
  const std::function<Failing(double)>& judge_;
  Looks looks_;
};

/// Whether the conditions are never held to at once.
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
