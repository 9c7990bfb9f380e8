/// A team of threads that makes runs chunk by chunk, wherever the chunks come from and go to.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/in_order.hpp"

#include <mutex>
#include <optional>

namespace wingspread {

/// Consecutive runs that one thread makes, and their number among the chunks of a range.
struct Chunk {
  long number = 0;
  RunRange runs{};
};

/// Where threads get their chunks, and where they leave them. Called on any thread.
class ChunkQueue {
public:
  ChunkQueue() = default;
  ChunkQueue(const ChunkQueue&) = delete;
  ChunkQueue& operator=(const ChunkQueue&) = delete;
  virtual ~ChunkQueue() = default;

  /// The next chunk to be made; none when there is none now.
  [[nodiscard]] virtual std::optional<Chunk> claim() = 0;
  /// Waits until there may be one again. @return false when there will be none any more
  [[nodiscard]] virtual bool wait_for_more() = 0;
  /// Whether no further run is to be begun.
  [[nodiscard]] virtual bool stopped() const = 0;
  /// @param complete false when it was broken off, for it was stopped
  virtual void finish(const Chunk& chunk, Batch&& batch, bool complete) = 0;
  /// An exception has left a thread: no further run is to be begun.
  virtual void break_off() = 0;
};

/// Makes the desk's chunks until there will be none any more. Threads fill their lanes from one chunk after the other
/// without a pause. @return how full the lanes were
/// @throws what a run does (out of memory), and what the desk throws
Occupancy make_chunks(const RunPlan& plan, const ThreadPool& pool, bool wants_csv,
                      ChunkQueue& desk);

/// The chunks of a range, claimed in order and handed on in order. Large ones at first, and the fewer runs are left,
/// the smaller (guided self-scheduling, Polychronopoulos & Kuck, IEEE Trans. Comput. 36 (1987) 1425), so that all
/// finish together.
class RangeQueue final : public ChunkQueue {
public:
  /// @param threads that claim chunks, whosever they are
  /// @param stop    once true, no further run is begun
  RangeQueue(RunRange range, int threads, const BatchSink& sink, const std::atomic<bool>& stop);

  [[nodiscard]] std::optional<Chunk> claim() override;
  [[nodiscard]] bool wait_for_more() override;
  [[nodiscard]] bool stopped() const override { return stop_.load() || broken_.load(); }
  /// @throws what the sink throws
  void finish(const Chunk& chunk, Batch&& batch, bool complete) override {
    in_order_.finish(chunk.number, std::move(batch), complete);
  }
  void break_off() override { broken_ = true; }

  /// Whether all chunks were claimed.
  [[nodiscard]] bool is_exhausted() const;
  /// Runs handed on. @pre all threads are done
  [[nodiscard]] long done() const { return in_order_.done(); }

private:
  const int threads_;
  const std::atomic<bool>& stop_;
  InOrder in_order_;
  std::atomic<bool> broken_ = false;
  mutable std::mutex claiming_;
  Chunk next_; ///< its number, and the runs that are left; guarded by claiming_
};

} // namespace wingspread
