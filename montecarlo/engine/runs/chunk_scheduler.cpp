#include "montecarlo/engine/runs/chunk_scheduler.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace wingspread {
namespace {

/// Runs in a chunk at most: enough to make the counter and the lock free of charge, and few enough that an
/// interruption loses little.
constexpr long most_in_chunk = 32;

/// Chunks that may be begun beyond those handed on: some 30,000 runs, the rows of which take tens of MB. Of many
/// threads, a few for each.
long most_ahead(int threads) { return std::max(1024L, 8L * threads); }

/// One thread's chunks: the one that its runs come from, and those that wait for their last runs.
class OpenChunks {
public:
  OpenChunks(ChunkQueue& desk, bool wants_csv) : desk_(desk), wants_csv_(wants_csv) {}

  [[nodiscard]] std::optional<long> next() {
    if (desk_.stopped()) return std::nullopt;
    if (open_ == nullptr || open_->issued == open_->chunk.runs.size()) {
      const std::optional<Chunk> claimed = desk_.claim();
      if (!claimed) return std::nullopt;
      open_ = &chunks_[claimed->number];
      open_->chunk = *claimed;
      open_->batch.rows.resize(static_cast<std::size_t>(claimed->runs.size()));
    }
    return open_->chunk.runs.first + open_->issued++;
  }

  void take(ResultRow&& row) {
    const auto found = std::ranges::find_if(chunks_, [&](const auto& entry) {
      const RunRange& runs = entry.second.chunk.runs;
      return row.run >= runs.first && row.run < runs.last;
    });
    Open& chunk = found->second;
    const long place = row.run - chunk.chunk.runs.first;
    chunk.batch.rows[static_cast<std::size_t>(place)] = std::move(row);
    if (++chunk.made < chunk.chunk.runs.size()) return;
    if (open_ == &chunk) open_ = nullptr;
    const auto finished = chunks_.extract(found);
    hand_over(std::move(finished.mapped()), true);
  }

  /// All runs that were begun have ended. What was begun of a chunk is kept.
  void close() {
    for (auto& [number, chunk] : chunks_) {
      chunk.batch.rows.resize(static_cast<std::size_t>(chunk.issued));
      hand_over(std::move(chunk), false);
    }
    chunks_.clear();
  }

private:
  struct Open {
    Chunk chunk;
    Batch batch;
    long issued = 0, made = 0;
  };

  void hand_over(Open&& chunk, bool complete) {
    if (wants_csv_)
      for (const ResultRow& row : chunk.batch.rows) append_row(chunk.batch.csv, row);
    desk_.finish(chunk.chunk, std::move(chunk.batch), complete);
  }

  ChunkQueue& desk_;
  bool wants_csv_;
  std::map<long, Open> chunks_; ///< by number
  Open* open_ = nullptr;
};

} // namespace

Occupancy make_chunks(const RunPlan& plan, const ThreadPool& pool, bool wants_csv,
                      ChunkQueue& desk) {
  std::mutex adding;
  Occupancy all{};
  const auto work = [&] {
    Runner runner(plan);
    OpenChunks chunks(desk, wants_csv);
    const auto next = [&] { return chunks.next(); };
    const auto keep = [&](ResultRow&& row) { chunks.take(std::move(row)); };
    Occupancy full{};
    do full += runner.run_all(pool.set, next, keep);
    while (desk.wait_for_more());
    chunks.close();
    const std::lock_guard lock(adding);
    all += full;
  };
  run_on_threads(thread_count(pool.threads), work, [&] { desk.break_off(); });
  return all;
}

RangeQueue::RangeQueue(RunRange range, int threads, const BatchSink& sink,
                       const std::atomic<bool>& stop)
    : threads_(threads), stop_(stop), in_order_(sink, most_ahead(threads)), next_{0, range} {}

std::optional<Chunk> RangeQueue::claim() {
  const std::lock_guard lock(claiming_);
  if (stopped() || next_.runs.size() <= 0 || !in_order_.may_begin(next_.number))
    return std::nullopt;
  const long size = std::clamp(next_.runs.size() / (8L * threads_), 1L, most_in_chunk);
  const Chunk claimed{next_.number++, {next_.runs.first, next_.runs.first + size}};
  next_.runs.first = claimed.runs.last;
  return claimed;
}

// A thread that has run out of chunks because one run keeps the others waiting has a rest.
bool RangeQueue::wait_for_more() {
  long chunk = 0;
  {
    const std::lock_guard lock(claiming_);
    if (stopped() || next_.runs.size() <= 0) return false;
    chunk = next_.number;
  }
  in_order_.wait_for(chunk, [&] { return stopped(); });
  return true;
}

bool RangeQueue::is_exhausted() const {
  const std::lock_guard lock(claiming_);
  return next_.runs.size() <= 0;
}

} // namespace wingspread
