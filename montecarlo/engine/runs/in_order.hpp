/// Delivers batches in the order of their chunks.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <utility>

namespace wingspread {

/// Delivers batches in chunk order, whatever order they finish in. A batch that finishes early waits. The number
/// waiting is bounded: a chunk too far ahead of the oldest unfinished one must not begin yet.
class InOrder {
public:
  /// @param most_ahead most chunks begun beyond those delivered, ≥ 1
  InOrder(const BatchSink& sink, long most_ahead) : sink_(sink), most_ahead_(most_ahead) {}

  /// Whether the chunk may begin now.
  [[nodiscard]] bool may_begin(long chunk) const {
    const std::lock_guard lock(mutex_);
    return chunk < next_ + most_ahead_;
  }

  /// Waits until the chunk may begin, or `ended()` is true.
  /// @param ended called ten times a second
  template <class Ended> void wait_for(long chunk, const Ended& ended) {
    std::unique_lock lock(mutex_);
    const auto over = [&] { return chunk < next_ + most_ahead_ || ended(); };
    while (!moved_.wait_for(lock, std::chrono::milliseconds(100), over)) {
    }
  }

  /// @param complete false if the chunk was cut short: later chunks are not delivered
  void finish(long chunk, Batch batch, bool complete) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(chunk, Finished{std::move(batch), complete});
    while (!cut_ && waiting_.contains(next_)) deliver(waiting_.extract(next_++).mapped());
    moved_.notify_all();
  }

  /// Runs delivered. @pre all threads have ended
  [[nodiscard]] long done() const { return done_; }

private:
  struct Finished {
    Batch batch;
    bool complete;
  };

  void deliver(const Finished& finished) {
    cut_ = true; // if the sink throws, later batches are not delivered
    if (!finished.batch.rows.empty()) sink_.take(finished.batch);
    done_ += std::ssize(finished.batch.rows);
    cut_ = !finished.complete;
  }

  const BatchSink& sink_;
  const long most_ahead_;
  mutable std::mutex mutex_;
  std::condition_variable moved_;
  std::map<long, Finished> waiting_; ///< by chunk number
  long next_ = 0, done_ = 0;
  bool cut_ = false;
};

} // namespace wingspread
