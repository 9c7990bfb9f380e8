/// The wing to scale: WING of page/DATA.md. And what its modes leave open, in words.
///
/// A scene has the positions of a body's hinges and its plate, but no outline. A body is drawn as a panel from its own
/// hinge to the next. Its thickness is the hinges' offset from its middle. The last panel of a wing is symmetric about
/// its centre of mass. A body with hinges far off any line is drawn as lines from its centre of mass to the hinges.
///
/// A frame's origin is the body's own hinge, so a pose is a rotation and a translation: with θ the absolute angle,
/// o = o_p + R(θ_p) joint_in_parent, θ = θ_p + φ.
#pragma once

#include "core/proofs/natural_modes.hpp"
#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wingspread {

struct BodyOutline {
  std::vector<Eigen::Vector2d> points; ///< in the frame of the centre of mass, m
  bool closed = true;
};

/// @param body its index
[[nodiscard]] BodyOutline body_outline(const Scene& scene, int body);

/// The longer side of the deployed wing's bounding box, base included, m.
[[nodiscard]] double wing_span(const Scene& scene);

/// @param scene the scene of the nominal wing
[[nodiscard]] Json wing_json(const Scene& scene);

/// Notes on the angles at rest: stops that are pressed or touched there, hinges that rest far from their latched angle.
/// Empty for an ordinary latched wing.
[[nodiscard]] std::vector<std::string> modes_notes(const WingModes& modes);

} // namespace wingspread
