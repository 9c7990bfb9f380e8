/// Checks motors.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of motors that exert nothing, that are never commanded towards the latch, whose command is implausibly fast or
/// too slow for the run, and that bend their latch or pull it open.
/// @param nominal the nominal deployment
void check_motors(const Scene& scene, const Integration& integration, const Outcome& nominal,
                  InputWarnings& warnings);

} // namespace wingspread
