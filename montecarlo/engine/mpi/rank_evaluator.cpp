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

/// Between looks at the transport when nothing came: while this rank's threads make runs they are not to be disturbed, and
/// the others have chunks in store; when they have none left, an answer is wanted.
constexpr microseconds between_looks{4000}, at_the_end{50};

/// One plan's chunks, handed out to the ranks that ask for them.
class Dispatch {
public:
  Dispatch(Transport& transport, const RunPlan& plan, RunRange range, RangeQueue& desk)
      : transport_(transport), plan_(plan), range_(range), desk_(desk), left_(range.size()),
        others_(static_cast<std::size_t>(transport.size())) {}

  /// @param ranks of the others, how many; the first of them
  void open(const PlanDescription& description, long ranks) {
    const std::string message = open_message(description);
    for (int rank = 1; rank <= ranks; ++rank) {
      other(rank).is_open = true;
      transport_.send(rank, message);
    }
    open_ = ranks;
  }

  /// Until all have closed. @param own_done whether this rank's own threads are done
  void run(const std::atomic<bool>& own_done) {
    while (open_ > 0) {
      bool something = false;
      while (const auto message = transport_.receive()) {
        take(*message);
        something = true;
      }
      hand_out();
      if (!something) std::this_thread::sleep_for(own_done ? at_the_end : between_looks);
    }
  }

  [[nodiscard]] const Occupancy& occupancy() const { return occupancy_; }
  /// @throws what the sink did, else what another rank reports
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
    if (!failure_.empty()) throw MachineError(failure_);
  }

private:
  struct Other {
    long wanted = 0;      ///< chunks that it waits for
    long held = 0;        ///< runs that it has been given and not reported
    bool is_open = false; ///< it has not said that it has closed
    bool told_close = false, told_stop = false;
  };
  [[nodiscard]] Other& other(int rank) { return others_[static_cast<std::size_t>(rank)]; }

  void take(const Message& message) {
    Deserializer bytes(message.bytes);
    const MessageKind kind = kind_of(bytes);
    if (kind == MessageKind::report) take_in(message.from, take_report(bytes));
    if (kind == MessageKind::closed) close(message.from, take_closing(bytes));
  }

  void take_in(int from, Report&& report) {
    other(from).wanted += report.wanted;
    if (report.stopped) desk_.break_off();
    for (const FinishedChunk& each : report.finished) other(from).held -= each.chunk.runs.size();
    try {
      for (FinishedChunk& each : report.finished)
        desk_.finish(each.chunk, std::move(each.batch), each.complete);
    } catch (...) {
      if (!thrown_) thrown_ = std::current_exception();
      desk_.break_off();
    }
  }

  void close(int from, const Closing& closing) {
    other(from).is_open = false;
    --open_;
    occupancy_ += closing.occupancy;
    if (!closing.failure.empty() && failure_.empty())
      failure_ = fmt::format("rank {}: {}", from, closing.failure);
  }

  /// One chunk to each in turn, as long as there are chunks and ranks that want them. Towards the end none may hold more
  /// than its share of what is left, lest the others wait for it.
  void hand_out() {
    const bool over = desk_.stopped() || desk_.is_exhausted();
    bool handed = !over;
    while (handed) {
      handed = false;
      for (std::size_t i = 1; i < others_.size(); ++i) {
        if (others_[i].wanted == 0 || others_[i].held > left_ / std::ssize(others_)) continue;
        const std::optional<Chunk> chunk = desk_.claim();
        if (!chunk) break;
        --others_[i].wanted;
        others_[i].held += chunk->runs.size();
        left_ = range_.last - chunk->runs.last;
        transport_.send(static_cast<int>(i), chunk_message(*chunk, plan_));
        handed = true;
      }
    }
    if (over || desk_.stopped() || desk_.is_exhausted()) end_all();
  }

  void end_all() {
    const bool stopped = desk_.stopped();
    for (std::size_t i = 1; i < others_.size(); ++i) {
      Other& each = others_[i];
      if (!each.is_open) continue;
      if (stopped && !std::exchange(each.told_stop, true))
        transport_.send(static_cast<int>(i), word(MessageKind::stop));
      if (!std::exchange(each.told_close, true))
        transport_.send(static_cast<int>(i), word(MessageKind::close));
    }
  }

  Transport& transport_;
  const RunPlan& plan_;
  const RunRange range_;
  RangeQueue& desk_;
  long left_;                 ///< runs that were not claimed when a chunk was last handed out
  std::vector<Other> others_; ///< by rank; the first is this one
  long open_ = 0;
  Occupancy occupancy_{};
  std::exception_ptr thrown_;
  std::string failure_;
};

} // namespace

long RankEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  const int team = thread_count(pool_.threads);
  const auto description = describe(plan, pool_, sink.wants_csv);
  // As many ranks as there can be chunks for, and this one.
  const long ranks = description ? std::min<long>(transport_->size() - 1, range.size() / team) : 0;
  RangeQueue desk(range, static_cast<int>((ranks + 1) * team), sink, stop_);
  Dispatch dispatch(*transport_, plan, range, desk);
  if (ranks > 0) dispatch.open(*description, ranks);
  std::exception_ptr thrown;
  std::atomic<bool> own_done = false;
  std::thread own([&] {
    try {
      occupancy_ += make_chunks(plan, pool_, sink.wants_csv, desk);
    } catch (...) {
      thrown = std::current_exception();
      desk.break_off();
    }
    own_done = true;
  });
  dispatch.run(own_done);
  own.join();
  occupancy_ += dispatch.occupancy();
  if (thrown) std::rethrow_exception(thrown);
  dispatch.rethrow();
  return desk.done();
}

void dismiss(Transport& transport) {
  for (int rank = 1; rank < transport.size(); ++rank)
    transport.send(rank, word(MessageKind::leave));
}

} // namespace wingspread
