/// Checks that no damper makes the deployment far longer than it is without dampers.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of each damper that alone makes the nominal deployment ten times as long as it is without any damper: a
/// coefficient in N·mm·s or per degree does so. Cost, only where all dampers together do: a deployment without dampers,
/// and one for each damper.
/// @param nominal the nominal deployment
void check_dampers(const Scene& scene, const Integration& integration, const Outcome& nominal,
                   InputWarnings& warnings);

} // namespace wingspread
