/// A spring's or a harness's torque by a table of hinge angles.
///
///     M = w c(φ)      c: the curve, N·m; w: s times the spring's scale, −s times the harness's       (1)
#pragma once

#include "core/laws/curve_value.hpp"
#include "core/laws/hinge_law.hpp"

namespace wingspread {

template <class T> struct CurveTorqueTerms {
  const Curve* curve; ///< c; null: none
  T weight;           ///< w
};

/// (1) as a law of real_hinge.hpp. @pre terms.curve is not null
template <class T> struct CurveTorque {
  const CurveTorqueTerms<T>& terms;

  void add_moment(T& m, const T& angle, const T& /*rate*/ = T(0)) const {
    m = fused(terms.weight, value(*terms.curve, angle), m);
  }
  void add_resistance(HingeResistance<T>& r, const T& angle, const T& /*rate*/) const {
    r.stiffness = fused(-terms.weight, slope(*terms.curve, angle), r.stiffness);
  }
  void add_range(ValueRange<T>& m, const ValueRange<T>& angle,
                 const ValueRange<T>& /*rate*/) const {
    m = m + scaled(terms.weight, range_of(*terms.curve, angle));
  }
  [[nodiscard]] auto has_slopes(const ValueRange<T>& /*angle*/) const { return T(0) <= T(0); }
  void add_slopes(MomentSlopes<T>& m, const ValueRange<T>& angle,
                  const ValueRange<T>& /*rate*/) const {
    m.by_angle = m.by_angle + scaled(terms.weight, range_of_slope(*terms.curve, angle));
  }
  /// P by the exact integral of the interpolant.
  void add_potential(T& P, const T& latched, const T& angle) const {
    P = fused(-terms.weight, integral(*terms.curve, angle) - integral(*terms.curve, latched), P);
  }
  /// Adds the range of −∂M/∂φ over all angles.
  void add_stiffness_range(ValueRange<T>& range) const {
    range = range + scaled(T(-terms.weight), ValueRange<T>{T(terms.curve->steepest_fall()),
                                                           T(terms.curve->steepest_rise())});
  }
};

} // namespace wingspread
