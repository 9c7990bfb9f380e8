#include "montecarlo/engine.hpp"

#include "montecarlo/team.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

namespace wingspread {
namespace {

/// Runs in a chunk: enough to make the counter and the lock free of charge, and few enough that the
/// threads finish together and an interruption loses little.
long chunk_size(RunRange range, int threads) {
  return std::clamp<long>(range.size() / (8L * threads), 1, 32);
}

/// Hands batches on in the order of their chunks, whichever order they are finished in.
class InOrder {
public:
  explicit InOrder(const BatchSink& sink) : sink_(sink) {}

  /// @param complete false when the chunk was broken off: nothing after it will be handed on
  void finish(long chunk, Batch batch, bool complete) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(chunk, Finished{std::move(batch), complete});
    while (!cut_ && waiting_.contains(next_)) hand_on(waiting_.extract(next_++).mapped());
  }

  /// Runs handed on. @pre all threads are done
  [[nodiscard]] long done() const { return done_; }

private:
  struct Finished {
    Batch batch;
    bool complete;
  };

  void hand_on(const Finished& finished) {
    cut_ = true; // stays so if the sink throws
    if (!finished.batch.rows.empty()) sink_(finished.batch);
    done_ += std::ssize(finished.batch.rows);
    cut_ = !finished.complete;
  }

  const BatchSink& sink_;
  std::mutex mutex_;
  std::map<long, Finished> waiting_; ///< by chunk
  long next_ = 0, done_ = 0;
  bool cut_ = false;
};

/// The runs of a range, until asked to stop.
template <class Stopped> Batch make_batch(Runner& runner, RunRange range, const Stopped& stopped) {
  Batch batch;
  batch.rows.reserve(static_cast<std::size_t>(range.size()));
  for (long k = range.first; k < range.last && !stopped(); ++k) {
    batch.rows.push_back(runner.run(k));
    append_row(batch.csv, batch.rows.back());
  }
  return batch;
}

} // namespace

long make_runs(const RunPlan& plan, RunRange range, int threads, const std::atomic<bool>& stop,
               const BatchSink& sink) {
  const int team = team_size(threads);
  const long size = chunk_size(range, team);
  InOrder in_order(sink);
  std::atomic<long> next_chunk = 0;
  std::atomic<bool> broken = false; // by an exception
  const auto stopped = [&] { return stop.load() || broken.load(); };
  const auto work = [&] {
    Runner runner(plan);
    while (!stopped()) {
      const long chunk = next_chunk++;
      const long first = range.first + chunk * size;
      if (first >= range.last) break;
      const RunRange part{first, std::min(first + size, range.last)};
      Batch batch = make_batch(runner, part, stopped);
      const bool complete = std::ssize(batch.rows) == part.size();
      in_order.finish(chunk, std::move(batch), complete);
    }
  };
  on_team(team, work, [&] { broken = true; });
  return in_order.done();
}

} // namespace wingspread
