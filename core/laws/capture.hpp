/// Whether a latch engages where the hinge passes its latched angle, and whether it lets go again.
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
///     L = −k (e + β/2) − d ė + k c (e + β/2) ė                                                  (1)
///
/// lets go where L reaches M_h. Passes are events (Edge::pass), and so is letting go.
#pragma once

#include "core/laws/range.hpp"
#include "core/scene/scene.hpp"

namespace wingspread {

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
  [[nodiscard]] auto may_open() const { return holding < T(1e300); }

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
  [[nodiscard]] bool opens(const T& angle, const T& rate) const {
    return deflection(angle) < T(0) && excess(angle, rate) >= T(0);
  }

  /// Upper bound of L − M_h where e ≤ −β/2, over ranges of angle and rate; −M_h where none of the angles is there.
  [[nodiscard]] T most_excess(const ValueRange<T>& angle, const ValueRange<T>& rate) const {
    const T first = deflection(angle.low), last = deflection(angle.high);
    const T back = smaller(smaller(first, last), T(0)); // e + β/2 within [back, front]
    const T front = smaller(larger(first, last), T(0));
    const T v0 = sense * rate.low, v1 = sense * rate.high;
    const T least = smaller(v0, v1), most_rate = larger(v0, v1);
    const T of_damping = damping * larger(T(-least), T(0));
    // k c e ė, e ≤ 0: largest at the ends
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
