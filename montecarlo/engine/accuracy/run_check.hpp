/// A check of one run: the same scene again by another method at a tighter tolerance, output by output.
#pragma once

#include "core/deployment.hpp"

#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// An output by both integrations; NaN where it did not happen.
struct CheckedOutput {
  std::string name; ///< as in runs.csv
  double value = 0, reference = 0;
  /// Decimal digits that agree. 16 if both magnitudes are below what the tolerances resolve: atol for angles and rates,
  /// and rtol times the run's largest output of the same unit.
  int digits = 0;
  /// Whether it differs by more than 1 % and by more than the tolerances resolve, or happened in only one of the two.
  bool moved = false;
};

struct RunCheck {
  std::string method; ///< of the reference, as is `rtol`
  double rtol = 0;
  std::string status, latch_order; ///< of the reference
  bool agrees = false;             ///< its status and latch order are those of the run
  std::vector<CheckedOutput> outputs;
};

/// The number of decimal digits in which two numbers agree: ⌊−log10 of their difference over the larger magnitude⌋,
/// from 0 to 16; 16 for equal numbers.
[[nodiscard]] int agreeing_digits(double a, double b);

/// Repeats a run with the first usable reference (references_of in accuracy.hpp).
/// @param own of the scene with this integration and goal; neither failed nor invalid
/// @return nothing if no reference can finish the run
[[nodiscard]] std::optional<RunCheck> check_run(const Scene& scene, const Integration& integration,
                                                const Goal& goal, const Outcome& own);

} // namespace wingspread
