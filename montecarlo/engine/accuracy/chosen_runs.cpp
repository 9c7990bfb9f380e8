#include "montecarlo/engine/accuracy/chosen_runs.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

using Rows = std::vector<std::size_t>;
using Quantity = OutputColumn::Quantity;

/// Keeps the `most` rows with the smallest keys; ties go to the first row.
class Least {
public:
  explicit Least(std::size_t most) : most_(most) {}

  /// @param key NaN: the row is ignored
  void offer(double key, std::size_t row) {
    if (std::isnan(key)) return;
    if (heap_.size() == most_ && !(std::pair(key, row) < heap_.front())) return;
    heap_.emplace_back(key, row);
    std::ranges::push_heap(heap_);
    if (heap_.size() <= most_) return;
    std::ranges::pop_heap(heap_);
    heap_.pop_back();
  }

  /// The row with the smallest key first.
  [[nodiscard]] Rows rows() && {
    std::ranges::sort_heap(heap_);
    Rows rows;
    for (const auto& [key, row] : heap_) rows.push_back(row);
    return rows;
  }

private:
  std::size_t most_;
  std::vector<std::pair<double, std::size_t>> heap_; ///< largest key in front
};

/// The first element of each list, then the second of each, and so on.
Rows interleaved(const std::vector<Rows>& lists) {
  Rows all;
  std::size_t longest = 0;
  for (const Rows& list : lists) longest = std::max(longest, list.size());
  for (std::size_t rank = 0; rank < longest; ++rank)
    for (const Rows& list : lists)
      if (rank < list.size()) all.push_back(list[rank]);
  return all;
}

/// The rows that may be chosen, and the six lists of chosen_runs.hpp, each with its preferred row first.
class Candidates {
public:
  Candidates(const Campaign& campaign, const Results& results, std::size_t count)
      : campaign_(campaign), results_(results), count_(count),
        columns_(output_columns(campaign.scene, campaign.outputs)) {
    for (const Status status : results.status)
      usable_.push_back(status != Status::invalid && status != Status::failed);
  }

  [[nodiscard]] std::vector<Rows> lists() const {
    return {by_status(), by_order(), near_limits(), on_edges(), extremes(), evenly_spaced()};
  }

private:
  /// Calls take(row) for every row that may be chosen, and releases the columns already read.
  template <class Take> void for_each_row(const Take& take) const {
    constexpr std::size_t window = 1 << 16;
    for (std::size_t first = 0; first < usable_.size(); first += window) {
      const std::size_t last = std::min(first + window, usable_.size());
      for (std::size_t row = first; row < last; ++row)
        if (usable_[row]) take(row);
      for (const Column& column : results_.outputs) column.values.release(first, last);
      results_.status.release(first, last);
      results_.latch_order.codes().release(first, last);
    }
  }

  /// The `count_` rows with the smallest keys. @param key returns a row's key; a row with NaN is ignored
  template <class Key> [[nodiscard]] Rows least(const Key& key) const {
    Least least(count_);
    for_each_row([&](std::size_t row) { least.offer(key(row), row); });
    return std::move(least).rows();
  }

  /// The first row of each kind, then the second of each, and so on.
  /// @param kind returns a row's kind, 0 ≤ kind < kinds
  template <class Kind>
  [[nodiscard]] Rows first_of_each(std::size_t kinds, const Kind& kind) const {
    std::vector<Rows> lists(kinds);
    for_each_row([&](std::size_t row) {
      if (Rows& list = lists[kind(row)]; list.size() < count_) list.push_back(row);
    });
    return interleaved(lists);
  }

  [[nodiscard]] Rows by_status() const {
    return first_of_each(3, [&](std::size_t row) {
      const Status status = results_.status[row];
      return status == Status::deployed ? 0U : status == Status::stalled ? 1U : 2U;
    });
  }

  [[nodiscard]] Rows by_order() const {
    const auto& codes = results_.latch_order.codes();
    const std::size_t kinds = results_.latch_order.texts().size();
    std::vector<std::pair<long, std::uint32_t>> counts(kinds);
    for (std::uint32_t code = 0; code < kinds; ++code) counts[code].second = code;
    // Counts are negative, so that the most frequent order comes first.
    for_each_row([&](std::size_t row) { --counts[codes[row]].first; });
    std::ranges::sort(counts);
    std::vector<std::size_t> place(kinds, count_); // orders not listed share the last kind
    const std::size_t listed = std::min(kinds, count_);
    for (std::size_t i = 0; i < listed; ++i) place[counts[i].second] = i;
    return first_of_each(listed + 1,
                         [&](std::size_t row) { return std::min(place[codes[row]], listed); });
  }

  [[nodiscard]] const Column* column_named(const std::string& name) const {
    const auto found = std::ranges::find(results_.outputs, name, &Column::name);
    return found == results_.outputs.end() ? nullptr : &*found;
  }

  [[nodiscard]] Rows near_limits() const {
    std::vector<Rows> lists;
    for (const Requirement& requirement : campaign_.requirements) {
      const Column* column = column_named(requirement.output);
      const std::optional<double> limit = requirement.max ? requirement.max : requirement.min;
      if (!column || !limit) continue;
      lists.push_back(least([&](std::size_t row) {
        const double value = column->values[row];
        return std::abs((requirement.absolute ? std::abs(value) : value) - *limit);
      }));
    }
    return interleaved(lists);
  }

  /// The result columns of a quantity.
  [[nodiscard]] std::vector<const Column*> columns_of(Quantity quantity) const {
    std::vector<const Column*> found;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].quantity == quantity) found.push_back(&results_.outputs[i]);
    return found;
  }

  [[nodiscard]] Rows on_edges() const {
    const auto times = columns_of(Quantity::latch_time), rates = columns_of(Quantity::latch_rate);
    const auto ends = columns_of(Quantity::deployment_time);
    const auto gap = [&](std::size_t row) {
      std::vector<double> sorted;
      for (const Column* column : times)
        if (const double time = column->values[row]; !std::isnan(time)) sorted.push_back(time);
      std::ranges::sort(sorted);
      double least = undefined;
      for (std::size_t i = 1; i < sorted.size(); ++i)
        least = std::fmin(least, sorted[i] - sorted[i - 1]);
      return least;
    };
    const auto slowest = [&](std::size_t row) {
      double least = undefined;
      for (const Column* column : rates) least = std::fmin(least, std::abs(column->values[row]));
      return least;
    };
    const auto latest = [&](std::size_t row) {
      return ends.empty() ? undefined : -ends.front()->values[row];
    };
    return interleaved({least(gap), least(slowest), least(latest)});
  }

  /// Shift and scale of a column: (x − shift) · scale has mean 0 and standard deviation 1.
  struct Scaled {
    const Column* column;
    double shift, scale;
  };

  [[nodiscard]] Scaled scaled(const Column& column) const {
    Sum sum, squares;
    long count = 0;
    const auto each = [&](const auto& add) {
      for_each_row([&](std::size_t row) {
        if (!std::isnan(column.values[row])) add(column.values[row]);
      });
    };
    each([&](double value) { sum.add(value), ++count; });
    const double mean = sum.value() / static_cast<double>(count);
    each([&](double value) { squares.add((value - mean) * (value - mean)); });
    const double std = std::sqrt(squares.value() / static_cast<double>(count));
    return {&column, mean, std > 0 ? 1 / std : undefined};
  }

  [[nodiscard]] Rows extremes() const {
    std::vector<Scaled> columns;
    for (const Column& column : results_.outputs)
      if (is_peak(column.name)) columns.push_back(scaled(column));
    const bool peaks = !columns.empty();
    if (!peaks)
      for (const Column& column : results_.outputs) columns.push_back(scaled(column));
    return least([&](std::size_t row) {
      double largest = undefined;
      for (const auto& [column, shift, scale] : columns) {
        const double z = (column->values[row] - shift) * scale;
        largest = std::fmax(largest, peaks ? z : std::abs(z));
      }
      return -largest;
    });
  }

  [[nodiscard]] Rows evenly_spaced() const {
    const std::size_t rows = usable_.size();
    Rows spaced;
    for (std::size_t i = 0; i < std::min(count_, rows); ++i)
      if (const std::size_t row = (2 * i + 1) * rows / (2 * std::min(count_, rows)); usable_[row])
        spaced.push_back(row);
    return spaced;
  }

  const Campaign& campaign_;
  const Results& results_;
  std::size_t count_;
  std::vector<OutputColumn> columns_;
  std::vector<bool> usable_;
};

} // namespace

std::vector<std::size_t> chosen_rows(const Campaign& campaign, const Results& results,
                                     std::size_t count) {
  const std::vector<Rows> lists = Candidates(campaign, results, count).lists();
  std::vector<std::size_t> next(lists.size(), 0);
  Rows chosen;
  const auto is_new = [&](std::size_t row) {
    return std::ranges::find(chosen, row) == chosen.end();
  };
  for (bool any = true; any && chosen.size() < count;) {
    any = false;
    for (std::size_t i = 0; i < lists.size() && chosen.size() < count; ++i) {
      while (next[i] < lists[i].size() && !is_new(lists[i][next[i]])) ++next[i];
      if (next[i] == lists[i].size()) continue;
      chosen.push_back(lists[i][next[i]++]);
      any = true;
    }
  }
  std::ranges::sort(chosen);
  return chosen;
}

} // namespace wingspread
