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

/// What all names begin with, without separators at its end.
std::string common_beginning(const std::vector<std::string>& names) {
  std::string common = names.front();
  for (const std::string& name : names)
    common.resize(
        static_cast<std::size_t>(std::ranges::mismatch(common, name).in1 - common.begin()));
  common.resize(common.find_last_not_of("_-. ") + 1);
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

/// The part of an order that concerns these hinges.
std::string part_of(std::string_view order, const std::vector<std::string>& hinges) {
  std::string part;
  while (!order.empty()) {
    const std::string_view hinge = order.substr(0, order.find('>'));
    order.remove_prefix(std::min(order.size(), hinge.size() + 1));
    if (std::ranges::find(hinges, hinge) == hinges.end()) continue;
    if (!part.empty()) part += '>';
    part += hinge;
  }
  return part;
}

} // namespace

OrderSplit::OrderSplit(const Results& results, const Summary& summary) : results_(&results) {
  const std::size_t named = std::min(summary.latch_orders.size(), most_orders);
  long beyond = summary.runs - summary.without_latch;
  for (std::size_t i = 0; i < named; ++i) {
    groups_.push_back({summary.latch_orders[i].order, summary.latch_orders[i].count});
    beyond -= summary.latch_orders[i].count;
  }
  const std::size_t of_others = groups_.size();
  if (beyond > 0) groups_.push_back({std::string(others), beyond});
  const std::size_t of_none = groups_.size();
  if (summary.without_latch > 0) groups_.push_back({std::string(no_latch), summary.without_latch});
  const TextColumn& texts = results.latch_order.texts();
  for (std::size_t code = 0; code < texts.size(); ++code) {
    const auto found =
        std::ranges::find(groups_.begin(), groups_.begin() + named, texts[code], &Group::name);
    const auto place = static_cast<std::size_t>(found - groups_.begin());
    of_code_.push_back(texts[code].empty() ? of_none : place < named ? place : of_others);
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
