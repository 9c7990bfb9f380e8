/// What each column of runs.csv is, for files that can say so.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace wingspread {

struct ExportColumn {
  enum class Kind { run, status, draw, output, peaks_final, latch_order, reason };
  Kind kind;
  std::size_t index = 0; ///< of a draw or an output: its place in the row
  std::string name;      ///< as in runs.csv
  std::string unit;      ///< empty: none, or not one alone
  std::string description;
};

/// The columns in the order in which runs.csv has them.
[[nodiscard]] std::vector<ExportColumn> export_columns(const Campaign& campaign,
                                                       const ResultNames& names);

/// What is meant by an output of that name: "when root reaches its latched angle for the first time".
[[nodiscard]] std::string describe_output(const std::string& name);

/// The unit of a draw's numbers: that of all parameters that it is set to or added to; empty where they have none in
/// common, where it is a factor, and where a table stands between.
[[nodiscard]] std::string draw_unit(const Dispersion& dispersion);

} // namespace wingspread
