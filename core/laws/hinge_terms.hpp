/// The numbers of a hinge that every wing has: springs and harness by two torques, friction, latch.
///
/// s = sign(φ_latched − φ_stowed). All torques act along the travel; the factor s turns them to the sense of φ.
#pragma once

#include "core/number/scalar.hpp"
#include "core/scene/scene.hpp"

namespace wingspread {

template <class T> struct HingeTerms {
  T stowed, latched; ///< rad
  T sense;           ///< s; 0 of an elastic joint, which has no travel
  T drive;           ///< s·(spring − harness) at the latched angle, N·m
  T drive_slope;     ///< the derivative of s·(spring − harness) by φ, N·m/rad
  T viscous;         ///< b, N·m·s/rad
  // A hinge has one of the two models of Coulomb friction, and zeros for the other.
  T regularized_friction; ///< τ_c, N·m
  T slip_rate;            ///< ω_s of the regularized friction, rad/s
  T kinetic_friction;     ///< τ_c of the exact friction, N·m
  T static_friction;      ///< τ_s of the exact friction, the largest moment it holds, N·m
  /// The largest level that a measured spring (torque test both ways) adds to the regularized or the exact model, N·m;
  /// 0 without one.
  T measured_regularized, measured_exact;
  bool has_latch;
  T stiffness;   ///< k of the engaged latch, N·m/rad
  T damping;     ///< d of the engaged latch, N·m·s/rad
  T dissipation; ///< k c of a smoothed latch, N·m·s/rad²; an event latch uses LatchDissipation

  /// Whether the friction is exact, so that the hinge can stick.
  [[nodiscard]] bool can_stick() const { return static_friction + measured_exact > T(0); }
  /// Largest moment of regularized friction, N·m.
  [[nodiscard]] T most_regularized() const { return regularized_friction + measured_regularized; }
  /// Largest moment that exact friction holds, N·m.
  [[nodiscard]] T most_static() const { return static_friction + measured_exact; }
  /// Largest moment of friction of either model, N·m.
  [[nodiscard]] T most_friction() const { return most_regularized() + most_static(); }
};

namespace detail {

/// The linear part of a torque: scale · line + offset, N·m; only the offset if a table replaces the line.
/// @param line value of the line at one end of the travel, N·m
template <class T> [[nodiscard]] T linear_part(const HingeTorque& torque, double line) {
  return torque.table ? T(torque.offset) : T(torque.scale) * T(line) + T(torque.offset);
}

/// Sets all terms of an elastic joint: a linear law about φ_0, without a sense of deployment.
template <class T> void set_joint(HingeTerms<T>& terms, const Hinge& hinge, const Joint& joint) {
  terms = HingeTerms<T>{};
  terms.stowed = terms.latched = T(hinge.stowed);
  terms.drive_slope = T(-joint.stiffness);
  terms.viscous = T(joint.damping);
  terms.slip_rate = T(1);
}

/// Sets all terms but measured_regularized and measured_exact, which it clears.
/// Assigned in place: copying a freshly written struct stalls store forwarding.
template <class T> void set_hinge(HingeTerms<T>& terms, const Hinge& hinge) {
  if (hinge.joint) return set_joint(terms, hinge, *hinge.joint);
  const T travel = T(hinge.latched) - T(hinge.stowed);
  const T sense = select(travel > T(0), T(1), T(-1));
  const T at_stowed = linear_part<T>(hinge.spring, hinge.spring.torque_stowed) -
                      linear_part<T>(hinge.harness, hinge.harness.torque_stowed);
  const T at_latched = linear_part<T>(hinge.spring, hinge.spring.torque_latched) -
                       linear_part<T>(hinge.harness, hinge.harness.torque_latched);
  terms.stowed = T(hinge.stowed);
  terms.latched = T(hinge.latched);
  terms.sense = sense;
  terms.drive = sense * at_latched;
  terms.drive_slope = sense * (at_latched - at_stowed) / travel;
  const bool exact = hinge.friction.model == FrictionModel::exact;
  const T scale(hinge.friction.scale), level = scale * T(hinge.friction.coulomb);
  terms.regularized_friction = exact ? T(0) : level;
  terms.kinetic_friction = exact ? level : T(0);
  terms.static_friction =
      exact ? scale * T(hinge.friction.static_level.value_or(hinge.friction.coulomb)) : T(0);
  terms.viscous = scale * T(hinge.friction.viscous);
  terms.slip_rate = T(hinge.friction.regularization_rate);
  terms.measured_regularized = terms.measured_exact = T(0);
  terms.has_latch = hinge.latch.has_value();
  terms.stiffness = T(hinge.latch ? hinge.latch->stiffness : 0);
  terms.damping = T(hinge.latch ? hinge.latch->damping : 0);
  terms.dissipation = terms.stiffness * T(hinge.latch ? hinge.latch->dissipation.value_or(0) : 0);
}

} // namespace detail

} // namespace wingspread
