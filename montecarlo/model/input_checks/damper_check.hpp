/// Checks that no damper makes the deployment far longer than it is without dampers.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of each damper that alone makes the nominal deployment ten times as long as it is without any damper: a
/// coefficient in N·mm·s or per degree does so. Cost with dampers: a deployment without them,
/// to a tenth of the nominal time (to t_end if the nominal wing timed out); if it deploys, one for each damper.
/// @param nominal the nominal deployment
void check_dampers(const Scene& scene, const Integration& integration, const Outcome& nominal,
                   InputWarnings& warnings);

} // namespace wingspread
