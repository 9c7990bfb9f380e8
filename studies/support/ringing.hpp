/// Counts the oscillations of a wing after it latches. Every method has to follow them cycle by cycle.
#pragma once

#include "core/deployment.hpp"

namespace wingspread::study {

/// The ringing of one run.
struct Ringing {
  double fastest = 0; ///< largest angular frequency that oscillates, rad/s; 0: all overdamped
  /// ∫ ω/2π dt, with ω of the fastest mode that is still above the tolerance. The modes are those of the engaged latches
  /// at each configuration of the run. Each engagement sets the sizes of all modes to 1 rad/s; then each mode decays at
  /// its own rate. The tolerance is atol + rtol·(the largest mode).
  double cycles = 0;
  /// ∫ ω/2π dt of the fastest oscillating mode, above the tolerance or not: it limits the steps of an explicit method,
  /// which must stay stable.
  double periods = 0;
  /// Half the number of sign changes of an engaged hinge's rate, for the hinge with the most. This is observed, not
  /// computed from modes. A large slow mode can hide a small fast one.
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

/// The ringing of a run of the scene with the settings `how`, to its t_end. @pre fixed base, no friction
[[nodiscard]] Ringing ringing_of(const Scene& scene, const Integration& how);

} // namespace wingspread::study
