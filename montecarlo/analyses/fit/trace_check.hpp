/// Says when a trace is no trace of its test: another hinge's, in another unit or sense, or with another zero of time.
#pragma once

#include "montecarlo/analyses/fit/fit_spec.hpp"
#include "montecarlo/analyses/fit/trace_file.hpp"

#include <span>
#include <vector>

namespace wingspread {

/// Compares the trace with some runs of the test, drawn from the prior. Notes a problem for each column that does not
/// resemble its own prediction, but resembles another column's, or its own after a change of unit, sense or time.
///
/// Rule, heuristic: over the runs, the least root mean square of the column's residuals is above 0.3 of the predicted
/// range, and five times that of the other explanation, which is below 0.1 of its range. A test within its prior does not
/// come near: the prior's runs would have to be all wrong by a third of the motion, and another column right.
/// @param columns the time's and those of the test, as read
/// @param fitted indices of fitted dispersions
void refuse_foreign_trace(const FitTest& test, const std::vector<std::size_t>& fitted,
                          std::span<const TraceColumn> columns);

} // namespace wingspread
