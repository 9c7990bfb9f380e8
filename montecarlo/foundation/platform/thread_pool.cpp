#include "montecarlo/foundation/platform/thread_pool.hpp"

#include "montecarlo/foundation/platform/arithmetic.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <omp.h>
#include <system_error>
#include <thread>
#include <vector>

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

int thread_count(int wanted) {
  return wanted > 0 ? wanted : std::min(omp_get_max_threads(), most_threads);
}

int threads_for(int wanted, std::size_t tasks) {
  return static_cast<int>(
      std::clamp<std::size_t>(tasks, 1, static_cast<std::size_t>(thread_count(wanted))));
}

int threads_worth(int wanted, double operations) {
  return operations < operations_worth_threads ? 1 : thread_count(wanted);
}

void run_on_threads(int threads, const std::function<void()>& work,
                    const std::function<void()>& on_exception) {
  SharedWork shared_work{work, on_exception};
  // Threads of the standard library: OpenMP's end the process where the machine refuses one.
  std::vector<std::thread> others;
  try {
    for (int k = thread_count(threads); k > 1; --k)
      others.emplace_back([&] { shared_work.one_thread(); });
  } catch (const std::system_error&) { // no more threads than these
  } catch (const std::bad_alloc&) {
  }
  shared_work.one_thread();
  for (std::thread& each : others) each.join();
  if (shared_work.first) std::rethrow_exception(shared_work.first);
}

void for_each_task(int threads, std::size_t count, const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next = 0;
  run_on_threads(
      threads_for(threads, count),
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
