/// The part of a hinge's moment that is linear in angle and rate between two events: springs and harness
/// by two torques, viscous friction, exact friction of a sliding hinge, an engaged latch.
///
/// | symbol | meaning                                               | unit             |
/// |--------|-------------------------------------------------------|------------------|
/// | φ, φ̇   | relative angle and rate                               | rad, rad/s       |
/// | y      | φ − φ_latched                                         | rad              |
/// | M_0    | drive: the moment at y = 0, φ̇ = 0                     | N·m              |
/// | κ, δ   | stiffness and damping                                 | N·m/rad, N·m·s/rad |
/// | k, d   | stiffness and damping of the latch [Yudintsev, eq. 6] | N·m/rad, N·m·s/rad |
/// | b, τ_c | viscous friction; kinetic level of the exact friction | N·m·s/rad, N·m   |
/// | β      | the latch's backlash                                  | rad              |
///
///     M = M_0 − κ y − δ φ̇                                                                       (1)
///     M_0 = s·(spring − harness) at y = 0 − τ_c sign φ̇ [± k β/2]    κ = [k] − drive_slope    δ = [d] + b   (2)
///     P = ½ κ y² − M_0 y      (without friction)                                                 (3)
///
/// The terms in brackets act once the latch has engaged and bears.
#pragma once

#include "core/laws/hinge_terms.hpp"
#include "core/number/quintic.hpp"

#include <optional>

namespace wingspread {

template <class T> struct LinearLaw {
  T latched;   ///< rad
  T drive;     ///< M_0, N·m
  T stiffness; ///< κ, N·m/rad
  T damping;   ///< δ, N·m·s/rad
};

/// Adds the moment of an elastic hold, −k (φ − φ_stowed) − d φ̇, to the law of its hinge.
template <class T>
void add_hold(LinearLaw<T>& law, const T& stowed, const T& stiffness, const T& damping) {
  law.drive = fused(stiffness, stowed - law.latched, law.drive);
  law.stiffness = law.stiffness + stiffness, law.damping = law.damping + damping;
}

/// (2) for one state of the latch and of the exact friction.
/// @param friction exact friction of a sliding hinge, N·m
/// @param side from the latched angle to where an engaged latch bears: −β/2 or β/2, rad; none inside the backlash
template <class T>
[[nodiscard]] LinearLaw<T> linear_law(const HingeTerms<T>& hinge, bool engaged,
                                      const T& friction = T(0),
                                      const std::optional<T>& side = T(0)) {
  const bool bears = engaged && side.has_value();
  const T k = bears ? hinge.stiffness : T(0);
  const T d = bears ? hinge.damping : T(0);
  return {hinge.latched, hinge.drive + friction + (bears ? k * *side : T(0)), k - hinge.drive_slope,
          d + hinge.viscous};
}

/// (1), N·m.
template <class T>
[[nodiscard, gnu::always_inline]] inline T linear_moment(const LinearLaw<T>& law, const T& angle,
                                                         const T& rate) {
  return fused(-law.damping, rate, fused(-law.stiffness, angle - law.latched, law.drive));
}

/// (1) over a step, as a polynomial of time: its hull is the moment's range, its derivative's hull the
/// moment's change.
template <class T>
[[nodiscard]] Quintic<T> linear_moment(const LinearLaw<T>& law, const Quintic<T>& angle,
                                       const Quintic<T>& rate) {
  Quintic<T> moment;
  for (int k = 0; k < 6; ++k) moment[k] = linear_moment(law, angle[k], rate[k]);
  return moment;
}

/// (3), zero at the latched angle, J. @pre the law was made without friction
template <class T>
[[nodiscard, gnu::always_inline]] inline T potential(const LinearLaw<T>& law, const T& angle) {
  const T y = angle - law.latched;
  return y * fused(T(0.5) * law.stiffness, y, -law.drive);
}

} // namespace wingspread
