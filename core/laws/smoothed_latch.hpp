/// A smoothed latch, which the smooth steps f and h bring in over a width ε in place of an event.
///
/// | symbol | meaning                                            | unit |
/// |--------|----------------------------------------------------|------|
/// | y      | φ − φ_latched                                      | rad  |
/// | h(u)   | smooth step, 0 … 1: u²(3 − 2u) over u ∈ [0, 1]     |      |
/// | S      | the latch's own state, Ṡ = f = h(s y/ε)            | s    |
/// | ε      | width: of f in rad, of the weight in S in s        |      |
/// | k, d, c | the latch's stiffness, and its damping or dissipation | N·m/rad, N·m·s/rad, s/rad |
///
///     M = −h(S/ε) (k y + d φ̇ + k c |y| φ̇)        [Yudintsev; c: latch_laws.hpp]        (1)
#pragma once

#include "core/laws/hinge_terms.hpp"
#include "core/number/quintic.hpp"

namespace wingspread {

/// h(u); constant outside [0, 1].
template <class T> [[nodiscard, gnu::always_inline]] inline T smooth_step(const T& u) {
  const T v = smaller(larger(u, T(0)), T(1));
  return v * v * fused(T(-2), v, T(3));
}

/// f(φ) = Ṡ: how far the hinge is inside the engagement zone, 0 … 1.
template <class T>
[[nodiscard, gnu::always_inline]] inline T engagement_rate(const HingeTerms<T>& hinge,
                                                           const T& angle, const T& epsilon) {
  return smooth_step(hinge.sense * (angle - hinge.latched) / epsilon);
}

/// ḟ = S̈, 1/s.
template <class T>
[[nodiscard]] T engagement_acceleration(const HingeTerms<T>& hinge, const T& angle, const T& rate,
                                        const T& epsilon) {
  const T u = hinge.sense * (angle - hinge.latched) / epsilon;
  const T v = smaller(larger(u, T(0)), T(1));
  return T(6) * v * (T(1) - v) * hinge.sense * rate / epsilon;
}

/// d + k c |y|: the damping at full weight, N·m·s/rad.
template <class T>
[[nodiscard, gnu::always_inline]] inline T smoothed_latch_damping(const HingeTerms<T>& hinge,
                                                                  const T& angle) {
  using std::abs;
  return fused(hinge.dissipation, T(abs(angle - hinge.latched)), hinge.damping);
}

/// (1) in state S, N·m.
template <class T>
[[nodiscard, gnu::always_inline]] inline T smoothed_latch_moment(const HingeTerms<T>& hinge,
                                                                 const T& angle, const T& rate,
                                                                 const T& S, const T& epsilon) {
  const T full =
      -fused(smoothed_latch_damping(hinge, angle), rate, hinge.stiffness * (angle - hinge.latched));
  return smooth_step(S / epsilon) * full;
}

/// A bound of |(1)| over a step, by h ≤ 1 and the hull of k y + d φ̇ as a polynomial of time, N·m.
template <class T>
[[nodiscard]] T most_of_smoothed_latch(const HingeTerms<T>& hinge, const Quintic<T>& angle,
                                       const Quintic<T>& rate) {
  Quintic<T> load, y;
  for (int k = 0; k < 6; ++k) {
    y[k] = angle[k] - hinge.latched;
    load[k] = fused(hinge.stiffness, y[k], hinge.damping * rate[k]);
  }
  return fused(hinge.dissipation * bound(y), bound(rate), bound(load));
}

/// ½ k y², the energy that the latch stores at full weight, J.
template <class T> [[nodiscard]] T full_latch_energy(const HingeTerms<T>& hinge, const T& angle) {
  const T y = angle - hinge.latched;
  return T(0.5) * hinge.stiffness * y * y;
}

} // namespace wingspread
