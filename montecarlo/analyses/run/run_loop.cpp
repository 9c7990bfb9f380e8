#include "montecarlo/analyses/run/run_loop.hpp"

#include <algorithm>

namespace wingspread {

void count_rows(const Batch& batch, RunCounts& tally) {
  const auto count = [&](Status status) {
    return std::ranges::count(batch.rows, status, &ResultRow::status);
  };
  tally.done += std::ssize(batch.rows);
  tally.invalid += count(Status::invalid);
  tally.failed += count(Status::failed);
  tally.stalled += count(Status::stalled);
  tally.timed_out += count(Status::timed_out);
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
