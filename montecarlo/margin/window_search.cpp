#include "montecarlo/margin/window_search.hpp"

#include "montecarlo/formats/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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

/// With digits enough to stay far within the tolerance.
double rounded(double scale, double tolerance) {
  const int digits = static_cast<int>(std::ceil(-std::log10(tolerance))) + 2;
  return parse_csv_number(fmt::format("{:.{}g}", scale, digits)).value_or(scale);
}

double middle_of(const Window& window, double tolerance) {
  const double middle = rounded(std::sqrt(window.lower * window.upper), tolerance);
  return std::clamp(middle, window.lower, window.upper);
}

/// The search as it goes on.
class Search {
public:
  Search(const SearchRange& range, const std::function<Failing(double)>& judge)
      : range_(range), judge_(judge) {}

  Looks run() {
    look_at_grid();
    for (;;) {
      refine(may_hold_edge);
      if (look_at_middle()) continue; // it may fail, and split the window
      if (!windows_of(looks_).empty()) break;
      refine(differ);
      if (windows_of(looks_).empty()) break;
    }
    return std::move(looks_);
  }

private:
  void look_at_grid() {
    const double cells = static_cast<double>(range_.points - 1);
    for (long k = 0; k < range_.points - 1; ++k)
      look(k == 0 ? range_.lower
                  : rounded(range_.lower * std::pow(range_.upper / range_.lower,
                                                    static_cast<double>(k) / cells),
                            range_.tolerance));
    look(range_.upper);
    if (range_.lower < 1 && 1 < range_.upper) look(1);
  }

  void look(double scale) {
    if (!looks_.contains(scale)) looks_[scale] = judge_(scale);
  }

  /// Halves the wide cells that `wanted` names until there are none.
  void refine(const Cell& wanted) {
    for (auto a = looks_.begin(); std::next(a) != looks_.end();) {
      const auto b = std::next(a);
      const bool wide = b->first > a->first * (1 + range_.tolerance);
      const double middle = rounded(std::sqrt(a->first * b->first), range_.tolerance);
      if (wide && wanted(a->second, b->second) && a->first < middle && middle < b->first)
        look(middle); // and this cell again, which is smaller now
      else
        ++a;
    }
  }

  /// @return whether it was not looked at before
  bool look_at_middle() {
    const auto windows = windows_of(looks_);
    if (windows.empty()) return false;
    const std::size_t before = looks_.size();
    look(middle_of(*widest(windows), range_.tolerance));
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

std::optional<double> recommended(const Looks& looks, double tolerance) {
  const auto windows = windows_of(looks);
  if (windows.empty()) return std::nullopt;
  return middle_of(*widest(windows), tolerance);
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
