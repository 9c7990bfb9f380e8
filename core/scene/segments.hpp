/// Flexible bodies as rigid segments with elastic joints between them.
///
/// | symbol | meaning                                                              | unit        |
/// |--------|----------------------------------------------------------------------|-------------|
/// | N      | joints, and equal elements of the panel, each with a joint in its middle |         |
/// | L, m, J | length of the plate; the body's mass and central inertia            | m, kg, kg·m² |
/// | l_j, x_j | length of segment j = 0 … N; its place along the plate, from the centre of mass | m |
/// | ρ_j    | m_j l_j²/12, the inertia of a rod                                    | kg·m²       |
/// | EI, ω_1, ζ | bending stiffness; first frequency if clamped at one end; its damping ratio | N·m², rad/s, 1 |
///
///     m_j = m/N, half as much at the two ends                                                   (1)
///     J_j = ρ_j + (J − m L²/12) m_j/m                                                           (2)
///     k = N EI/L,  d = 2 ζ k/ω_1                                                                (3)
///     ω_1 = β² √(EI/(m L³)),  β = 1.8751…                                                       (4)
///
/// Mass, centre of mass and inertia are the body's: Σ m_j x_j² + Σ ρ_j is a rod's m L²/12. A body with less inertia
/// than a rod has more of its mass towards the middle (draws of mass and inertia make such bodies):
///
///     m_j = m l_j/L (1 + a (s − x_j²)),  s = Σ x_j² l_j/L,  J_j = ρ_j,  a such that the inertia is J   (5)
///
/// One joint makes two equal segments, for which (5) has no a: they have (2) with J_j < ρ_j.
///
/// Frequencies converge as 1/N² (with joints between equal segments as 1/N).
#pragma once

#include "core/scene/scene.hpp"

#include <vector>

namespace wingspread {

/// Whether (2) or (5) gives segments with masses and inertias > 0.
/// @pre the body is flexible, has a plate, and its mass and inertia are > 0
[[nodiscard]] bool can_be_cut(const Body& body);
/// The least inertia with which the body can be cut, kg·m², to 1e-9 of it: of m L²/12 0.75 with one joint, 0.325 with two, 0.5 with
/// three, up to some 0.64 with many. @pre that of can_be_cut
[[nodiscard]] double least_inertia(Body body);

/// EI, N·m²: given, or by (4) from the frequency. @pre the body is flexible and has a plate
[[nodiscard]] double bending_stiffness(const Body& body);

[[nodiscard]] bool has_flexible_bodies(const Scene& scene);

/// A scene without flexible bodies, and the parts of each.
struct SegmentedScene {
  /// The bodies and hinges of the given scene come first, with their names and indices: a flexible body is there the
  /// segment on its own hinge. Then follow the other segments and the joints, body by body.
  Scene scene;
  std::vector<std::vector<int>> joints; ///< by the given scene's bodies: indices into scene.hinges
  std::vector<std::vector<int>>
      segments; ///< the same, from plate.from on: indices into scene.bodies
};

/// Cuts every flexible body into segments. A hinge hangs on the segment beside its point.
/// @pre unphysical(scene) is empty, and the hinges form a tree
[[nodiscard]] SegmentedScene with_segments(const Scene& scene);

/// Whether both scenes have the same tree, hinge by hinge.
[[nodiscard]] bool have_same_tree(const Scene& a, const Scene& b);

} // namespace wingspread
