/// What an engineer writes with Boost.Odeint: dopri5 with dense output on a dense mass matrix,
/// events by bisection, run to t_end. The benchmark's yardstick for whole runs.
#pragma once

#include "core/scene/scene.hpp"

#include <vector>

namespace wingspread::study {

struct PlainOutcome {
  std::vector<double> latch_time,
      latch_rate;                  ///< of every hinge that latched, in Scene order; else 0
  std::vector<double> peak_moment; ///< N·m, Scene order
  long evaluations = 0;
};

/// @pre a chain of three panels on a fixed base, hinges in order, all with latches, no friction or
///      harness
/// @param first_latch_only end there
[[nodiscard]] PlainOutcome plain_odeint(const Scene& scene, double rtol, double t_end,
                                        bool first_latch_only);

} // namespace wingspread::study
