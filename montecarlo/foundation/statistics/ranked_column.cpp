#include "montecarlo/foundation/statistics/ranked_column.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <boost/sort/pdqsort/pdqsort.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace wingspread {
namespace {

/// A value and its row.
struct Placed {
  double value;
  std::uint32_t row;
};

} // namespace

RankedColumn::RankedColumn(const Spilled<double>& values) : values_(&values) {
  assert(values.size() < std::size_t{1} << 31);
  std::vector<Placed> sorted;
  sorted.reserve(values.size());
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) sorted.push_back({values[row], static_cast<std::uint32_t>(row)});
  values.release();
  complete_ = sorted.size() == values.size();
  boost::sort::pdqsort_branchless(
      sorted.begin(), sorted.end(),
      [](const Placed& a, const Placed& b) { return a.value < b.value; });
  std::vector<std::uint32_t> doubled(values.size(), 0);
  for (std::size_t first = 0, end = 0; first < sorted.size(); first = end) {
    while (end < sorted.size() && sorted[end].value == sorted[first].value) ++end;
    // The tied values take up the ranks first + 1 … end, and share their mean.
    for (std::size_t i = first; i < end; ++i)
      doubled[sorted[i].row] = static_cast<std::uint32_t>(first + 1 + end);
  }
  doubled_ranks_ = doubled;
}

std::vector<double> RankedColumn::ranks() const {
  std::vector<double> ranks;
  ranks.reserve(doubled_ranks_.size());
  for (const std::uint32_t doubled : doubled_ranks_) ranks.push_back(doubled / 2.0);
  doubled_ranks_.release();
  return ranks;
}

std::vector<double> RankedColumn::ranks_where(const std::vector<bool>& keep) const {
  // of_rank first counts the kept values of each rank, and then gets their new doubled rank. Different mid-ranks are at
  // least 1 apart, so that their whole parts differ too.
  std::vector<std::uint32_t> of_rank(doubled_ranks_.size() + 1, 0);
  for (std::size_t row = 0; row < keep.size(); ++row)
    if (keep[row]) ++of_rank[doubled_ranks_[row] / 2];
  std::uint32_t below = 0;
  for (std::uint32_t& each : of_rank) {
    const std::uint32_t tied = each;
    each = 2 * below + 1 + tied;
    below += tied;
  }
  std::vector<double> ranks;
  ranks.reserve(below);
  for (std::size_t row = 0; row < keep.size(); ++row)
    if (keep[row]) ranks.push_back(of_rank[doubled_ranks_[row] / 2] / 2.0);
  doubled_ranks_.release();
  return ranks;
}

std::vector<RankedColumn> rank_columns(std::span<const Spilled<double>* const> columns,
                                       int threads) {
  std::vector<std::optional<RankedColumn>> ranked(columns.size());
  const std::size_t rows = columns.empty() ? 0 : columns.front()->size();
  const std::size_t bytes = 44 * rows; // 36 of vectors
  const double operations = sorting_operations(rows) * static_cast<double>(columns.size());
  for_each_task(threads_within_memory(threads_worth(threads, operations), bytes), columns.size(),
                [&](std::size_t i) { ranked[i].emplace(*columns[i]); });
  std::vector<RankedColumn> result;
  for (auto& column : ranked) result.push_back(std::move(*column));
  return result;
}

} // namespace wingspread
