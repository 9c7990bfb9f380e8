/// The summary as text for a terminal (width: text_layout.hpp).
#pragma once

#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <string_view>

namespace wingspread {

/// Outcomes with shares and bounds, reasons, latch orders, statistics of every output hinge by hinge, accuracy,
/// tolerance limits, requirements with the runs that break them, stopping goals, and warnings.
/// @param title first line: campaign, number of runs, seed
/// @param folder of the files; empty: none
/// @param all    true: a line for every status and every output, and the accuracy of each. false: statuses without runs
///               share a line, and so do quiet outputs (is_quiet)
[[nodiscard]] std::string summary_table(const Summary& summary, std::string_view title,
                                        std::string_view folder, bool all = false);

/// The width that a stopping goal has found, as the goal states it: "1.2 %", "4.1 N·m"; of a requirement "decided" or
/// "open".
[[nodiscard]] std::string found_text(const GoalState& found);

/// A histogram as horizontal bars whose length is the density. Merges neighbouring bins down to at most 20. Each line
/// has its bin's lower edge and count.
/// @param width of the lines in columns, at least 40
[[nodiscard]] std::string draw_histogram(std::string_view name, std::string_view unit,
                                         const Histogram& histogram, int width);

} // namespace wingspread
