#include "montecarlo/runs/evaluator.hpp"

#include "montecarlo/machine/team.hpp"
#include "montecarlo/runs/in_order.hpp"

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

/// Chunks that may be begun beyond those handed on: some 30,000 runs, the rows of which take tens of MB.
constexpr long most_ahead = 1024;

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
  InOrder in_order(sink, most_ahead);
  std::mutex claiming, adding;
  long next_chunk = 0;              // guarded by claiming
  std::atomic<bool> broken = false; // by an exception
  const auto stopped = [&] { return stop_.load() || broken.load(); };
  const auto has_more = [&] { return range.first + next_chunk * size < range.last; };
  const auto claim = [&]() -> std::optional<std::pair<long, RunRange>> {
    const std::lock_guard lock(claiming);
    if (stopped() || !has_more() || !in_order.may_begin(next_chunk)) return std::nullopt;
    const long chunk = next_chunk++, first = range.first + chunk * size;
    return std::pair(chunk, RunRange{first, std::min(first + size, range.last)});
  };
  // A thread that has run out of chunks because one run keeps the others waiting has a rest.
  const auto wait_for_more = [&] {
    long chunk = 0;
    {
      const std::lock_guard lock(claiming);
      if (stopped() || !has_more()) return false;
      chunk = next_chunk;
    }
    in_order.wait_for(chunk, stopped);
    return true;
  };
  const auto work = [&] {
    Runner runner(plan);
    Chunks chunks(in_order, sink.wants_csv, claim);
    const auto next = [&] { return stopped() ? std::nullopt : chunks.next(); };
    Occupancy full{};
    do
      full +=
          runner.run_all(crew_.set, next, [&](ResultRow&& row) { chunks.take(std::move(row)); });
    while (wait_for_more());
    chunks.close();
    const std::lock_guard lock(adding);
    occupancy_ += full;
  };
  on_team(team, work, [&] { broken = true; });
  return in_order.done();
}

} // namespace wingspread
