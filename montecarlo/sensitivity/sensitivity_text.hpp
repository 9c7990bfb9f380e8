/// What sensitivity analyses say: as JSON, as CSV, and as a table for a terminal.
///
/// JSON is strict: what is undefined is null. Numbers read back to the same double.
#pragma once

#include "montecarlo/formats/json_parse.hpp"
#include "montecarlo/sensitivity/rank_sensitivity.hpp"
#include "montecarlo/sensitivity/sobol_indices.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Sobol' indices of all outputs of a design.
struct SobolSensitivity {
  long rows = 0;  ///< N
  long runs = 0;  ///< made, of N (d + 2)
  long total = 0; ///< N (d + 2)
  std::string design;
  double confidence = 0.95;
  long resamples = 0;
  std::vector<std::string> dispersions;
  struct Output {
    std::string name;
    SobolIndices indices;
  };
  std::vector<Output> outputs;
  /// Dispersions without which every output of every row is the same, bit for bit.
  [[nodiscard]] std::vector<std::string> idle() const;
};

/// All outputs' indices, and those of `deployed` (deployed_column()) when it varies.
/// @param results of a Saltelli design, from its first run on
[[nodiscard]] SobolSensitivity sobol_sensitivity(const Results& results, long rows,
                                                 std::string design, const Bootstrap& bootstrap);

/// @param about the value of "wingspread"
[[nodiscard]] Json sensitivity_json(const RankSensitivity& all, const Json& about);
[[nodiscard]] Json sensitivity_json(const SobolSensitivity& all, const Json& about);

/// A line for each output and dispersion.
[[nodiscard]] std::string sensitivity_csv(const RankSensitivity& all);
[[nodiscard]] std::string sensitivity_csv(const SobolSensitivity& all);

/// Output by output, the dispersions that matter most first.
[[nodiscard]] std::string sensitivity_table(const RankSensitivity& all, std::string_view title);
[[nodiscard]] std::string sensitivity_table(const SobolSensitivity& all, std::string_view title);

/// What a designer should know before reading on; one a line, without its end.
[[nodiscard]] std::vector<std::string> warnings(const RankSensitivity& all);
[[nodiscard]] std::vector<std::string> warnings(const SobolSensitivity& all);

} // namespace wingspread
