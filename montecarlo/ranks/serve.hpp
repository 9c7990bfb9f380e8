/// What every rank but the first does: it makes the runs that rank 0 asks for.
#pragma once

#include "montecarlo/ranks/wire.hpp"

#include <atomic>

namespace wingspread {

/// Makes the chunks of one plan after the other, until it is told that the job is done.
/// @param stop once true (a signal of its own), no further run is begun, and rank 0 is told
void serve(Wire& wire, const std::atomic<bool>& stop);

} // namespace wingspread
