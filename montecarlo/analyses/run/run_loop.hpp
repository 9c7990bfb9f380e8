/// The run loop: makes the runs that are missing, batch by batch, until none is left or the caller stops it.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <functional>

namespace wingspread {

/// Counts rows by their status into the counts.
void count_rows(const Batch& batch, RunCounts& counts);

/// Collects rows in memory, with the functions of FolderWriter that make_runs calls.
class RowsInMemory {
public:
  static constexpr bool wants_csv = false;

  /// @pre `stored` has no shard and outlives this object
  RowsInMemory(const StoredCampaign& stored, const ResultNames& names)
      : stored_(stored), results_(names) {}

  /// The next runs to make, as FolderWriter::remaining.
  [[nodiscard]] RunRange remaining() const;
  void add(const Batch& batch);
  [[nodiscard]] Results take() && { return std::move(results_); }

private:
  const StoredCampaign& stored_;
  Results results_;
};

/// Makes the runs that `rows` still lacks. If the campaign may stop early, `rows.remaining()` ends at the next interim
/// analysis; it is called again after these runs.
/// @param rows  FolderWriter, StreamingFolder or RowsInMemory
/// @param counts counts of the runs that `rows` has already; updated with every batch
/// @param show  called with the counts after every batch, one call at a time
/// @return whether the evaluator was stopped before the last run
template <class Rows, class Show>
bool make_runs(Rows& rows, const RunPlan& plan, Evaluator& evaluator, RunCounts& counts,
               const Show& show) {
  const auto keep = [&](const Batch& batch) {
    rows.add(batch);
    count_rows(batch, counts);
    show(counts);
  };
  for (RunRange next = rows.remaining(); next.size() > 0; next = rows.remaining())
    if (evaluator.make(plan, next, {keep, Rows::wants_csv}) < next.size()) return true;
  return false;
}

} // namespace wingspread
