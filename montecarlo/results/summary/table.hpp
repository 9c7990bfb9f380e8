/// The summary as text for a terminal: text_layout.hpp says how wide.
#pragma once

#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <string_view>

namespace wingspread {

/// Outcomes with their shares and bounds, why runs did not deploy, latch orders, and the mean,
/// standard deviation and quantiles of every output, hinge by hinge; then what the campaign asks
/// for: tolerance limits, requirements with the runs that break them, goals to stop at. Hinges that turn
/// through their neighbours are warned of.
/// @param title its first line: what was run, how often, from which seed.
/// @param folder where the files are; empty when there are none.
[[nodiscard]] std::string summary_table(const Summary& summary, std::string_view title,
                                        std::string_view folder);

/// A histogram as horizontal bars, their length as the density. Neighbouring bins are put together
/// until at most 20 are left; each line has its bin's lower edge and its count.
/// @param width of the lines, in columns, at least 40.
[[nodiscard]] std::string draw_histogram(std::string_view name, std::string_view unit,
                                         const Histogram& histogram, int width);

} // namespace wingspread
