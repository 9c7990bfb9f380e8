/// Work done by several threads at once.
#pragma once

#include <cstddef>
#include <functional>

namespace wingspread {

/// How many threads there will be for `wanted`: as many, or for 0 as many as OpenMP offers
/// (OMP_NUM_THREADS, or the processor's).
[[nodiscard]] int thread_count(int wanted);
/// The most threads that a user can ask for.
inline constexpr int most_threads = 1024;

/// Below so many operations one thread does the work of a team sooner. An operation is a term of a compensated sum, or
/// as much: some 6 ns. Where other threads want the processors too, a team waits until the last of its threads has had
/// its turn, and spins meanwhile. `studies/drivers/team_costs.cpp` on two processors that two other threads and other
/// programs wanted (23 November 2026): 2¹⁶ operations took 0.51 ms on one thread and 6.8 ms on two, 2²² 28 ms and 29 ms,
/// 2²⁴ 206 ms and 85 ms.
inline constexpr double operations_worth_threads = 1 << 22;

/// How many threads there will be for `wanted` and work of so many operations in all: thread_count's, or one.
[[nodiscard]] int threads_worth(int wanted, double operations);

/// Calls `work` once on each thread of a team of up to that many, and returns when all are done.
/// The first exception that leaves a call is kept off the team, and thrown again from here.
/// @param on_exception called at once when one is caught, to make the other calls come to an end
void run_on_threads(int threads, const std::function<void()>& work,
                    const std::function<void()>& on_exception);

/// Calls task(0), task(1), … task(count − 1), each once, on a team of up to that many threads; no
/// task may depend on another. What a task throws is thrown from here, when all threads are done.
void for_each_task(int threads, std::size_t count, const std::function<void(std::size_t)>& task);

/// How many threads there will be for `wanted` when each takes so many bytes, and all of them no
/// more than 1 GiB; at least one.
[[nodiscard]] int threads_within_memory(int wanted, std::size_t bytes_each);

} // namespace wingspread
