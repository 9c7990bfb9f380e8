#include "montecarlo/report/data/order_split.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// The bin of a value: the last one is closed (histogram.hpp). @pre it lies within the edges
std::size_t bin_of(const Histogram& histogram, double value) {
  const auto inner =
      std::upper_bound(histogram.edges.begin() + 1, histogram.edges.end() - 1, value);
  return static_cast<std::size_t>(inner - histogram.edges.begin() - 1);
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
