/// A stop of a hinge: a contact that pushes and never pulls [Hunt & Crossley 1975]. Written for the stowed side; with
/// −s in place of s it is the stop at the far side, beyond the latched angle.
///
/// | symbol | meaning                                       | unit    |
/// |--------|-----------------------------------------------|---------|
/// | δ, δ̇   | penetration s (φ_contact − φ); its rate −s φ̇  | rad, rad/s |
/// | k, c   | stiffness; dissipation                        | N·m/rad, s/rad |
///
///     M = s k δ max(0, 1 + c δ̇)                                                                 (1)
///
/// in contact. Whether the hinge is in contact is a mode of the run, which changes at events (Edge::stop, far_stop).
#pragma once

#include "core/laws/hinge_law.hpp"

namespace wingspread {

template <class T> struct StopTerms {
  bool present;
  T sense;         ///< s
  T stiffness;     ///< k
  T dissipation;   ///< c
  T contact_angle; ///< φ_contact, rad
};

/// (1) as a law of real_hinge.hpp. @pre terms.present
template <class T> struct HingeStop {
  const StopTerms<T>& terms;
  const T& in_contact; ///< 1 or 0

  /// δ.
  [[nodiscard]] T depth(const T& angle) const {
    return terms.sense * (terms.contact_angle - angle);
  }
  /// max(0, 1 + c δ̇).
  [[nodiscard]] T push(const T& rate) const {
    return larger(fused(-terms.dissipation, T(terms.sense * rate), T(1)), T(0));
  }
  /// (1) in contact, N·m.
  [[nodiscard]] T moment(const T& angle, const T& rate) const {
    return terms.sense * terms.stiffness * depth(angle) * push(rate);
  }

  void add_moment(T& m, const T& angle, const T& rate) const {
    if (!any(in_contact > T(0))) return;
    m = fused(in_contact, moment(angle, rate), m);
  }
  void add_resistance(HingeResistance<T>& r, const T& angle, const T& rate) const {
    const T pushes = push(rate), contact = in_contact * terms.stiffness;
    r.stiffness = fused(contact, pushes, r.stiffness);
    r.damping =
        fused(select(pushes > T(0), contact, T(0)), terms.dissipation * depth(angle), r.damping);
  }
  /// (1) is a product of a line in φ and one in φ̇, cut at 0: its extremes lie at the corners, or are 0.
  void add_range(ValueRange<T>& m, const ValueRange<T>& angle, const ValueRange<T>& rate) const {
    if (!any(in_contact > T(0))) return;
    ValueRange<T> corners{T(0), T(0)};
    for (const T& a : {angle.low, angle.high})
      for (const T& v : {rate.low, rate.high}) corners.include(moment(a, v));
    m = m + scaled(in_contact, corners);
  }
  /// Unknown in contact: the slope of (1) is not bounded here, so the peak search takes samples.
  [[nodiscard]] auto has_slopes(const ValueRange<T>& /*angle*/) const {
    return !(in_contact > T(0));
  }
  void add_slopes(MomentSlopes<T>& /*m*/, const ValueRange<T>& /*angle*/,
                  const ValueRange<T>& /*rate*/) const {}
  /// ½ k δ².
  void add_potential(T& P, const T& /*latched*/, const T& angle) const {
    const T way = terms.contact_angle - angle;
    P = fused(in_contact * T(0.5) * terms.stiffness * way, way, P);
  }
};

} // namespace wingspread
