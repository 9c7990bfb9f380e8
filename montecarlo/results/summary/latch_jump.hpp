/// Latches whose damping, and not the wing, decides a peak: engaging at a rate ω, a latch with a damping d makes the
/// moment jump to d·ω. The damping is seldom measured.
///
/// On a flexible body the jump acts on the end segment alone, whose mass and inertia vary as 1/joints. Its
/// acceleration, and with it the force in its hinge, grows in proportion to the number of joints. So the force at that
/// instant depends on the segmentation, and does not estimate the panel's.
#pragma once

#include "core/outcome.hpp"
#include "core/scene/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// A latch whose jump exceeds half of its hinge's peak moment.
struct LatchJump {
  std::string hinge;
  double moment = 0; ///< d·|ω| at engagement, the largest if the latch engages several times, N·m
  double peak = 0;   ///< N·m
};

/// The latch jumps of one run, in the scene's order of hinges; none if peak moments are not known.
[[nodiscard]] std::vector<LatchJump> latch_jumps(const Scene& scene, const Outcome& outcome);

/// "latch damping makes most of the peak moment of root (57 %), tip (100 %): …", one line for all. @pre not empty
[[nodiscard]] std::string warning(std::span<const LatchJump> jumps);

/// The hinges whose peak force is at the instant at which a latch with damping engages on a flexible body, in the
/// scene's order; none if peak forces are not known.
[[nodiscard]] std::vector<std::string> forces_of_jumps(const Scene& scene, const Outcome& outcome);

/// "r.peak_force grows with the number of joints …", one line for all. @pre not empty
[[nodiscard]] std::string warning_of_forces(std::span<const std::string> hinges);

} // namespace wingspread
