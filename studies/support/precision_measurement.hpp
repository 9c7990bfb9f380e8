/// One point of the work-precision chart: error against the references, and cost, of one method at one tolerance.
#pragma once

#include "core/deployment.hpp"
#include "studies/support/precision_figures.hpp"

#include <functional>
#include <span>
#include <string>

namespace wingspread::study {

/// Makes one run of a scene.
using Run = std::function<Outcome(const Scene& scene, const Integration& how, const Goal& goal)>;

/// End and outputs of a run.
enum class Extent {
  first_latch, ///< A: to the first latch
  moments,     ///< to t_end, with peak moments
  whole        ///< B: to t_end, with peak moments and forces
};
[[nodiscard]] Goal goal_of(Extent extent);

struct Measurement {
  long scenes = 0;
  long scored = 0;     ///< runs that errors, evaluations and steps include
  long mismatches = 0; ///< runs whose latches or status differ from the reference
  long failures = 0;   ///< runs that failed or were invalid
  std::string reason;  ///< of one of the failures
  FigureErrors errors;
  double evaluations = 0, steps = 0; ///< mean of a scored run
  /// Mean processor time of a run in the fastest of several passes over all scenes; NaN if no run is scored.
  double microseconds = 0;
};

/// @param references one for each scene, in the same order
/// @param patience   least time of all passes together, s
[[nodiscard]] Measurement measure(const Run& run, std::span<const Scene> scenes,
                                  std::span<const Figures> references, const Integration& how,
                                  Extent extent, double patience);

} // namespace wingspread::study
