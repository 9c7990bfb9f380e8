/// Refuses a trace that does not belong to its test: another hinge's, in another unit or sense, or with another time 0.
#pragma once

#include "montecarlo/analyses/fit/fit_spec.hpp"
#include "montecarlo/analyses/fit/trace_file.hpp"

#include <span>
#include <vector>

namespace wingspread {

/// Compares the trace with some runs of the test, drawn from the prior. Notes a problem for each column that does not
/// resemble its own prediction, but resembles another column's, or its own after a change of unit, sense or time.
///
/// Heuristic rule. Let m be the least rms residual over the runs, as a share of the predicted range. A column is
/// refused if its own m is above 0.3, and if another explanation has m below 0.1 and five times smaller residuals. A
/// test within its prior is not refused: all runs of the prior would have to miss it by a third of the motion, and
/// another column fit.
/// @param columns the time's and those of the test, as read
/// @param fitted indices of fitted dispersions
void refuse_foreign_trace(const FitTest& test, const std::vector<std::size_t>& fitted,
                          std::span<const TraceColumn> columns);

} // namespace wingspread
