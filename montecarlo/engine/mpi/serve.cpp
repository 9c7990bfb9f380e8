#include "montecarlo/engine/mpi/serve.hpp"

#include "montecarlo/engine/mpi/plan_copy.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <new>
#include <thread>
#include <utility>

namespace wingspread {
namespace {

using std::chrono::microseconds;

/// How long to wait before the next look at the transport, which takes some 25 µs of the processor: while threads make runs
/// they are not to be disturbed, and whenever one takes a chunk from the store there is a look besides; while they have
/// nothing to do, an answer is wanted.
constexpr microseconds while_busy{8000}, while_idle{50};

/// Chunks in store for a thread, at first and at most: as many as it takes not to wait for a message's way, which
/// depends on how long runs take.
constexpr long first_store = 4, most_store = 64;

/// Waits for a message: the longer, the longer none has come. Then an answer is had at once where messages follow each
/// other, and a rank that has nothing to do while rank 0 works out statistics leaves the processor to it.
Message next_message(Transport& transport) {
  for (microseconds wait = while_idle;; wait = std::min(2 * wait, while_busy)) {
    if (auto message = transport.receive()) return std::move(*message);
    std::this_thread::sleep_for(wait);
  }
}

/// The chunks that a rank has in store, and those that its team has finished.
class LocalQueue final : public ChunkQueue {
public:
  explicit LocalQueue(const std::atomic<bool>& stop) : stop_(stop) {}

  [[nodiscard]] std::optional<Chunk> claim() override {
    const std::lock_guard lock(mutex_);
    if (stopped() || store_.empty()) return std::nullopt;
    const Chunk chunk = store_.front();
    store_.pop_front();
    has_claimed_ = true;
    changed_.notify_all(); // more is wanted
    return chunk;
  }
  [[nodiscard]] bool wait_for_more() override {
    std::unique_lock lock(mutex_);
    ++idle_;
    const auto over = [&] { return stopped() || ended_ || !store_.empty(); };
    while (!changed_.wait_for(lock, std::chrono::milliseconds(100), over)) {
    }
    --idle_;
    return !stopped() && !store_.empty();
  }
  [[nodiscard]] bool stopped() const override { return stop_.load() || broken_.load(); }
  void finish(const Chunk& chunk, Batch&& batch, bool complete) override {
    const std::lock_guard lock(mutex_);
    finished_.push_back({chunk, std::move(batch), complete});
    changed_.notify_all();
  }
  void break_off() override {
    broken_ = true;
    changed_.notify_all();
  }

  void add(const Chunk& chunk) {
    const std::lock_guard lock(mutex_);
    if (idle_ > 0 && has_claimed_) was_short_ = true;
    store_.push_back(chunk);
    changed_.notify_all();
  }
  /// No more chunks will come.
  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }
  [[nodiscard]] long in_store() const {
    const std::lock_guard lock(mutex_);
    return std::ssize(store_);
  }
  /// Whether a thread has waited for a chunk since this was last asked.
  [[nodiscard]] bool was_short() {
    const std::lock_guard lock(mutex_);
    return std::exchange(was_short_, false);
  }
  [[nodiscard]] std::vector<FinishedChunk> take_finished() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, {});
  }
  /// Waits a while for something to change.
  void pause() {
    std::unique_lock lock(mutex_);
    if (!finished_.empty()) return;
    changed_.wait_for(lock, idle_ > 0 ? while_idle : while_busy);
  }

private:
  const std::atomic<bool>& stop_;
  std::atomic<bool> broken_ = false;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Chunk> store_;
  std::vector<FinishedChunk> finished_;
  int idle_ = 0; ///< threads without a run
  bool ended_ = false, has_claimed_ = false, was_short_ = false;
};

/// One plan, from its opening to its closing. This thread is on the transport, a team beside it makes the runs.
class Session {
public:
  Session(Transport& transport, PlanCopy& copy, const std::atomic<bool>& stop)
      : transport_(transport), copy_(copy), stop_(stop), desk_(stop),
        threads_(thread_count(copy.pool().threads)) {}

  void run() {
    std::thread team([this] { work(); });
    while (!team_done_) {
      while (const auto message = transport_.receive()) heed(Deserializer(message->bytes));
      report();
      if (!team_done_) desk_.pause();
    }
    team.join();
    report();
    while (!closing_) { // it ended by itself: a signal, an exception
      const Message message = next_message(transport_);
      heed(Deserializer(message.bytes));
    }
    transport_.send(0, closed_message(end_));
  }

private:
  void work() noexcept {
    try {
      end_.occupancy =
          make_chunks(copy_.plan(), copy_.pool(), copy_.description().wants_csv, desk_);
    } catch (const std::bad_alloc&) {
      end_.failure = "found no memory left, expected more of it";
    } catch (const std::exception& error) {
      end_.failure = error.what();
    }
    team_done_ = true;
    desk_.break_off();
  }

  void heed(Deserializer message) {
    switch (kind_of(message)) {
    case MessageKind::chunk: {
      const Chunk chunk = take_chunk(message);
      copy_.expect(chunk, message);
      desk_.add(chunk);
      --asked_;
      break;
    }
    case MessageKind::stop:
      desk_.break_off();
      break;
    case MessageKind::close:
      closing_ = true;
      desk_.end();
      break;
    default:
      break;
    }
  }

  /// Tells what is finished, and asks for as many chunks as the store lacks.
  void report() {
    Report report{.finished = desk_.take_finished()};
    for (const FinishedChunk& each : report.finished) copy_.forget(each.chunk);
    const bool over = closing_ || team_done_ || desk_.stopped();
    if (desk_.was_short()) store_each_ = std::min(2 * store_each_, most_store);
    if (!over) report.wanted = std::max(0L, threads_ * store_each_ - desk_.in_store() - asked_);
    report.stopped = (stop_ || team_done_) && !closing_ && !std::exchange(told_, true);
    if (report.finished.empty() && report.wanted == 0 && !report.stopped) return;
    asked_ += report.wanted;
    transport_.send(0, report_message(report));
  }

  Transport& transport_;
  PlanCopy& copy_;
  const std::atomic<bool>& stop_;
  LocalQueue desk_;
  const long threads_;
  long store_each_ = first_store;
  long asked_ = 0; ///< chunks that were asked for and have not come
  bool closing_ = false, told_ = false;
  Closing end_{};
  std::atomic<bool> team_done_ = false;
};

/// Says what is wrong with a plan, and waits until rank 0 closes it.
void refuse(Transport& transport, const std::string& why) {
  transport.send(0, report_message({.stopped = true}));
  while (true) {
    const Message message = next_message(transport);
    Deserializer bytes(message.bytes);
    if (kind_of(bytes) == MessageKind::close)
      return transport.send(0, closed_message({.failure = why}));
  }
}

} // namespace

void serve(Transport& transport, const MeasureMaker& make_measure, const std::atomic<bool>& stop) {
  std::optional<PlanCopy> copy; // of the last plan, which often comes again
  while (true) {
    const Message message = next_message(transport);
    Deserializer bytes(message.bytes);
    const MessageKind kind = kind_of(bytes);
    if (kind == MessageKind::leave) return;
    if (kind != MessageKind::open) continue;
    PlanDescription description = take_description(bytes);
    try {
      if (!copy || copy->description() != description)
        copy.emplace(std::move(description), make_measure);
    } catch (const std::exception& error) {
      copy.reset();
      refuse(transport, error.what());
      continue;
    }
    Session(transport, *copy, stop).run();
  }
}

} // namespace wingspread
