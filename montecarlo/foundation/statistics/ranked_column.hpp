/// Columns of numbers with their ranks, shared by rank statistics.
#pragma once

#include "montecarlo/foundation/platform/spilled.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace wingspread {

/// A column and its ranks. Keeps a reference to the values. NaN marks missing values.
class RankedColumn {
public:
  /// Cost O(n log n). @pre fewer than 2³¹ values
  explicit RankedColumn(const Spilled<double>& values);
  explicit RankedColumn(Spilled<double>&&) = delete;

  [[nodiscard]] const Spilled<double>& values() const { return *values_; }
  /// Twice the mid-ranks from 1 of the present values (ties share their mean rank): whole numbers; 0 if missing.
  [[nodiscard]] const Spilled<std::uint32_t>& doubled_ranks() const { return doubled_ranks_; }
  [[nodiscard]] bool complete() const { return complete_; }
  /// Mid-ranks of all values. @pre complete()
  [[nodiscard]] std::vector<double> ranks() const;
  /// Mid-ranks of the kept values among each other, in the order of the values. Cost O(n).
  /// @pre no kept value is missing
  [[nodiscard]] std::vector<double> ranks_where(const std::vector<bool>& keep) const;

private:
  const Spilled<double>* values_;
  Spilled<std::uint32_t> doubled_ranks_;
  bool complete_ = true;
};

/// Ranks the columns, several at once. @param threads as of thread_count (thread_pool.hpp)
/// @pre the columns outlive the result
[[nodiscard]] std::vector<RankedColumn>
rank_columns(std::span<const Spilled<double>* const> columns, int threads = 1);

} // namespace wingspread
