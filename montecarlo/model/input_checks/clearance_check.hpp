/// Checks that no bodies pass through each other in the nominal deployment.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Runs the nominal wing up to its last latch and compares the bodies' arms (shape_checks.hpp) at least every 0.05 rad
/// of each hinge. States with a hinge beyond its stowed angle are skipped: overtravel is an output of runs.
/// Returns the nominal deployment, without peaks.
Outcome check_clearance(const Scene& scene, const Integration& integration,
                        InputWarnings& warnings);

/// A deployment up to its last latch or, with peaks, until these are final; within the checks' limits of cost.
[[nodiscard]] Outcome deployment_alone(const Scene& scene, const Integration& integration,
                                       const Observer& observer = {}, bool peaks = false);

} // namespace wingspread
