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
  long scored = 0;     ///< what errors, evaluations and steps are of
  long mismatches = 0; ///< another latch order or number, or another status, than the reference
  long failures = 0;   ///< runs that did not come to an end
  std::string reason;  ///< of one of the failures
  FigureErrors errors;
  double evaluations = 0, steps = 0; ///< mean of a scored run
  /// Processor time of a run, mean of all scenes, in the best of several passes; NaN when no scene
  /// is scored.
  double microseconds = 0;
};

/// @param references of the scenes, one by one
/// @param patience   how long passes are timed at least, s
[[nodiscard]] Measurement measure(const Run& run, std::span<const Scene> scenes,
                                  std::span<const Figures> references, const Integration& how,
                                  Extent extent, double patience);

} // namespace wingspread::study
