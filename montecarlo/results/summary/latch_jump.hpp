/// Latches whose damping, and not the wing, decides the peak: engaging at a rate ω, a latch with a damping d makes the
/// moment jump to d·ω. The damping is seldom measured.
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
  double moment = 0; ///< d·|ω| at engagement, N·m
  double peak = 0;   ///< N·m
};

/// The latch jumps of one run, in the scene's order of hinges; none if peak moments are not known.
[[nodiscard]] std::vector<LatchJump> latch_jumps(const Scene& scene, const Outcome& outcome);

/// "latch damping makes most of the peak moment of root (57 %), tip (100 %): …", one line for all. @pre not empty
[[nodiscard]] std::string warning(std::span<const LatchJump> jumps);

} // namespace wingspread
