/// Sobol' indices of all outputs of a Saltelli design.
#pragma once

#include "montecarlo/analyses/sensitivity/sobol_indices.hpp"
#include "montecarlo/engine/runs/results.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Sobol' indices of all outputs of a design.
struct SobolSensitivity {
  long rows = 0;  ///< N
  long runs = 0;  ///< number of runs made so far
  long total = 0; ///< N (d + 2)
  std::string design;
  SobolBounds bounds;
  std::vector<std::string> dispersions;
  struct Output {
    std::string name;
    SobolIndices indices;
    long cut = 0; ///< runs whose peak t_end cut (finality.hpp)
  };
  std::vector<Output> outputs;
  long open_latches =
      0; ///< deployed runs of which it is not proven that their latches stay engaged
  std::vector<std::string> unvaried{}; ///< dispersions with constant draws
  std::string_view never_final{};      ///< why no t_end proves peaks final (requirement_checks.hpp)
  /// Other dispersions without any effect: changing them alone changes no bit of any output, in any row.
  [[nodiscard]] std::vector<std::string> idle() const;
};

/// The indices of all outputs, and of `deployed` (deployed_column()) if it varies.
/// @param results     of a Saltelli design, beginning with its first run
/// @param coordinates names of the design's coordinates: all columns of one `rows` are one
[[nodiscard]] SobolSensitivity sobol_sensitivity(const Results& results,
                                                 std::vector<std::string> coordinates, long rows,
                                                 std::string design, const SobolBounds& bounds);

} // namespace wingspread
