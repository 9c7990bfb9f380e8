/// Work done by several threads at once.
#pragma once

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

} // namespace wingspread
