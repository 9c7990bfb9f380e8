#include "montecarlo/report/data/order_split.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace wingspread {
namespace {

/// The bin of a value: the last one is closed (histogram.hpp). @pre it lies within the edges
std::size_t bin_of(const Histogram& histogram, double value) {
  const auto inner =
      std::upper_bound(histogram.edges.begin() + 1, histogram.edges.end() - 1, value);
  return static_cast<std::size_t>(inner - histogram.edges.begin() - 1);
}

constexpr const char* separators = "_-. "; // between the parts of a name

/// What all names begin with, without separators at its end.
std::string common_beginning(const std::vector<std::string>& names) {
  std::string common = names.front();
  for (const std::string& name : names)
    common.resize(
        static_cast<std::size_t>(std::ranges::mismatch(common, name).in1 - common.begin()));
  common.resize(common.find_last_not_of(separators) + 1);
  return common;
}

/// Index of the hinge on the base to whose wing a hinge belongs.
std::size_t root_of(const Scene& scene, std::size_t hinge) {
  while (scene.hinges[hinge].parent != base_index)
    hinge = static_cast<std::size_t>(
        std::ranges::find(scene.hinges, scene.hinges[hinge].parent, &Hinge::child) -
        scene.hinges.begin());
  return hinge;
}

/// The wings with their hinges; none of them has orders yet.
std::vector<WingOrders> wings_of(const Scene& scene) {
  std::map<std::size_t, WingOrders> by_root;
  for (std::size_t hinge = 0; hinge < scene.hinges.size(); ++hinge)
    by_root[root_of(scene, hinge)].hinges.push_back(scene.hinges[hinge].name);
  std::vector<WingOrders> wings;
  for (auto& [root, wing] : by_root) {
    wing.name = wing.hinges.size() > 1 ? common_beginning(wing.hinges) : "";
    if (wing.name.empty()) wing.name = scene.hinges[root].name;
    wings.push_back(std::move(wing));
  }
  return wings;
}

/// The hinges of an order.
std::vector<std::string> split(std::string_view order) {
  std::vector<std::string> hinges;
  while (!order.empty()) {
    hinges.emplace_back(order.substr(0, order.find('>')));
    order.remove_prefix(std::min(order.size(), hinges.back().size() + 1));
  }
  return hinges;
}

/// The part of an order that concerns these hinges.
std::string part_of(std::string_view order, const std::vector<std::string>& hinges) {
  std::string part;
  for (const std::string& hinge : split(order))
    if (std::ranges::find(hinges, hinge) != hinges.end()) part += (part.empty() ? "" : ">") + hinge;
  return part;
}

/// An order of a wing's hinges without the wing's name in theirs.
std::string without_name(std::string_view order, const WingOrders& wing) {
  std::string text;
  for (const std::string& hinge : split(order)) {
    std::string_view rest = hinge;
    if (wing.hinges.size() > 1 && rest.starts_with(wing.name)) rest.remove_prefix(wing.name.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(separators), rest.size()));
    text += (text.empty() ? "" : ">") + (rest.empty() ? hinge : std::string(rest));
  }
  return text;
}

/// The orders of all wings, "left: root>tip · right: none"; empty if no hinge latched.
std::string by_wing(std::string_view order, const std::vector<WingOrders>& wings) {
  std::string all;
  for (const WingOrders& wing : wings) {
    if (order.empty()) break;
    std::string part = part_of(order, wing.hinges);
    if (!all.empty()) all += " · ";
    all += wing.name + ": " + (part.empty() ? "none" : without_name(part, wing));
  }
  return all;
}

} // namespace

OrderSplit::OrderSplit(const Results& results, const Summary& summary, const Scene& scene)
    : results_(&results) {
  const std::vector<WingOrders> wings = wings_of(scene);
  const TextColumn& texts = results.latch_order.texts();
  std::vector<std::string> names;
  for (std::size_t code = 0; code < texts.size(); ++code)
    names.push_back(wings.size() > 1 ? by_wing(texts[code], wings) : std::string(texts[code]));
  std::map<std::string, long> counts;
  for (const std::uint32_t code : results.latch_order.codes()) ++counts[names[code]];
  counts.erase("");
  kinds_ = std::ssize(counts);
  for (const auto& [name, count] : counts) groups_.push_back({name, count});
  std::ranges::stable_sort(groups_, std::ranges::greater{}, &Group::count);
  const std::size_t named = std::min(groups_.size(), most_orders);
  long beyond = 0;
  for (std::size_t i = named; i < groups_.size(); ++i) beyond += groups_[i].count;
  groups_.resize(named);
  const std::size_t of_others = groups_.size();
  if (beyond > 0) groups_.push_back({std::string(others), beyond});
  const std::size_t of_none = groups_.size();
  if (summary.without_latch > 0) groups_.push_back({std::string(no_latch), summary.without_latch});
  for (const std::string& name : names) {
    const auto found =
        std::ranges::find(groups_.begin(), groups_.begin() + named, name, &Group::name);
    const auto place = static_cast<std::size_t>(found - groups_.begin());
    of_code_.push_back(name.empty() ? of_none : place < named ? place : of_others);
  }
}

std::vector<WingOrders> wing_orders(const Results& results, const Scene& scene) {
  std::vector<WingOrders> wings = wings_of(scene);
  if (wings.size() < 2) return {};
  const TextColumn& texts = results.latch_order.texts();
  std::vector<long> runs(texts.size(), 0);
  for (const std::uint32_t code : results.latch_order.codes()) ++runs[code];
  for (WingOrders& wing : wings) {
    std::map<std::string, long> counts;
    for (std::size_t code = 0; code < texts.size(); ++code)
      counts[part_of(texts[code], wing.hinges)] += runs[code];
    wing.without = counts[""];
    counts.erase("");
    for (const auto& [order, count] : counts) wing.orders.push_back({order, count});
    std::ranges::stable_sort(wing.orders, std::ranges::greater{}, &OrderSplit::Group::count);
  }
  return wings;
}

std::vector<std::vector<long>> OrderSplit::counts(const Histogram& histogram,
                                                  const Spilled<double>& values) const {
  std::vector<std::vector<long>> counts(groups_.size(),
                                        std::vector<long>(histogram.counts.size(), 0));
  if (histogram.counts.empty()) return counts;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) ++counts[of_row(row)][bin_of(histogram, values[row])];
  return counts;
}

} // namespace wingspread
