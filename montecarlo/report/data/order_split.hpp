/// Groups runs by latch order, because separate modes of a histogram are usually different orders.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/statistics/histogram.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The number of runs with each latch order; "" for runs without a latch.
using OrderCounts = std::map<std::string, long>;
[[nodiscard]] OrderCounts order_counts(const Results& results);

/// The most frequent orders, then one group for the other orders, then one for runs without a latch.
///
/// In a scene of several wings an order is "left: root>tip · right: tip>root", wing by wing. If the order across wings
/// counted too, almost every run would have an order of its own.
class OrderSplit {
public:
  static constexpr std::size_t most_orders =
      6; ///< largest number of orders with a group of their own
  static constexpr std::string_view others = "others", no_latch = "no latch";

  /// @pre the results outlive this
  explicit OrderSplit(const Results& results, const Scene& scene = {});
  /// Groups without rows: of_row must not be called, and counts gives nothing.
  /// @param more runs with orders that are not among `orders`
  OrderSplit(const OrderCounts& orders, long more, const Scene& scene);

  struct Group {
    std::string name;
    long count = 0;
  };
  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
  /// Number of different orders.
  [[nodiscard]] long kinds() const { return kinds_; }
  /// The group of a row.
  [[nodiscard]] std::size_t of_row(std::size_t row) const {
    return of_code_[results_->latch_order.codes()[row]];
  }

  /// The counts of each group in each bin; they sum to the histogram's counts. Empty without rows.
  [[nodiscard]] std::vector<std::vector<long>> counts(const Histogram& histogram,
                                                      const Spilled<double>& values) const;

private:
  const Results* results_ = nullptr;
  std::vector<Group> groups_;
  std::size_t named_ = 0; ///< groups that are one order
  long kinds_ = 0;
  std::vector<std::size_t> of_code_; ///< group of each text of the column
};

/// The latch orders of the hinges of one wing.
struct WingOrders {
  std::string name; ///< what its hinges' names begin with, or the name of the hinge on the base
  std::vector<std::string> hinges;
  std::vector<OrderSplit::Group> orders; ///< all, the most frequent first, then by name
  long without = 0;                      ///< runs in which none of its hinges latched
};

/// The orders of each wing; none for a scene with less than two wings. The hinges of two wings latch in many orders
/// that differ only in how the wings' sequences interleave.
[[nodiscard]] std::vector<WingOrders> wing_orders(const OrderCounts& orders, const Scene& scene);

/// The time from one latch to the next of an order.
struct LatchGap {
  std::string before, after;    ///< hinges
  double least = 0, median = 0; ///< s
};

/// The gaps of an order, over the runs in which these hinges latched in this order, whatever others did.
/// @param hinges the hinges that count
/// @param order  "root>mid>tip" of such hinges
/// @return empty without a column of latch times for each
[[nodiscard]] std::vector<LatchGap>
latch_gaps(const Results& results, const std::vector<std::string>& hinges, std::string_view order);

} // namespace wingspread
