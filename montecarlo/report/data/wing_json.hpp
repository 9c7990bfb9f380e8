/// The wing to scale: WING of page/DATA.md.
///
/// A scene knows where a body's hinges and its plate are, not its outline. A body is drawn as a panel from its own hinge
/// to the next, as thick as its hinges stand off its middle; a last one reaches as far beyond its centre of mass as its
/// hinge stands before it. One whose hinges lie far off any line is drawn as lines from its centre of mass to them.
///
/// Frames here have their origin in the body's own hinge, so that a pose is a turn and a shift: with θ the absolute
/// angle, o = o_p + R(θ_p) joint_in_parent, θ = θ_p + φ.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <Eigen/Core>

#include <vector>

namespace wingspread {

struct BodyOutline {
  std::vector<Eigen::Vector2d> points; ///< in the frame of the centre of mass, m
  bool closed = true;
};

/// @param body its index
[[nodiscard]] BodyOutline body_outline(const Scene& scene, int body);

/// How far the wing reaches when deployed, base included: the longer side of what it fills, m.
[[nodiscard]] double wing_span(const Scene& scene);

/// @param scene of the nominal wing
[[nodiscard]] Json wing_json(const Scene& scene);

} // namespace wingspread
