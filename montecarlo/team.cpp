#include "montecarlo/team.hpp"

#include <exception>
#include <mutex>
#include <omp.h>

// GCC's OpenMP runtime synchronises with futexes that the thread sanitizer does not see: it would
// take the team's start and end for races. These two edges are told to it here. `edge` is global
// because a captured variable would be read from the starting thread's frame before the edge.
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

/// What the team shares.
struct Shift {
  const std::function<void()>& work;
  const std::function<void()>& on_exception;
  std::mutex mutex{};
  std::exception_ptr first{};

  void one_thread() noexcept {
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

int team_size(int wanted) { return wanted > 0 ? wanted : omp_get_max_threads(); }

void on_team(int threads, const std::function<void()>& work,
             const std::function<void()>& on_exception) {
  Shift shift{work, on_exception};
  release();
#pragma omp parallel num_threads(team_size(threads)) default(none) shared(shift)
  {
    acquire();
    shift.one_thread();
    release();
  }
  acquire();
  if (shift.first) std::rethrow_exception(shift.first);
}

} // namespace wingspread
