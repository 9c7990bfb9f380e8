#include "montecarlo/analyses/run/run_loop.hpp"

#include <algorithm>

namespace wingspread {

void count_rows(const Batch& batch, RunCounts& counts) {
  const auto count = [&](Status status) {
    return std::ranges::count(batch.rows, status, &ResultRow::status);
  };
  counts.done += std::ssize(batch.rows);
  counts.invalid += count(Status::invalid);
  counts.failed += count(Status::failed);
  counts.stalled += count(Status::stalled);
  counts.timed_out += count(Status::timed_out);
}

RunRange RowsInMemory::remaining() const {
  const RunRange runs = stored_.runs();
  const long done = std::ssize(results_.runs);
  if (is_complete(stored_, results_)) return {done, done};
  return {done,
          stored_.campaign.until.empty() ? runs.last : next_interim_analysis(done, runs.size())};
}

void RowsInMemory::add(const Batch& batch) {
  for (const ResultRow& row : batch.rows) results_.append(row);
}

} // namespace wingspread
