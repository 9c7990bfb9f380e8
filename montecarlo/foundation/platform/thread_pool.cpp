#include "montecarlo/foundation/platform/thread_pool.hpp"

#include "montecarlo/foundation/platform/arithmetic.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <omp.h>
#include <thread>
#include <unistd.h>

// GCC's OpenMP runtime synchronises with futexes, which the thread sanitizer does not see. It would report races at the
// start and at the end of the threads, so release() and acquire() announce both to the sanitizer. One store comes too
// late for release(): the compiler stores the address of the shared data just before the threads start. So
// start_and_join, which touches nothing else of the shared data, is not instrumented; everything it calls is.
#ifdef __SANITIZE_THREAD__
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
namespace {
char edge; // its address is all that matters
void acquire() { __tsan_acquire(&edge); }
void release() { __tsan_release(&edge); }
} // namespace
#else
namespace {
void acquire() {}
void release() {}
} // namespace
#endif

namespace wingspread {
namespace {

/// The data that the threads share.
struct SharedWork {
  const std::function<void()>& work;
  const std::function<void()>& on_exception;
  std::mutex mutex{};
  std::exception_ptr first{};

  void one_thread() noexcept {
    const DefaultArithmetic arithmetic; // a thread that the caller has used may have another
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!first) first = std::current_exception();
      on_exception();
    }
  }
};

} // namespace

int thread_count(int wanted) { return wanted > 0 ? wanted : omp_get_max_threads(); }

int threads_worth(int wanted, double operations) {
  return operations < operations_worth_threads ? 1 : thread_count(wanted);
}

namespace {

[[gnu::no_sanitize_thread]] void start_and_join(int threads, SharedWork& shared_work) {
  release();
#pragma omp parallel num_threads(threads) default(none) shared(shared_work)
  {
    acquire();
    shared_work.one_thread();
    release();
  }
  acquire();
}

/// Whether this process is a copy, by fork, of one that had used threads here. OpenMP's threads, which wait for the next
/// work of the thread that started them, do not exist in the copy, and work for them would wait for ever. A new thread
/// starts new ones.
bool is_forked() {
  static const pid_t first = getpid();
  return getpid() != first;
}

} // namespace

void run_on_threads(int threads, const std::function<void()>& work,
                    const std::function<void()>& on_exception) {
  SharedWork shared_work{work, on_exception};
  const int count = thread_count(threads);
  if (count > 1 && is_forked())
    std::thread([&] { start_and_join(count, shared_work); }).join();
  else
    start_and_join(count, shared_work);
  if (shared_work.first) std::rethrow_exception(shared_work.first);
}

void for_each_task(int threads, std::size_t count, const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next = 0;
  const auto most = static_cast<int>(std::clamp<std::size_t>(count, 1, 1024));
  run_on_threads(
      std::min(thread_count(threads), most),
      [&] {
        for (std::size_t i = next++; i < count; i = next++) task(i);
      },
      [&] { next = count; });
}

int threads_within_memory(int wanted, std::size_t bytes_each) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  const auto most = static_cast<int>(
      std::clamp<std::size_t>(most_bytes / std::max<std::size_t>(bytes_each, 1), 1, 1024));
  return std::min(thread_count(wanted), most);
}

} // namespace wingspread
