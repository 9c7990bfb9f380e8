/// Identifies the runs that a study asks for at once.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <string>

namespace wingspread {

/// A text unique to these runs: the hash of the campaign, the outputs kept, the range, and the draws of its first and
/// last run (a study may place runs at points of its own).
[[nodiscard]] std::string analysis_id(const RunPlan& plan, RunRange range);

} // namespace wingspread
