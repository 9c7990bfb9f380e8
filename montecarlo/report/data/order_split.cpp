#include "montecarlo/report/data/order_split.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
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

/// Whether a character of UTF-8 goes on at this place.
bool goes_on(std::string_view text, std::size_t place) {
  return place < text.size() && (static_cast<unsigned char>(text[place]) & 0xC0U) == 0x80U;
}

/// The common beginning of all names, in whole characters, without separators at its end.
std::string common_beginning(const std::vector<std::string>& names) {
  std::string common = names.front();
  for (const std::string& name : names) {
    auto same = static_cast<std::size_t>(std::ranges::mismatch(common, name).in1 - common.begin());
    while (same > 0 && (goes_on(name, same) || goes_on(common, same))) --same;
    common.resize(same);
  }
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

/// An order of a wing's hinges, without the wing's name at the beginning of theirs.
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

/// The name of an order's group: by wing if there are several.
std::string name_of(std::string_view order, const std::vector<WingOrders>& wings) {
  return wings.size() > 1 ? by_wing(order, wings) : std::string(order);
}

} // namespace

OrderCounts order_counts(const Results& results) {
  const TextColumn& texts = results.latch_order.texts();
  std::vector<long> runs(texts.size(), 0);
  for (const std::uint32_t code : results.latch_order.codes()) ++runs[code];
  OrderCounts counts;
  for (std::size_t code = 0; code < texts.size(); ++code)
    if (runs[code] > 0) counts[std::string(texts[code])] = runs[code];
  return counts;
}

OrderSplit::OrderSplit(const OrderCounts& orders, long more, const Scene& scene) {
  const std::vector<WingOrders> wings = wings_of(scene);
  OrderCounts counts;
  for (const auto& [order, count] : orders) counts[name_of(order, wings)] += count;
  const long without = counts[""];
  counts.erase("");
  kinds_ = std::ssize(counts);
  for (const auto& [name, count] : counts) groups_.push_back({name, count});
  std::ranges::stable_sort(groups_, std::ranges::greater{}, &Group::count);
  named_ = std::min(groups_.size(), most_orders);
  for (std::size_t i = named_; i < groups_.size(); ++i) more += groups_[i].count;
  groups_.resize(named_);
  if (more > 0) groups_.push_back({std::string(others), more});
  if (without > 0) groups_.push_back({std::string(no_latch), without});
}

OrderSplit::OrderSplit(const Results& results, const Scene& scene)
    : OrderSplit(order_counts(results), 0, scene) {
  results_ = &results;
  const std::vector<WingOrders> wings = wings_of(scene);
  const TextColumn& texts = results.latch_order.texts();
  for (std::size_t code = 0; code < texts.size(); ++code) {
    const std::string name = name_of(texts[code], wings);
    const auto last = groups_.begin() + static_cast<std::ptrdiff_t>(named_);
    const auto found = std::ranges::find(groups_.begin(), last, name, &Group::name);
    of_code_.push_back(name.empty() ? groups_.size() - 1
                                    : static_cast<std::size_t>(found - groups_.begin()));
  }
}

std::vector<WingOrders> wing_orders(const OrderCounts& orders, const Scene& scene) {
  std::vector<WingOrders> wings = wings_of(scene);
  if (wings.size() < 2) return {};
  for (WingOrders& wing : wings) {
    OrderCounts counts;
    for (const auto& [order, count] : orders) counts[part_of(order, wing.hinges)] += count;
    wing.without = counts[""];
    counts.erase("");
    for (const auto& [order, count] : counts) wing.orders.push_back({order, count});
    std::ranges::stable_sort(wing.orders, std::ranges::greater{}, &OrderSplit::Group::count);
  }
  return wings;
}

std::vector<LatchGap> latch_gaps(const Results& results, const std::vector<std::string>& hinges,
                                 std::string_view order) {
  const std::vector<std::string> latched = split(order);
  std::vector<const Column*> times;
  for (const std::string& hinge : latched) {
    const auto found = std::ranges::find(results.outputs, hinge + ".latch_time", &Column::name);
    if (found == results.outputs.end()) return {};
    times.push_back(&*found);
  }
  const TextColumn& texts = results.latch_order.texts();
  std::vector<bool> counts(texts.size());
  for (std::size_t code = 0; code < texts.size(); ++code)
    counts[code] = part_of(texts[code], hinges) == order;
  std::vector<LatchGap> gaps;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    std::vector<double> between;
    for (std::size_t row = 0; row < results.size(); ++row)
      if (counts[results.latch_order.codes()[row]])
        between.push_back(times[k + 1]->values[row] - times[k]->values[row]);
    const std::vector<double> sorted = sorted_present(between);
    if (sorted.empty()) return {};
    gaps.push_back({latched[k], latched[k + 1], sorted.front(), quantile(sorted, 0.5)});
  }
  return gaps;
}

std::vector<std::vector<long>> OrderSplit::counts(const Histogram& histogram,
                                                  const Spilled<double>& values) const {
  if (!results_) return {};
  std::vector<std::vector<long>> counts(groups_.size(),
                                        std::vector<long>(histogram.counts.size(), 0));
  if (histogram.counts.empty()) return counts;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) ++counts[of_row(row)][bin_of(histogram, values[row])];
  return counts;
}

} // namespace wingspread
