/// Work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace wingspread {

/// The number of threads for `wanted`: the same number, or for 0 what OpenMP offers (OMP_NUM_THREADS, or the number
/// of processors), at most most_threads.
[[nodiscard]] int thread_count(int wanted);

/// thread_count(wanted), but at least 1 and at most one for each task.
[[nodiscard]] int threads_for(int wanted, std::size_t tasks);
/// The most threads a user can ask for.
inline constexpr int most_threads = 1024;

/// With fewer operations one thread is faster than several. An operation is one term of a compensated sum, or equal
/// work: some 6 ns. If other programs use the processors, all threads wait until the last one has had one. Measured with
/// `studies/drivers/team_costs.cpp` on two processors shared with other programs: 2¹⁶ operations took 0.43 ms on one
/// thread and 26 ms on two, 2²² 36 ms and 38 ms, 2²⁴ 261 ms and 193 ms.
inline constexpr double operations_worth_threads = 1 << 22;

/// thread_count(wanted) for at least operations_worth_threads operations, else 1.
[[nodiscard]] int threads_worth(int wanted, double operations);

/// Calls `work` once on each of up to `threads` threads, of which the caller's is one, and returns when all calls have
/// ended. The threads are fewer if the machine refuses more. The first exception that leaves a call is rethrown here.
/// @param on_exception called at once when an exception is caught, to end the other calls
void run_on_threads(int threads, const std::function<void()>& work,
                    const std::function<void()>& on_exception);

/// Calls task(0), … task(count − 1), each once, on up to `threads` threads. Tasks must not depend on each other. The
/// first exception is rethrown when all threads have ended.
void for_each_task(int threads, std::size_t count, const std::function<void(std::size_t)>& task);

/// The number of threads for `wanted` if each takes `bytes_each` and all together at most 1 GiB; at least 1.
/// Heuristic: 1 GiB fits machines with 2 GiB; a larger limit makes statistics of 10⁸ runs faster.
[[nodiscard]] int threads_within_memory(int wanted, std::size_t bytes_each);

} // namespace wingspread
