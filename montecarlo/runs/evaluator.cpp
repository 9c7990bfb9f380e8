#include "montecarlo/runs/evaluator.hpp"

#include "montecarlo/machine/team.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
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
    if (!finished.batch.rows.empty()) sink_.take(finished.batch);
    done_ += std::ssize(finished.batch.rows);
    cut_ = !finished.complete;
  }

  const BatchSink& sink_;
  std::mutex mutex_;
  std::map<long, Finished> waiting_; ///< by chunk
  long next_ = 0, done_ = 0;
  bool cut_ = false;
};

/// One thread's chunks: the one that its runs come from, and those that wait for their last runs.
template <class Claim> class Chunks {
public:
  /// @param claim claim() returns the number and range of the next chunk, none when there is none
  Chunks(InOrder& in_order, bool wants_csv, Claim claim)
      : in_order_(in_order), wants_csv_(wants_csv), claim_(std::move(claim)) {}

  [[nodiscard]] std::optional<long> next() {
    if (open_ == nullptr || open_->issued == open_->range.size()) {
      const auto claimed = claim_();
      if (!claimed) return std::nullopt;
      open_ = &chunks_[claimed->first];
      open_->range = claimed->second;
      open_->batch.rows.resize(static_cast<std::size_t>(claimed->second.size()));
    }
    return open_->range.first + open_->issued++;
  }

  void take(ResultRow&& row) {
    const auto found = std::ranges::find_if(chunks_, [&](const auto& entry) {
      return row.run >= entry.second.range.first && row.run < entry.second.range.last;
    });
    Chunk& chunk = found->second;
    const long place = row.run - chunk.range.first;
    chunk.batch.rows[static_cast<std::size_t>(place)] = std::move(row);
    if (++chunk.made < chunk.range.size()) return;
    if (open_ == &chunk) open_ = nullptr;
    hand_over(found->first, std::move(chunk), true);
    chunks_.erase(found);
  }

  /// All runs that were begun have ended. What was begun of a chunk is kept.
  void close() {
    for (auto& [number, chunk] : chunks_) {
      chunk.batch.rows.resize(static_cast<std::size_t>(chunk.issued));
      hand_over(number, std::move(chunk), false);
    }
    chunks_.clear();
  }

private:
  struct Chunk {
    RunRange range;
    Batch batch;
    long issued = 0, made = 0;
  };

  void hand_over(long number, Chunk&& chunk, bool complete) {
    if (wants_csv_)
      for (const ResultRow& row : chunk.batch.rows) append_row(chunk.batch.csv, row);
    in_order_.finish(number, std::move(chunk.batch), complete);
  }

  InOrder& in_order_;
  bool wants_csv_;
  Claim claim_;
  std::map<long, Chunk> chunks_; ///< by number
  Chunk* open_ = nullptr;
};

} // namespace

long ThreadEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  const int team = team_size(crew_.threads);
  const long size = chunk_size(range, team);
  InOrder in_order(sink);
  std::atomic<long> next_chunk = 0;
  std::atomic<bool> broken = false; // by an exception
  const auto stopped = [&] { return stop_.load() || broken.load(); };
  std::mutex adding;
  const auto claim = [&]() -> std::optional<std::pair<long, RunRange>> {
    if (stopped()) return std::nullopt;
    const long chunk = next_chunk++, first = range.first + chunk * size;
    if (first >= range.last) return std::nullopt;
    return std::pair(chunk, RunRange{first, std::min(first + size, range.last)});
  };
  const auto work = [&] {
    Runner runner(plan);
    Chunks chunks(in_order, sink.wants_csv, claim);
    const auto next = [&] { return stopped() ? std::nullopt : chunks.next(); };
    const Occupancy full =
        runner.run_all(crew_.set, next, [&](ResultRow&& row) { chunks.take(std::move(row)); });
    chunks.close();
    const std::lock_guard lock(adding);
    occupancy_ += full;
  };
  on_team(team, work, [&] { broken = true; });
  return in_order.done();
}

} // namespace wingspread
