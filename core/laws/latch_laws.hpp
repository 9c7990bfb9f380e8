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
/// linear_law.hpp has the term −k e. This law adds the other term, which dissipates the power k c |e| φ̇² ≥ 0. σ is a
/// mode of the run, which changes at events (Edge::backlash_low, Edge::backlash_high): between two events (1) is
/// smooth. Unlike a stop, the latch also pulls.
///
/// Capture: whether a latch engages where the hinge passes its latched angle, and whether it lets go again. Here e is
/// counted along the travel and without the backlash:
///
/// | symbol | meaning                                                            | unit              |
/// |--------|--------------------------------------------------------------------|-------------------|
/// | e      | s (φ − φ_latched): beyond the latched angle, in the deploying sense | rad              |
/// | β      | the latch's backlash                                               | rad               |
/// | k, d   | stiffness, damping of the latch                                    | N·m/rad, N·m·s/rad |
/// | c      | dissipation, in place of d                                         | s/rad             |
/// | M_h    | holding moment                                                     | N·m               |
///
/// A pass engages the latch if |φ̇| is at most the capture rate; else the hinge goes on, and the next pass, from either
/// side, may engage. An engaged latch that bears on its stowed side, e < −β/2, and pulls towards the latched angle by
///
///     L = −k (e + β/2) − d ė + k c (e + β/2) ė                                                  (2)
///
/// lets go where L reaches M_h. A pass is an event (Edge::pass), and letting go is one (Event::let_go).
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

/// The dissipation of (1), −k c σ e φ̇, as a law of real_hinge.hpp. @pre terms.present
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

template <class T> struct CaptureTerms {
  bool
      present; ///< whether the hinge may pass its latched angle without engaging, or come loose again
  T fastest;   ///< capture rate, rad/s
  T holding;   ///< M_h
  T sense;     ///< s
  T start;     ///< φ where e = −β/2, rad
  T stiffness;   ///< k
  T damping;     ///< d
  T dissipation; ///< k c

  /// Whether the latch may let go at all.
  [[nodiscard]] auto may_let_go() const { return holding < T(1e300); }

  /// e + β/2, < 0 where the latch bears on its stowed side.
  [[nodiscard]] T deflection(const T& angle) const { return sense * (angle - start); }

  /// L − M_h. @pre e ≤ −β/2
  [[nodiscard]] T excess(const T& angle, const T& rate) const {
    const T e = deflection(angle), v = sense * rate;
    return fused(fused(dissipation, e, -damping), v, fused(-stiffness, e, -holding));
  }
  /// dL/dt.
  [[nodiscard]] T excess_rate(const T& angle, const T& rate, const T& acceleration) const {
    const T e = deflection(angle), v = sense * rate, a = sense * acceleration;
    return fused(fused(dissipation, e, -damping), a, fused(dissipation * v, v, -stiffness * v));
  }

  /// Whether the latch lets go at this angle and rate.
  [[nodiscard]] bool lets_go(const T& angle, const T& rate) const {
    return deflection(angle) < T(0) && excess(angle, rate) >= T(0);
  }

  /// Upper bound of L − M_h over ranges of angle and rate, as far as e ≤ −β/2; −M_h if e > −β/2 in the whole range.
  [[nodiscard]] T most_excess(const ValueRange<T>& angle, const ValueRange<T>& rate) const {
    const T first = deflection(angle.low), last = deflection(angle.high);
    const T back = smaller(smaller(first, last), T(0)); // e + β/2 within [back, front]
    const T front = smaller(larger(first, last), T(0));
    const T v0 = sense * rate.low, v1 = sense * rate.high;
    const T least = smaller(v0, v1), most_rate = larger(v0, v1);
    const T of_damping = damping * T(-least);
    // k c (e + β/2) ė is bilinear: largest at a corner of the ranges
    T of_dissipation = larger(T(back * least), T(back * most_rate));
    of_dissipation = larger(of_dissipation, larger(T(front * least), T(front * most_rate)));
    const T most = fused(dissipation, of_dissipation, fused(-stiffness, back, of_damping));
    return select(back < T(0), most, T(0)) - holding;
  }
};

/// @param sense sign(φ_latched − φ_stowed)
template <class T> [[nodiscard]] CaptureTerms<T> capture_terms(const Hinge& hinge, const T& sense) {
  CaptureTerms<T> terms{};
  terms.fastest = terms.holding = T(1e300), terms.sense = sense;
  if (!hinge.latch || !hinge.latch->can_miss()) return terms;
  const Latch& latch = *hinge.latch;
  terms.present = true;
  terms.fastest = T(latch.capture_rate.value_or(1e300));
  terms.holding = T(latch.holding_moment.value_or(1e300));
  terms.start = fused(T(-0.5) * sense, T(latch.backlash), T(hinge.latched));
  terms.stiffness = T(latch.stiffness), terms.damping = T(latch.damping);
  terms.dissipation = T(latch.stiffness) * T(latch.dissipation.value_or(0));
  return terms;
}

} // namespace wingspread
