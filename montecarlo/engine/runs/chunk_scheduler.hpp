/// A scheduler for runs: threads claim chunks of runs from a queue and return them finished. RangeQueue serves the
/// threads of this process; under MPI every other rank has a queue that messages fill and empty.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/in_order.hpp"

#include <mutex>
#include <optional>

namespace wingspread {

/// Consecutive runs made by one thread.
struct Chunk {
  long number = 0; ///< 0, 1, … within a range of runs
  RunRange runs{};
};

/// A queue from which threads claim chunks, and to which they return finished ones. Any thread may call any function.
class ChunkQueue {
public:
  ChunkQueue() = default;
  ChunkQueue(const ChunkQueue&) = delete;
  ChunkQueue& operator=(const ChunkQueue&) = delete;
  virtual ~ChunkQueue() = default;

  /// The next chunk to make; nothing if none is available now.
  [[nodiscard]] virtual std::optional<Chunk> claim() = 0;
  /// Waits until claim() may succeed again. @return false if no more chunks will come
  [[nodiscard]] virtual bool wait_for_more() = 0;
  /// Whether no further run may begin.
  [[nodiscard]] virtual bool stopped() const = 0;
  /// Returns a finished chunk. @param complete false if a stop cut the chunk short
  virtual void finish(const Chunk& chunk, Batch&& batch, bool complete) = 0;
  /// From now on no further run may begin. Called when an exception has left a thread, or another rank has stopped.
  virtual void break_off() = 0;
};

/// Makes the queue's chunks until no more will come. Each thread integrates several runs at once, one per SIMD lane. A
/// free lane takes the next run, of the same chunk or of the next one.
/// @return how full the lanes were
/// @throws what a run throws (out of memory), and what the queue throws
Occupancy make_chunks(const RunPlan& plan, const ThreadPool& pool, bool wants_csv,
                      ChunkQueue& queue);

/// The chunks of a range, claimed and delivered in order. Chunks shrink as fewer runs are left, so that all threads
/// end together (guided self-scheduling, Polychronopoulos & Kuck, IEEE Trans. Comput. 36 (1987) 1425).
class RangeQueue final : public ChunkQueue {
public:
  /// @param threads number of threads that claim chunks, on all machines together
  /// @param stop    once true, no further run begins
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
  /// Runs delivered. @pre all threads have ended
  [[nodiscard]] long done() const { return in_order_.done(); }

private:
  const int threads_;
  const std::atomic<bool>& stop_;
  InOrder in_order_;
  std::atomic<bool> broken_ = false;
  mutable std::mutex claiming_;
  Chunk next_; ///< number of the next chunk, and the runs not claimed yet; guarded by claiming_
};

} // namespace wingspread
