/// The moment across a hinge: spring, harness, friction, latch.
///
/// | symbol | meaning                                                | unit      |
/// |--------|--------------------------------------------------------|-----------|
/// | φ, φ̇   | relative angle and rate                                | rad, rad/s|
/// | y      | φ − φ_latched                                          | rad       |
/// | s      | sign(φ_latched − φ_stowed)                             |           |
/// | S      | state of a smoothed latch, Ṡ = f(φ) [Yudintsev]        | s         |
/// | ε      | width of its smooth steps: rad in φ, s in S            | rad, s    |
///
///     M = s·(spring − harness) − b φ̇ + friction − [latched] (k y + d φ̇)    [Yudintsev, eq. 6]
///
///     friction, regularized:  −τ_c φ̇/√(φ̇² + ω_s²)
///     friction, exact:        −τ_c sign φ̇ while the hinge slides;
///                             what holds it, up to τ_s, while it sticks
///
/// All but the regularized friction is linear in φ and φ̇ from event to event, and kept in that
/// form.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/number/over_root.hpp"

#include <optional>

namespace wingspread {

/// The linear part of a hinge's moment while its latch keeps its state:
/// drive − stiffness·y − damping·φ̇.
template <class T> struct LinearLaw {
  T latched;   ///< rad
  T drive;     ///< N·m; with the friction of a hinge that slides
  T stiffness; ///< N·m/rad
  T damping;   ///< N·m·s/rad
};

/// @param friction of a sliding hinge, N·m
/// @param side from where on the engaged latch bears, less the latched angle: −β/2 or β/2 of its
///             backlash, rad; none where it bears on neither side
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

template <class T>
[[nodiscard, gnu::always_inline]] inline T linear_moment(const LinearLaw<T>& law, const T& angle,
                                                         const T& rate) {
  return fused(-law.damping, rate, fused(-law.stiffness, angle - law.latched, law.drive));
}

/// Regularized Coulomb friction; smooth, so that a hinge creeps where a real one would stick.
template <class T>
[[nodiscard, gnu::always_inline]] inline T regularized_friction_moment(const HingeTerms<T>& hinge,
                                                                       const T& rate) {
  return over_root(T(-(hinge.regularized_friction * rate)),
                   fused(rate, rate, hinge.slip_rate * hinge.slip_rate));
}

/// −d/dφ̇ of it: the damping that it is for small changes, N·m·s/rad.
template <class T>
[[nodiscard, gnu::always_inline]] inline T regularized_friction_damping(const HingeTerms<T>& hinge,
                                                                        const T& rate) {
  using std::sqrt;
  const T slip = hinge.slip_rate * hinge.slip_rate, square = fused(rate, rate, slip);
  return hinge.regularized_friction * slip / (square * sqrt(square));
}

/// h0 + Δh u²(3 − 2u) from 0 to 1 over u ∈ [0, 1]; constant outside.
template <class T> [[nodiscard, gnu::always_inline]] inline T smooth_step(const T& u) {
  const T v = smaller(larger(u, T(0)), T(1));
  return v * v * fused(T(-2), v, T(3));
}

/// f(φ): how far the hinge is inside the smoothed latch's engagement zone, 0 … 1; the rate of S.
template <class T>
[[nodiscard, gnu::always_inline]] inline T engagement_rate(const HingeTerms<T>& hinge,
                                                           const T& angle, const T& epsilon) {
  return smooth_step(hinge.sense * (angle - hinge.latched) / epsilon);
}

/// Moment of a smoothed latch in state S.
template <class T>
[[nodiscard, gnu::always_inline]] inline T smoothed_latch_moment(const HingeTerms<T>& hinge,
                                                                 const T& angle, const T& rate,
                                                                 const T& S, const T& epsilon) {
  const T full = -fused(hinge.damping, rate, hinge.stiffness * (angle - hinge.latched));
  return smooth_step(S / epsilon) * full;
}

/// Potential energy of a linear law without friction, zero at the latched angle, J.
template <class T>
[[nodiscard, gnu::always_inline]] inline T potential(const LinearLaw<T>& law, const T& angle) {
  const T y = angle - law.latched;
  return y * fused(T(0.5) * law.stiffness, y, -law.drive);
}

} // namespace wingspread
