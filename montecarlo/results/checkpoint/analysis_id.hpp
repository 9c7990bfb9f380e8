/// What identifies a look: the runs that a study asked for at once.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <string>

namespace wingspread {

/// A text that another look does not have: of the campaign as it is run (its hash), what is kept of a run, the range,
/// and the draws of its first and its last run, for a study may put its runs at points of its own.
[[nodiscard]] std::string analysis_id(const RunPlan& plan, RunRange range);

} // namespace wingspread
