/// Work done by several threads at once.
#pragma once

#include <cstddef>
#include <functional>

namespace wingspread {

/// How many threads there will be for `wanted`: as many, or for 0 as many as OpenMP offers
/// (OMP_NUM_THREADS, or the processor's).
[[nodiscard]] int team_size(int wanted);

/// Calls `work` once on each thread of a team of up to that many, and returns when all are done.
/// The first exception that leaves a call is kept off the team, and thrown again from here.
/// @param on_exception called at once when one is caught, to make the other calls come to an end
void on_team(int threads, const std::function<void()>& work,
             const std::function<void()>& on_exception);

/// Calls task(0), task(1), … task(count − 1), each once, on a team of up to that many threads; no
/// task may depend on another. What a task throws is thrown from here, when all threads are done.
void for_each_task(int threads, std::size_t count, const std::function<void(std::size_t)>& task);

/// How many threads there will be for `wanted` when each takes so many bytes, and all of them no
/// more than 1 GiB; at least one.
[[nodiscard]] int team_within(int wanted, std::size_t bytes_each);

} // namespace wingspread
