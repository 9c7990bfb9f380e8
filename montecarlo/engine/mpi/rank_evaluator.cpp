#include "montecarlo/engine/mpi/rank_evaluator.hpp"

#include "montecarlo/engine/mpi/plan_copy.hpp"
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>

namespace wingspread {
namespace {

using std::chrono::microseconds;

/// Pauses between polls of the transport. Heuristic: 4 ms while rank 0's threads work. Polls of 25 µs each then take
/// less than 1 % of a processor, and the other ranks have enough chunks in store for the pause. 50 µs at the end, when
/// only answers are missing. A longer pause leaves the ranks without chunks, a shorter one takes time from rank 0's
/// threads.
constexpr microseconds between_polls{4000}, at_the_end{50};

/// Sends the chunks of one plan to the ranks that ask for them.
class Dispatch {
public:
  Dispatch(Transport& transport, const RunPlan& plan, RunRange range, RangeQueue& queue)
      : transport_(transport), plan_(plan), range_(range), queue_(queue), left_(range.size()),
        others_(static_cast<std::size_t>(transport.size())) {}

  /// @param ranks number of other ranks to use, the first ones
  void open(const PlanDescription& description, long ranks) {
    const std::string message = open_message(description);
    for (int rank = 1; rank <= ranks; ++rank) {
      other(rank).is_open = true;
      transport_.send(rank, message);
    }
    open_ = ranks;
  }

  /// Receives and sends until all ranks have closed. @param own_done whether this rank's threads have ended
  void run(const std::atomic<bool>& own_done) {
    while (open_ > 0) {
      bool something = false;
      while (const auto message = transport_.receive()) {
        take(*message);
        something = true;
      }
      hand_out();
      if (!something) std::this_thread::sleep_for(own_done ? at_the_end : between_polls);
    }
  }

  [[nodiscard]] const Occupancy& occupancy() const { return occupancy_; }
  /// @throws the sink's exception, else the error of another rank
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
    if (!failure_.empty()) throw MachineError(failure_);
  }

private:
  struct Other {
    long wanted = 0;      ///< chunks the rank waits for
    long held = 0;        ///< runs sent to the rank and not reported
    bool is_open = false; ///< the rank was sent a plan and has not sent `closed`
    bool told_close = false, told_stop = false;
  };
  [[nodiscard]] Other& other(int rank) { return others_[static_cast<std::size_t>(rank)]; }

  void take(const Message& message) {
    Deserializer bytes(message.bytes);
    const MessageKind kind = kind_of(bytes);
    if (kind == MessageKind::report) receive_report(message.from, read_report(bytes));
    if (kind == MessageKind::closed) close(message.from, read_closing(bytes));
  }

  void receive_report(int from, Report&& report) {
    other(from).wanted += report.wanted;
    if (report.stopped) queue_.break_off();
    for (const FinishedChunk& each : report.finished) other(from).held -= each.chunk.runs.size();
    try {
      for (FinishedChunk& each : report.finished)
        queue_.finish(each.chunk, std::move(each.batch), each.complete);
    } catch (...) {
      if (!thrown_) thrown_ = std::current_exception();
      queue_.break_off();
    }
  }

  void close(int from, const Closing& closing) {
    other(from).is_open = false;
    --open_;
    occupancy_ += closing.occupancy;
    if (!closing.failure.empty() && failure_.empty())
      failure_ = fmt::format("rank {}: {}", from, closing.failure);
  }

  /// Sends one chunk to each rank in turn while chunks and requests are left. Near the end no rank may hold more than
  /// its share of the runs left, so that the others need not wait for it.
  void hand_out() {
    const bool over = queue_.stopped() || queue_.is_exhausted();
    bool handed = !over;
    while (handed) {
      handed = false;
      for (std::size_t i = 1; i < others_.size(); ++i) {
        if (others_[i].wanted == 0 || others_[i].held > left_ / std::ssize(others_)) continue;
        const std::optional<Chunk> chunk = queue_.claim();
        if (!chunk) break;
        --others_[i].wanted;
        others_[i].held += chunk->runs.size();
        left_ = range_.last - chunk->runs.last;
        transport_.send(static_cast<int>(i), chunk_message(*chunk, plan_));
        handed = true;
      }
    }
    if (over || queue_.stopped() || queue_.is_exhausted()) end_all();
  }

  void end_all() {
    const bool stopped = queue_.stopped();
    for (std::size_t i = 1; i < others_.size(); ++i) {
      Other& each = others_[i];
      if (!each.is_open) continue;
      if (stopped && !std::exchange(each.told_stop, true))
        transport_.send(static_cast<int>(i), bare_message(MessageKind::stop));
      if (!std::exchange(each.told_close, true))
        transport_.send(static_cast<int>(i), bare_message(MessageKind::close));
    }
  }

  Transport& transport_;
  const RunPlan& plan_;
  const RunRange range_;
  RangeQueue& queue_;
  long left_;                 ///< runs unclaimed when a chunk was last sent
  std::vector<Other> others_; ///< by rank; entry 0 is unused
  long open_ = 0;
  Occupancy occupancy_{};
  std::exception_ptr thrown_;
  std::string failure_;
};

} // namespace

long RankEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  const int threads = thread_count(pool_.threads);
  const auto description = describe(plan, pool_, sink.wants_csv);
  // Other ranks: only as many as get at least one run for each of their threads.
  const long ranks =
      description ? std::min<long>(transport_->size() - 1, range.size() / threads) : 0;
  RangeQueue queue(range, static_cast<int>((ranks + 1) * threads), sink, stop_);
  Dispatch dispatch(*transport_, plan, range, queue);
  if (ranks > 0) dispatch.open(*description, ranks);
  std::exception_ptr thrown;
  std::atomic<bool> own_done = false;
  std::thread own([&] {
    try {
      occupancy_ += make_chunks(plan, pool_, sink.wants_csv, queue);
    } catch (...) {
      thrown = std::current_exception();
      queue.break_off();
    }
    own_done = true;
  });
  dispatch.run(own_done);
  own.join();
  occupancy_ += dispatch.occupancy();
  if (thrown) std::rethrow_exception(thrown);
  dispatch.rethrow();
  return queue.done();
}

void dismiss(Transport& transport) {
  for (int rank = 1; rank < transport.size(); ++rank)
    transport.send(rank, bare_message(MessageKind::leave));
}

} // namespace wingspread
