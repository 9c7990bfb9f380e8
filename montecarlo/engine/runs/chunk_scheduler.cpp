#include "montecarlo/engine/runs/chunk_scheduler.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace wingspread {
namespace {

/// Most runs in a chunk. Heuristic: with 32 runs of some 50 µs the queue's lock costs below 0.1 %, and an
/// interruption loses at most a few ms of work per thread. Smaller chunks cost lock traffic, larger ones lost work.
constexpr long most_in_chunk = 32;

/// Most chunks begun beyond the last one delivered. Heuristic: 1024 chunks are some 30,000 rows, tens of MB; above 128
/// threads, eight chunks per thread. With a smaller number one long run stalls the other threads.
long most_ahead(int threads) { return std::max(1024L, 8L * threads); }

/// One thread's chunks: the one from which runs are issued, and those whose last runs are still under way.
class OpenChunks {
public:
  OpenChunks(ChunkQueue& queue, bool wants_csv) : queue_(queue), wants_csv_(wants_csv) {}

  [[nodiscard]] std::optional<long> next() {
    if (queue_.stopped()) return std::nullopt;
    if (open_ == nullptr || open_->issued == open_->chunk.runs.size()) {
      const std::optional<Chunk> claimed = queue_.claim();
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

  /// Delivers the issued runs of each unfinished chunk. @pre all issued runs have ended
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
    queue_.finish(chunk.chunk, std::move(chunk.batch), complete);
  }

  ChunkQueue& queue_;
  bool wants_csv_;
  std::map<long, Open> chunks_; ///< by chunk number
  Open* open_ = nullptr;
};

} // namespace

Occupancy make_chunks(const RunPlan& plan, const ThreadPool& pool, bool wants_csv,
                      ChunkQueue& queue) {
  std::mutex adding;
  Occupancy all{};
  const auto work = [&] {
    Runner runner(plan);
    OpenChunks chunks(queue, wants_csv);
    const auto next = [&] { return chunks.next(); };
    const auto keep = [&](ResultRow&& row) { chunks.take(std::move(row)); };
    Occupancy full{};
    do full += runner.run_all(pool.set, next, keep);
    while (queue.wait_for_more());
    chunks.close();
    const std::lock_guard lock(adding);
    all += full;
  };
  run_on_threads(thread_count(pool.threads), work, [&] { queue.break_off(); });
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

// Sleeps while the next chunk is too far ahead of the oldest unfinished one (InOrder::may_begin).
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
