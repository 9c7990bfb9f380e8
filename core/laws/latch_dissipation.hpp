/// A latch that damps in proportion to its deflection, as a contact does [Hunt & Crossley 1975]: its moment has no
/// jump where it engages.
///
/// | symbol | meaning                                                                      | unit  |
/// |--------|------------------------------------------------------------------------------|-------|
/// | σ      | side on which the engaged latch bears: 1 above the latched angle, −1 below, else 0 |  |
/// | e      | deflection beyond the backlash β: φ − φ_latched − σ β/2; where it bears σ e ≥ 0 | rad |
/// | k, c   | the latch's stiffness; dissipation                                           | N·m/rad, s/rad |
///
///     M = −k e − k c |e| φ̇ = −k e − k c σ e φ̇                                                   (1)
///
/// −k e is linear_law.hpp's; this law adds the rest, which takes k c |e| φ̇² ≥ 0 of power. A run keeps σ as a mode,
/// which changes at events (Edge::backlash_low, Edge::backlash_high): between two events (1) is smooth. Unlike a stop,
/// the latch also pulls.
#pragma once

#include "core/laws/hinge_law.hpp"
#include "core/scene/scene.hpp"

namespace wingspread {

template <class T> struct LatchDissipationTerms {
  bool present;
  T strength;      ///< k c, N·m·s/rad²
  T latched;       ///< rad
  T half_backlash; ///< β/2, rad
};

/// The second term of (1) as a law of real_hinge.hpp. @pre terms.present
template <class T> struct LatchDissipation {
  const LatchDissipationTerms<T>& terms;
  const T& side; ///< σ

  /// k c σ e, N·m·s/rad.
  [[nodiscard]] T damping(const T& angle) const {
    return terms.strength *
           fused(side, T(angle - terms.latched), -(side * side * terms.half_backlash));
  }
  [[nodiscard]] ValueRange<T> damping(const ValueRange<T>& angle) const {
    const T first = damping(angle.low), last = damping(angle.high);
    return {smaller(first, last), larger(first, last)};
  }

  void add_moment(T& m, const T& angle, const T& rate) const { m = m - damping(angle) * rate; }
  void add_resistance(HingeResistance<T>& r, const T& angle, const T& rate) const {
    r.stiffness = fused(side * terms.strength, rate, r.stiffness);
    r.damping = r.damping + damping(angle);
  }
  void add_range(ValueRange<T>& m, const ValueRange<T>& angle, const ValueRange<T>& rate) const {
    m = m + scaled(T(-1), damping(angle) * rate);
  }
  [[nodiscard]] auto has_slopes(const ValueRange<T>& /*angle*/) const { return T(0) <= T(0); }
  void add_slopes(MomentSlopes<T>& m, const ValueRange<T>& angle, const ValueRange<T>& rate) const {
    m.by_angle = m.by_angle + scaled(T(-(side * terms.strength)), rate);
    m.by_rate = m.by_rate + scaled(T(-1), damping(angle));
  }
  void add_potential(T& /*P*/, const T& /*latched*/, const T& /*angle*/) const {}
};

template <class T> [[nodiscard]] LatchDissipationTerms<T> dissipation_terms(const Hinge& hinge) {
  if (!hinge.latch || !hinge.latch->dissipation) return {};
  return {true, T(hinge.latch->stiffness) * T(*hinge.latch->dissipation), T(hinge.latched),
          T(0.5) * T(hinge.latch->backlash)};
}

} // namespace wingspread
