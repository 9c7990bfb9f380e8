/// Coulomb friction of a hinge, regularized, and the friction that a torque test both ways measures.
///
/// | symbol | meaning                                                        | unit  |
/// |--------|----------------------------------------------------------------|-------|
/// | τ_c    | level of the regularized friction                              | N·m   |
/// | ω_s    | rate below which the regularized friction is about linear      | rad/s |
/// | f F(φ) | measured level: friction's scale times half the tests' spread  | N·m   |
/// | σ      | sense of sliding, −1, 0 or 1; regularized: φ̇/√(φ̇² + ω_s²)      |       |
///
///     M = −τ_c φ̇/√(φ̇² + ω_s²)                                                   (1)
///     −∂M/∂φ̇ = τ_c ω_s²/(φ̇² + ω_s²)^(3/2), which falls with |φ̇|                               (2)
///     M = −σ max(f F(φ), 0)                                                      (3)
///
/// Exact friction −τ_c sign φ̇ of a sliding hinge is a constant of linear_law.hpp. Where an exactly
/// rubbing hinge sticks and is released: core/events/contact.hpp.
#pragma once

#include "core/laws/curve_value.hpp"
#include "core/laws/hinge_law.hpp"
#include "core/laws/hinge_terms.hpp"
#include "core/number/over_root.hpp"

#include <cmath>

namespace wingspread {

/// (1), N·m. Smooth, so that a hinge creeps where a real one sticks.
template <class T>
[[nodiscard, gnu::always_inline]] inline T regularized_friction_moment(const HingeTerms<T>& hinge,
                                                                       const T& rate) {
  return over_root(T(-(hinge.regularized_friction * rate)),
                   fused(rate, rate, hinge.slip_rate * hinge.slip_rate));
}

/// (2), N·m·s/rad.
template <class T>
[[nodiscard]] T regularized_friction_damping(const HingeTerms<T>& hinge, const T& rate) {
  using std::sqrt;
  const T slip = hinge.slip_rate * hinge.slip_rate, square = fused(rate, rate, slip);
  return hinge.regularized_friction * slip / (square * sqrt(square));
}

/// A range of (1): friction opposes the rate, so a rate of one sign leaves one side empty.
template <class T>
[[nodiscard]] ValueRange<T> regularized_friction_range(const HingeTerms<T>& hinge,
                                                       const ValueRange<T>& rate) {
  return {T(-select(rate.high > T(0), hinge.regularized_friction, T(0))),
          select(rate.low < T(0), hinge.regularized_friction, T(0))};
}

/// A range of dM/dt of (1), by (2). Inlined: else GCC 12 falsely warns about its AVX-512 header here (GCC bug 105593).
template <class T>
[[nodiscard, gnu::always_inline]] inline ValueRange<T>
regularized_friction_change(const HingeTerms<T>& hinge, const ValueRange<T>& rate,
                            const ValueRange<T>& acceleration) {
  const ValueRange<T> slope{-regularized_friction_damping(hinge, smallest_magnitude_of(rate)),
                            -regularized_friction_damping(hinge, largest_magnitude_of(rate))};
  return slope * acceleration;
}

template <class T> struct MeasuredFrictionTerms {
  const Curve* level; ///< F; null: none measured
  T weight;           ///< f
  T slip_rate;        ///< ω_s, rad/s
  bool regularized;   ///< the friction's model
  T most;             ///< max f F, N·m
};

/// f F(φ) ≥ 0, N·m.
template <class T>
[[nodiscard]] T measured_friction(const MeasuredFrictionTerms<T>& friction, const T& angle) {
  if (!friction.level) return T(0);
  return larger(T(friction.weight * value(*friction.level, angle)), T(0));
}

/// (3) as a law of real_hinge.hpp.
template <class T> struct MeasuredFriction {
  const MeasuredFrictionTerms<T>& terms;
  const T& sliding; ///< σ of exact friction

  [[nodiscard]] T sense(const T& rate) const {
    if (!terms.regularized) return sliding;
    return over_root(rate, fused(rate, rate, terms.slip_rate * terms.slip_rate));
  }

  void add_moment(T& m, const T& angle, const T& rate) const {
    m = m - sense(rate) * measured_friction(terms, angle);
  }
  void add_resistance(HingeResistance<T>& r, const T& angle, const T& rate) const {
    using std::sqrt;
    const T steepness = terms.weight * slope(*terms.level, angle);
    r.stiffness = fused(sense(rate), steepness, r.stiffness);
    if (!terms.regularized) return;
    const T slip = terms.slip_rate * terms.slip_rate, square = fused(rate, rate, slip);
    r.damping = r.damping + measured_friction(terms, angle) * slip / (square * sqrt(square));
  }
  void add_range(ValueRange<T>& m, const ValueRange<T>& angle, const ValueRange<T>& rate) const {
    const T most = scaled(terms.weight, range_of(*terms.level, angle)).high;
    const T first = -sense(rate.low), last = -sense(rate.high);
    ValueRange<T> sides{smaller(first, last), larger(first, last)};
    sides.include(T(0));
    m = m + scaled(larger(most, T(0)), sides);
  }
  /// The level must not reach 0, where max(f F, 0) has a kink; regularized friction has no bound here.
  [[nodiscard]] auto has_slopes(const ValueRange<T>& angle) const {
    if (terms.regularized) return T(0) < T(0);
    return range_of(*terms.level, angle).low > T(0);
  }
  void add_slopes(MomentSlopes<T>& m, const ValueRange<T>& angle,
                  const ValueRange<T>& /*rate*/) const {
    m.by_angle =
        m.by_angle + scaled(T(-(sliding * terms.weight)), range_of_slope(*terms.level, angle));
  }
  void add_potential(T& /*P*/, const T& /*latched*/, const T& /*angle*/) const {}
};

} // namespace wingspread
