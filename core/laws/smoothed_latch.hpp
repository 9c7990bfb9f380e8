/// A smoothed latch, which the smooth steps f and h bring in over a width ε in place of an event.
///
/// | symbol | meaning                                            | unit |
/// |--------|----------------------------------------------------|------|
/// | y      | φ − φ_latched                                      | rad  |
/// | h(u)   | smooth step, 0 … 1: u²(3 − 2u) over u ∈ [0, 1]     |      |
/// | S      | the latch's own state, Ṡ = f = h(s y/ε)            | s    |
/// | ε      | width: of f in rad, of the weight in S in s        |      |
///
///     M = −h(S/ε) (k y + d φ̇)        [Yudintsev]        (1)
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

/// (1) in state S, N·m.
template <class T>
[[nodiscard, gnu::always_inline]] inline T smoothed_latch_moment(const HingeTerms<T>& hinge,
                                                                 const T& angle, const T& rate,
                                                                 const T& S, const T& epsilon) {
  const T full = -fused(hinge.damping, rate, hinge.stiffness * (angle - hinge.latched));
  return smooth_step(S / epsilon) * full;
}

/// k y + d φ̇ over a step, as a polynomial of time: its hull bounds |M|, for h ≤ 1.
template <class T>
[[nodiscard]] Quintic<T> full_latch_load(const HingeTerms<T>& hinge, const Quintic<T>& angle,
                                         const Quintic<T>& rate) {
  Quintic<T> load;
  for (int k = 0; k < 6; ++k)
    load[k] = fused(hinge.stiffness, angle[k] - hinge.latched, hinge.damping * rate[k]);
  return load;
}

/// ½ k y², the energy that the latch stores at full weight, J.
template <class T> [[nodiscard]] T full_latch_energy(const HingeTerms<T>& hinge, const T& angle) {
  const T y = angle - hinge.latched;
  return T(0.5) * hinge.stiffness * y * y;
}

} // namespace wingspread
