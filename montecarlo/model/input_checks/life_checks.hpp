/// Checks holds, and latches that may miss or let go.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of holds that wait for themselves, that fail, that let go after t_end or after their hinge has latched; of
/// latches that the nominal deployment passes too fast or pulls open, and of a hinge that nothing stops if it misses its
/// latch.
/// @param nominal the nominal deployment
void check_life(const Scene& scene, const Integration& integration, const Outcome& nominal,
                InputWarnings& warnings);

} // namespace wingspread
