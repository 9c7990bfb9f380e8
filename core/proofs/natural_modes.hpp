/// The natural modes of a deployed wing: frequencies, damping ratios and shapes of small swings about rest.
///
///     K v = ω² M v,   f = ω/2π,   ζ = vᵀC v/(2 ω vᵀM v)                                          (1)
///
/// of the linear model M ü + C u̇ + K u = 0 (rest_model.hpp). ζ is exact where v is a mode of C too, as for one hinge or
/// damping in proportion to stiffness; elsewhere it is the usual modal damping, which leaves out C's coupling of modes.
///
/// A stop that the wing presses at rest is a spring and damper like its latch (stop.hpp; damping k c δ with δ at rest);
/// a stop that it does not reach counts for nothing. Small swings have no friction but the viscous one, no power-law
/// damper (its damping depends on the swing), no backlash, and no air. A prescribed base stands still at its initial
/// angle; its constant acceleration acts.
/// A motor has the last rate w of its command. Within its torque limit T it is a damper of its gain c about that rate,
/// beyond it a constant torque:
///
///     M = c (w − φ̇)  if c |w| < T,    else M = ± T without damping                               (2)
///
/// Its torque at rest, c w or ± T, moves the rest. A hinge that is held has no motor.
#pragma once

#include "core/scene/segments.hpp"

#include <optional>
#include <vector>

namespace wingspread {

struct NaturalMode {
  double frequency = 0;      ///< Hz, without damping; 0: nothing holds the wing in this shape
  double damping_ratio = 0;  ///< ζ, 1; 0 at frequency 0
  std::vector<double> shape; ///< angles of the hinges of WingModes::wing, the largest 1, rad
  double base_angle = 0;     ///< of a free base in the same unit, rad
};

/// A wing at rest, and how it swings.
struct WingModes {
  SegmentedScene wing;            ///< the scene, its flexible bodies as segments
  std::vector<double> rest;       ///< angles of all its hinges, rad
  std::vector<NaturalMode> modes; ///< lowest frequency first
};

/// Finds all modes. Cost O(n³) with n hinges.
/// @param latched hinges whose latches are engaged; all others with a latch are held at their stowed angles, rigidly or by
///                the stiffness and damping of an elastic hold. None: all latches are engaged
/// @return none if no rest was found
/// @pre unphysical(scene) is empty, and the hinges form a tree
[[nodiscard]] std::optional<WingModes>
natural_modes(const Scene& scene, const std::optional<std::vector<int>>& latched = std::nullopt);

/// The frequencies alone of the deployed wing, lowest first, Hz; empty if the scene is unphysical or has no rest.
[[nodiscard]] std::vector<double> natural_frequencies(const Scene& scene);

} // namespace wingspread
