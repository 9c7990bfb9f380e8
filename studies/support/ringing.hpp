/// Counts the oscillations of a wing after its latches, which every method has to follow cycle by cycle.
#pragma once

#include "core/deployment.hpp"

namespace wingspread::study {

/// The ringing of one run.
struct Ringing {
  double fastest = 0; ///< largest angular frequency that oscillates, rad/s; 0: all overdamped
  /// ∫ ω/2π dt, ω that of the fastest mode which is still above the tolerance. Modes are those of
  /// the engaged latches at the configurations that the run passes through. Each engagement sets
  /// all of them to 1 rad/s; each decays at its own rate, down to atol + rtol·(the largest).
  double cycles = 0;
  /// ∫ ω/2π dt of the fastest mode that oscillates, above the tolerance or not: what an explicit
  /// method has to step over all the same, for its stability.
  double periods = 0;
  /// Half the times that the rates of engaged hinges changed sign, of the hinge where they did so
  /// most: seen, not computed; but a fast mode hides under a slower one that is larger.
  double seen = 0;
};

/// A panel on one latch without damping: one oscillation that does not decay.
struct PureTone {
  Scene scene;
  double omega;  ///< rad/s
  double cycles; ///< a whole number, until t_end
  double t_end;  ///< s
};
[[nodiscard]] PureTone pure_tone();

/// From a run of the scene as `how` says, to its t_end. Fixed base, no friction.
[[nodiscard]] Ringing ringing_of(const Scene& scene, const Integration& how);

} // namespace wingspread::study
