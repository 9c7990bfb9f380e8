/// A scene: the parameters of one wing (or of a whole spacecraft with its wings), and nothing else.
///
/// Planar. SI units and radians throughout. Hinge vectors are given in their own body's frame, from
/// its centre of mass. A hinge's angle is that of its child relative to its parent.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A rigid body. Its frame sits in its centre of mass.
struct Body {
  std::string name;
  double mass = 0;    ///< kg, > 0
  double inertia = 0; ///< about the centre of mass, kg·m², > 0
};

/// A moment that is linear in the hinge's travel x = (φ − stowed)/(latched − stowed), N·m.
struct LinearTorque {
  double torque_stowed = 0;  ///< at x = 0
  double torque_latched = 0; ///< at x = 1
};

enum class FrictionModel { regularized, exact };

/// Friction of a hinge.
struct Friction {
  double coulomb = 0;                 ///< kinetic level τ_c, N·m, ≥ 0
  double viscous = 0;                 ///< b, N·m·s/rad, ≥ 0
  double regularization_rate = 1e-3;  ///< ω_s, rad/s, > 0; used by the regularized model
  std::optional<double> static_level; ///< τ_s ≥ τ_c, N·m; used by the exact model
  FrictionModel model = FrictionModel::regularized;
};

/// A latch: once engaged, a spring and a damper about the latched angle, for ever.
struct Latch {
  double stiffness = 0; ///< k, N·m/rad, ≥ 0
  double damping = 0;   ///< d, N·m·s/rad, ≥ 0
};

inline constexpr int base_index = -1; ///< `Hinge::parent` of a hinge on the base

/// A revolute hinge between a parent body (or the base) and its child.
struct Hinge {
  std::string name;
  int parent = base_index;            ///< index into Scene::bodies, or base_index
  int child = 0;                      ///< index into Scene::bodies
  Eigen::Vector2d parent_point{0, 0}; ///< c_pi, parent's frame, m
  Eigen::Vector2d child_point{0, 0};  ///< c_ii, child's frame, m
  double stowed = 0;                  ///< angle at the start, rad
  double latched = 0;                 ///< angle at which the latch engages, rad
  double initial_rate = 0;            ///< rad/s
  LinearTorque spring;                ///< positive deploys
  LinearTorque harness;               ///< positive resists
  Friction friction;
  std::optional<Latch> latch; ///< a hinge without one never latches
};

enum class BaseMotion { fixed, prescribed, free };

/// The body that carries the wings. Fields that its motion does not name are ignored.
struct Base {
  BaseMotion motion = BaseMotion::fixed;
  // prescribed: constant accelerations
  Eigen::Vector2d acceleration{0, 0}; ///< of the origin, inertial axes, m/s²
  double angular_acceleration = 0;    ///< rad/s²
  // prescribed and free: initial state
  double angle = 0; ///< rad
  double rate = 0;  ///< rad/s
  // free: a rigid body whose origin is its centre of mass
  double mass = 0;                ///< kg, > 0
  double inertia = 0;             ///< kg·m², > 0
  Eigen::Vector2d position{0, 0}; ///< m
  Eigen::Vector2d velocity{0, 0}; ///< m/s
};

/// A tree of bodies rooted at the base: every body is the child of exactly one hinge.
/// Hinges and bodies may stand in any order.
struct Scene {
  std::string name;
  Base base;
  std::vector<Body> bodies;
  std::vector<Hinge> hinges;
};

/// A parameter whose value physics forbids.
struct Fault {
  std::string path;     ///< e.g. "bodies.panel_1.mass"
  std::string found;    ///< the value
  std::string expected; ///< what would do, e.g. "> 0"
};

/// Every parameter of the scene that is unphysical: non-finite values, masses and inertias ≤ 0,
/// negative friction, stiffness or damping, a latch with no travel, a static level below the
/// kinetic one. Empty when the scene can be run. Cost O(n).
[[nodiscard]] std::vector<Fault> unphysical(const Scene& scene);

/// Hinge indices in an order in which each parent's hinge precedes its children's (depth first, so
/// that the panels of one wing are neighbours).
/// Returns an empty vector when the hinges do not form a tree that reaches every body from the
/// base.
[[nodiscard]] std::vector<int> outward_order(const Scene& scene);

} // namespace wingspread
