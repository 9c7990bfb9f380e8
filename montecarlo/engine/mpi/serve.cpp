#include "montecarlo/engine/mpi/serve.hpp"

#include "montecarlo/engine/mpi/plan_copy.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <list>
#include <new>
#include <thread>
#include <utility>

namespace wingspread {
namespace {

using std::chrono::microseconds;

/// Pauses before polling the transport, which takes some 25 µs. Heuristic: 8 ms while threads work (a claimed chunk
/// triggers a poll besides), 50 µs while they are idle. A longer idle pause delays answers, a shorter busy one takes
/// time from the threads.
constexpr microseconds while_busy{8000}, while_idle{50};

/// Chunks in store per thread, at first and at most. Heuristic: enough that no thread waits for a message; whenever a
/// thread had to wait, the store doubles, up to the maximum. Too few leave threads idle when runs are fast, too many
/// make the ranks end at different times.
constexpr long first_store = 4, most_store = 64;

/// Waits for a message; polls less often the longer none came. Messages in quick succession are answered fast, and an
/// idle rank leaves the processor to rank 0's statistics.
Message next_message(Transport& transport) {
  for (microseconds wait = while_idle;; wait = std::min(2 * wait, while_busy)) {
    if (auto message = transport.receive()) return std::move(*message);
    std::this_thread::sleep_for(wait);
  }
}

/// A rank's chunks in store, and the chunks its threads have finished.
class LocalQueue final : public ChunkQueue {
public:
  explicit LocalQueue(const std::atomic<bool>& stop) : stop_(stop) {}

  [[nodiscard]] std::optional<Chunk> claim() override {
    const std::lock_guard lock(mutex_);
    if (stopped() || store_.empty()) return std::nullopt;
    const Chunk chunk = store_.front();
    store_.pop_front();
    has_claimed_ = true;
    changed_.notify_all(); // the store has room: the next report asks for more chunks
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
  /// Whether a thread has waited for a chunk since the last call.
  [[nodiscard]] bool was_short() {
    const std::lock_guard lock(mutex_);
    return std::exchange(was_short_, false);
  }
  [[nodiscard]] std::vector<FinishedChunk> take_finished() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, {});
  }
  /// Waits for a change, for while_idle if a thread is idle, else for while_busy at most.
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

/// One plan, from `open` to `closed`. The calling thread handles messages; the thread pool makes the runs.
class Session {
public:
  Session(Transport& transport, PlanCopy& copy, const std::atomic<bool>& stop)
      : transport_(transport), copy_(copy), stop_(stop), queue_(stop),
        threads_(thread_count(copy.pool().threads)) {}

  void run() {
    std::thread worker([this] { work(); });
    while (!work_done_) {
      while (const auto message = transport_.receive()) handle(Deserializer(message->bytes));
      report();
      if (!work_done_) queue_.pause();
    }
    worker.join();
    report();
    while (!closing_) { // the work ended before `close` came: a signal or an exception
      const Message message = next_message(transport_);
      handle(Deserializer(message.bytes));
    }
    transport_.send(0, closed_message(end_));
  }

private:
  void work() noexcept {
    try {
      end_.occupancy =
          make_chunks(copy_.plan(), copy_.pool(), copy_.description().wants_csv, queue_);
    } catch (const std::bad_alloc&) {
      end_.failure = "found no memory left, expected more of it";
    } catch (const std::exception& error) {
      end_.failure = error.what();
    }
    work_done_ = true;
    queue_.break_off();
  }

  void handle(Deserializer message) {
    switch (kind_of(message)) {
    case MessageKind::chunk: {
      const Chunk chunk = read_chunk(message);
      copy_.expect(chunk, message);
      queue_.add(chunk);
      --asked_;
      break;
    }
    case MessageKind::stop:
      queue_.break_off();
      break;
    case MessageKind::close:
      closing_ = true;
      queue_.end();
      break;
    default:
      break;
    }
  }

  /// Sends finished chunks, and asks for as many chunks as the store lacks.
  void report() {
    Report report{.finished = queue_.take_finished()};
    for (const FinishedChunk& each : report.finished) copy_.forget(each.chunk);
    const bool over = closing_ || work_done_ || queue_.stopped();
    if (queue_.was_short()) store_per_thread_ = std::min(2 * store_per_thread_, most_store);
    if (!over)
      report.wanted = std::max(0L, threads_ * store_per_thread_ - queue_.in_store() - asked_);
    report.stopped = (stop_ || work_done_) && !closing_ && !std::exchange(stop_reported_, true);
    if (report.finished.empty() && report.wanted == 0 && !report.stopped) return;
    asked_ += report.wanted;
    transport_.send(0, report_message(report));
  }

  Transport& transport_;
  PlanCopy& copy_;
  const std::atomic<bool>& stop_;
  LocalQueue queue_;
  const long threads_;
  long store_per_thread_ = first_store;
  long asked_ = 0; ///< chunks asked for that have not arrived
  bool closing_ = false, stop_reported_ = false;
  Closing end_{};
  std::atomic<bool> work_done_ = false;
};

/// Reports why a plan cannot be made here, and waits until rank 0 closes it.
void refuse(Transport& transport, const std::string& why) {
  transport.send(0, report_message({.stopped = true}));
  while (true) {
    const Message message = next_message(transport);
    Deserializer bytes(message.bytes);
    if (kind_of(bytes) == MessageKind::close)
      return transport.send(0, closed_message({.failure = why}));
  }
}

/// Copies of the last plans: several ranges often share a plan, and a fit's tests take turns.
class PlanCopies {
public:
  /// @throws as PlanCopy's constructor
  [[nodiscard]] PlanCopy& of(PlanDescription description, const MeasureMaker& make_measure) {
    const auto is_it = [&](const PlanCopy& copy) { return copy.description() == description; };
    const auto found = std::ranges::find_if(copies_, is_it);
    if (found == copies_.end())
      copies_.emplace_front(std::move(description), make_measure);
    else
      copies_.splice(copies_.begin(), copies_, found);
    if (copies_.size() > most) copies_.pop_back();
    return copies_.front();
  }

private:
  static constexpr std::size_t most = 16; // of campaigns with their rows: some MB each at most
  std::list<PlanCopy> copies_;            ///< the last used first
};

} // namespace

void serve(Transport& transport, const MeasureMaker& make_measure, const std::atomic<bool>& stop) {
  PlanCopies copies;
  while (true) {
    const Message message = next_message(transport);
    Deserializer bytes(message.bytes);
    const MessageKind kind = kind_of(bytes);
    if (kind == MessageKind::leave) return;
    if (kind != MessageKind::open) continue;
    PlanCopy* copy = nullptr;
    try {
      copy = &copies.of(read_description(bytes), make_measure);
    } catch (const std::exception& error) {
      refuse(transport, error.what());
      continue;
    }
    Session(transport, *copy, stop).run();
  }
}

} // namespace wingspread
