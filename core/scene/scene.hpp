/// A scene: the parameters of one wing or of a spacecraft with its wings.
///
/// Planar. SI units and radians throughout. Hinge vectors are given in their own body's frame, from
/// its centre of mass. A hinge's angle is that of its child relative to its parent.
#pragma once

#include "core/scene/base_table.hpp"
#include "core/scene/curve.hpp"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A flat plate in the air, seen edge on: it resists motion along its normal (ground tests).
struct Plate {
  Eigen::Vector2d from{0, 0}, to{0, 0}; ///< its edges, body's frame, m
  double width = 0;                     ///< along the hinge lines, m, ≥ 0
  double drag_coefficient = 0; ///< C, 1, ≥ 0: pressure ½ ρ C v² on the normal velocity v
};

/// A uniform panel that bends along its plate: rigid segments with elastic joints between them (segments.hpp).
struct Flexible {
  int joints = 1; ///< N, 1 … most_joints
  // one of the two is given
  std::optional<double> bending_stiffness{}; ///< EI, N·m², > 0
  std::optional<double> frequency{}; ///< the first, of the panel clamped at one end, Hz, > 0
  double damping_ratio = 0;          ///< ζ of that first mode, ≥ 0
};
inline constexpr int most_joints = 32; ///< of a flexible body

/// A body, rigid unless flexible. Its frame sits in its centre of mass.
struct Body {
  std::string name;
  double mass = 0;    ///< kg, > 0
  double inertia = 0; ///< about the centre of mass, kg·m², > 0
  std::optional<Plate> plate{};
  std::optional<Flexible> flexible{}; ///< needs a plate, which gives its length and direction
};

/// A table of measured torque against hinge angle, one way or both.
class TorqueTable {
public:
  /// @pre angle strictly monotone, at least two; torque (deploying, stowing) as many; all finite
  TorqueTable(std::vector<double> angle, std::vector<double> torque, Interpolation interpolation);
  TorqueTable(std::vector<double> angle, std::vector<double> deploying, std::vector<double> stowing,
              Interpolation interpolation);

  /// The columns as given, for writing the table out.
  [[nodiscard]] const std::vector<double>& angle() const { return angle_; } ///< rad
  /// The torque; of a test both ways, the torque delivered while deploying, N·m.
  [[nodiscard]] const std::vector<double>& deploying() const { return deploying_; }
  /// Torque needed to stow the hinge again, N·m; empty unless tested both ways.
  [[nodiscard]] const std::vector<double>& stowing() const { return stowing_; }
  [[nodiscard]] bool both_ways() const { return !stowing_.empty(); }
  [[nodiscard]] Interpolation interpolation() const { return interpolation_; }

  /// ½ (stowing + deploying), or the torque, against hinge angle.
  [[nodiscard]] const Curve& drive() const { return drive_; }
  /// ½ (stowing − deploying): measured level of Coulomb friction; without pieces unless tested both ways.
  [[nodiscard]] const Curve& friction() const { return friction_; }

private:
  std::vector<double> angle_, deploying_, stowing_;
  Interpolation interpolation_ = Interpolation::monotone;
  Curve drive_, friction_;
};

/// Torque of a spring or a harness over the hinge's travel, N·m: scale · law + offset. The law is
/// linear in the share of travel x = (φ − stowed)/(latched − stowed), or a table of hinge angles.
struct HingeTorque {
  double torque_stowed = 0;                   ///< at x = 0
  double torque_latched = 0;                  ///< at x = 1
  std::shared_ptr<const TorqueTable> table{}; ///< replaces the two torques; null: none
  double scale = 1;
  double offset = 0; ///< N·m
};

enum class FrictionModel { regularized, exact };

/// Friction of a hinge.
struct Friction {
  double coulomb = 0;                 ///< kinetic level τ_c, N·m, ≥ 0
  double viscous = 0;                 ///< b, N·m·s/rad, ≥ 0
  double regularization_rate = 1e-3;  ///< ω_s, rad/s, > 0; used by the regularized model
  std::optional<double> static_level; ///< τ_s ≥ τ_c, N·m; used by the exact model
  FrictionModel model = FrictionModel::regularized;
  double scale = 1; ///< of all friction of the hinge, measured friction included, ≥ 0
};

enum class DamperLaw { viscous, power, eddy_current };

/// A damper: its moment opposes the rate of its hinge.
struct Damper {
  DamperLaw law = DamperLaw::viscous;
  double coefficient = 0;            ///< viscous: N·m·s/rad; power law: N·m·(s/rad)^p; ≥ 0
  double exponent = 1;               ///< p of the power law, > 0
  double regularization_rate = 1e-6; ///< of the power law, linear below it, rad/s, > 0
  double peak_torque = 0;            ///< T_p of the eddy currents, N·m, ≥ 0
  double peak_rate = 1;              ///< ω_p, rate of the peak torque, rad/s, > 0
  /// Hinge angles between which the damper acts, in any order, rad; none: everywhere.
  std::optional<std::array<double, 2>> window;
  double scale = 1; ///< ≥ 0
};

/// A stop [Hunt & Crossley 1975]: with a penetration δ > 0 it pushes by k δ (1 + c δ̇), and never pulls. At the
/// stowed side δ = −travel − gap; at the far side δ is how far the hinge is beyond its latched angle, less the gap.
struct Stop {
  double stiffness = 0;   ///< k, N·m/rad, ≥ 0
  double dissipation = 0; ///< c, s/rad, ≥ 0
  double gap = 0;         ///< rad, ≥ 0
};

/// A latch: once engaged, a spring and a damper about the latched angle.
struct Latch {
  double stiffness = 0; ///< k, N·m/rad, ≥ 0
  double damping = 0;   ///< d, N·m·s/rad, ≥ 0
  double backlash = 0;  ///< β, rad, ≥ 0: no moment within ±β/2 of the latched angle
  /// c, s/rad, ≥ 0, in place of `damping`: damps by k c |deflection|, so that the moment has no jump at engagement.
  std::optional<double> dissipation{};
  /// rad/s, ≥ 0: a hinge that passes its latched angle faster does not engage; none: it always does.
  std::optional<double> capture_rate{};
  /// N·m, > 0: smallest load towards stowed at which an engaged latch lets go; none: it never does.
  std::optional<double> holding_moment{};

  /// Whether the latch may miss the hinge, which passes too fast, or let it go again.
  [[nodiscard]] bool can_miss() const { return capture_rate || holding_moment; }
};

/// When a held hinge is released: `delay` after a time, or after an event of another hinge. Until then the hinge is
/// held at its stowed angle, rigidly unless it has a Hold.
struct Release {
  enum class Event {
    time,
    latched,  ///< the other hinge latches for the first time
    released, ///< its hold lets go
    passed    ///< its travel reaches `angle` for the first time
  };
  Event event = Event::time;
  double time = 0;  ///< of Event::time, s, ≥ 0
  int after = -1;   ///< the other hinge, index into Scene::hinges; −1 of Event::time
  double angle = 0; ///< of Event::passed, rad, > 0: sense (φ − stowed) of the other hinge
  double delay = 0; ///< s, ≥ 0
  double fails = 0; ///< 1: the hold never lets go; else 0
};

/// An elastic hold: −k (φ − φ_stowed) − d φ̇ until the hinge's release.
struct Hold {
  double stiffness = 0; ///< k, N·m/rad, > 0
  double damping = 0;   ///< d, N·m·s/rad, ≥ 0
};

/// A motor: from its hinge's release on it drives the travel x at a commanded rate r by clamp(c (r − ẋ), −T, T).
struct Motor {
  double rate = 0; ///< r, rad/s; positive deploys
  /// r against the time since release, rad/s against s, in place of `rate`; and the table as given.
  std::shared_ptr<const Curve> table{};
  std::vector<double> time{}, rates{};
  Interpolation interpolation = Interpolation::monotone;
  double scale = 1;        ///< factor of the table
  double gain = 0;         ///< c, N·m·s/rad, ≥ 0
  double torque_limit = 0; ///< T, N·m, ≥ 0
};

/// An elastic joint: −k (φ − φ_0) − d φ̇ from the start.
struct Joint {
  double stiffness = 0; ///< k, N·m/rad, > 0
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
  HingeTorque spring;                 ///< positive deploys
  HingeTorque harness;                ///< positive resists
  Friction friction;
  std::optional<Damper> damper{};
  std::optional<Stop> stop{};       ///< none: the hinge turns through its stowed angle
  std::optional<Stop> far_stop{};   ///< beyond the latched angle
  std::optional<Latch> latch;       ///< none: the hinge never latches
  std::optional<Release> release{}; ///< none: free from the start
  std::optional<Hold> hold{};       ///< only with a release; none: the hinge is held rigidly
  std::optional<Motor> motor{};
  /// In place of all laws above. The hinge then starts and rests at φ_0 = `stowed` = `latched`.
  std::optional<Joint> joint{};
};

/// A closed cable loop that ties one hinge's travel x = sense (φ − stowed) to a function g of another's. With
/// e = g(x_first) − x_second it pulls the second hinge by τ = K e + D ė and the first by −g' τ. A strand of a
/// preloaded loop goes slack at K |e| = 2 M_p; beyond, τ = ½ K e + M_p sign e + ½ D ė.
struct Synchronisation {
  std::string name;
  int first = 0, second = 0; ///< indices into Scene::hinges
  double ratio = 1;          ///< g(x) = ratio·x
  /// g by a table, straight beyond its ends; replaces the ratio.
  std::shared_ptr<const Curve> table;
  std::vector<double> travel, travel_of_second; ///< the table as given, rad
  double stiffness = 0;                         ///< K, N·m/rad, ≥ 0
  double damping = 0;                           ///< D, N·m·s/rad, ≥ 0
  std::optional<double> preload; ///< M_p, strand tension times radius, N·m, > 0; none: never slack
};

/// Gravity and air.
struct Environment {
  Eigen::Vector2d gravity{0, 0}; ///< inertial axes, m/s²
  double air_density = 0;        ///< ρ, kg/m³, ≥ 0; the air is at rest
};

enum class BaseMotion { fixed, prescribed, free };

/// The body that carries the wings. Fields of other motions than its own are ignored.
struct Base {
  BaseMotion motion = BaseMotion::fixed;
  // prescribed: constant accelerations; a table replaces those that it gives
  Eigen::Vector2d acceleration{0, 0}; ///< of the origin, inertial axes, m/s²
  double angular_acceleration = 0;    ///< rad/s²
  std::shared_ptr<const BaseTable> table{};
  double table_scale = 1; ///< factor of all columns of the table
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
  std::vector<Synchronisation> synchronisations{};
  Environment environment{};
};

/// A parameter with an unphysical value.
struct Fault {
  std::string path;     ///< e.g. "bodies.panel_1.mass"
  std::string found;    ///< the value
  std::string expected; ///< a condition that the value must meet, e.g. "> 0"
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
