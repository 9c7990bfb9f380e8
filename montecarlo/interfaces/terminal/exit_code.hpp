/// The program's exit codes.
#pragma once

#include "montecarlo/foundation/platform/interrupt.hpp"

namespace wingspread::exit_code {

inline constexpr int done = 0;
inline constexpr int not_met = 1;         ///< done, but a requirement is not shown to be met
inline constexpr int bad_input = 2;       ///< nothing was done
inline constexpr int failed_runs = 3;     ///< done, but some runs failed numerically
inline constexpr int machine_refused = 4; ///< no room, memory or permission; finished work is kept
inline constexpr int interrupted = interrupted_status; ///< finished work is kept, can be resumed

} // namespace wingspread::exit_code
