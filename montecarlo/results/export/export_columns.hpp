/// Name, unit and description of each column of runs.csv, for file formats that store them.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace wingspread {

struct ExportColumn {
  enum class Kind { run, status, draw, output, peaks_final, latch_order, reason };
  Kind kind;
  std::size_t index = 0; ///< of a draw or an output: its position in the row
  std::string name;      ///< as in runs.csv
  std::string unit;      ///< empty: none, or several
  std::string description;
};

/// The columns in the order of runs.csv.
[[nodiscard]] std::vector<ExportColumn> export_columns(const Campaign& campaign,
                                                       const ResultNames& names);

/// The meaning of an output: "when root reaches its latched angle for the first time".
[[nodiscard]] std::string describe_output(const std::string& name);

/// The unit of a draw: the common unit of all parameters that the draw sets or adds to. Empty if the parameters have
/// different units, if the draw is a factor, or if the draw acts through a table.
[[nodiscard]] std::string draw_unit(const Dispersion& dispersion);

} // namespace wingspread
