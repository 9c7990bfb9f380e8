/// Identifies an analysis: the runs that a study asks for at once.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <string>

namespace wingspread {

/// A text that identifies these runs: the campaign's hash, the range, and a hash of the outputs kept and of the draws
/// of the first and last run. The draws are included because a study may place runs at points of its own.
[[nodiscard]] std::string analysis_id(const RunPlan& plan, RunRange range);

} // namespace wingspread
