/// Dampers: moments that oppose a hinge's rate v = φ̇.
///
/// | symbol   | meaning                                               | unit           |
/// |----------|-------------------------------------------------------|----------------|
/// | c        | viscous coefficient                                   | N·m·s/rad      |
/// | A, p, w  | power law: factor, exponent, regularization rate      | N·m (s/rad)^p, 1, rad/s |
/// | T_p, ω_p | eddy current: peak torque, at the peak rate           | N·m, rad/s     |
///
///     viscous        −c v                                                                       (1)
///     power law      −A |v|^p sign v for |v| ≥ w,  −A w^{p−1} v below                           (2)
///     eddy current   −2 T_p r/(1 + r²) = −2 T_p ω_p v/(ω_p² + v²),  r = v/ω_p: largest at r = 1  (3)
///
/// A damper with a window acts between two angles only. Whether it acts is a mode of the run, which changes at events
/// (Edge::window_low, Edge::window_high).
#pragma once

#include "core/laws/hinge_law.hpp"
#include "core/number/power.hpp"
#include "core/scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

template <class T> struct DamperTerms {
  DamperLaw law;
  T strength;  ///< c, A or 2 T_p, times the scale
  T exponent;  ///< p
  T rate;      ///< w or ω_p, rad/s
  T near_zero; ///< A w^{p−1}, times the scale, N·m·s/rad
};

template <class T> [[nodiscard]] DamperTerms<T> damper_terms(const Damper& damper) {
  const T scale(damper.scale), p(damper.exponent);
  switch (damper.law) {
  case DamperLaw::viscous:
    return {damper.law, scale * T(damper.coefficient), T(1), T(1), T(0)};
  case DamperLaw::power: {
    using std::pow;
    const T A = scale * T(damper.coefficient), w(damper.regularization_rate);
    return {damper.law, A, p, w, A * pow(w, T(p - T(1)))};
  }
  case DamperLaw::eddy_current:
    break;
  }
  return {damper.law, scale * T(2 * damper.peak_torque), T(1), T(damper.peak_rate), T(0)};
}

/// (1), (2) or (3), N·m.
template <class T> [[nodiscard]] T damper_moment(const DamperTerms<T>& damper, const T& v) {
  using std::abs;
  switch (damper.law) {
  case DamperLaw::viscous:
    return -damper.strength * v;
  case DamperLaw::power: {
    const T size = abs(v);
    const T beyond = damper.strength * power_precisely(larger(size, damper.rate), damper.exponent);
    const T torque = select(size < damper.rate, T(damper.near_zero * size), beyond);
    return select(v > T(0), T(-torque), torque);
  }
  case DamperLaw::eddy_current:
    break;
  }
  return -(damper.strength * damper.rate * v) / fused(v, v, damper.rate * damper.rate);
}

/// −dM/dv, N·m·s/rad.
template <class T> [[nodiscard]] T damper_damping(const DamperTerms<T>& damper, const T& v) {
  using std::abs;
  switch (damper.law) {
  case DamperLaw::viscous:
    return damper.strength;
  case DamperLaw::power: {
    const T size = larger(T(abs(v)), damper.rate);
    const T beyond =
        damper.strength * damper.exponent * power_precisely(size, T(damper.exponent - T(1)));
    return select(T(abs(v)) < damper.rate, damper.near_zero, beyond);
  }
  case DamperLaw::eddy_current:
    break;
  }
  const T r = v / damper.rate, q = fused(r, r, T(1));
  return damper.strength / damper.rate * (T(2) - q) / (q * q);
}

/// A range of the moment over a range of rates.
template <class T>
[[nodiscard]] ValueRange<T> damper_range(const DamperTerms<T>& damper, const ValueRange<T>& v) {
  const T first = damper_moment(damper, v.low), last = damper_moment(damper, v.high);
  ValueRange<T> range{smaller(first, last), larger(first, last)};
  if (damper.law != DamperLaw::eddy_current) return range; // (1) and (2) fall with v
  const T half = T(0.5) * damper.strength;                 // (3) at r = 1: T_p
  const auto braking = v.low < damper.rate && damper.rate < v.high;
  const auto driven_back = v.low < -damper.rate && -damper.rate < v.high;
  range.low = select(braking, T(-half), range.low);
  range.high = select(driven_back, half, range.high);
  return range;
}

/// The largest |moment| at rates of at most `most`.
template <class T> [[nodiscard]] T most_of_damper(const DamperTerms<T>& damper, const T& most) {
  const ValueRange<T> range = damper_range(damper, ValueRange<T>{T(-most), most});
  return larger(range.high, T(-range.low));
}

/// A range of damper_damping over a range of rates. @pre not an eddy-current damper
template <class T>
[[nodiscard]] ValueRange<T> damping_range(const DamperTerms<T>& damper, const ValueRange<T>& v) {
  const T first = damper_damping(damper, v.low), last = damper_damping(damper, v.high);
  ValueRange<T> range{smaller(first, last), larger(first, last)};
  if (damper.law == DamperLaw::viscous) return range;
  // (2): constant below w, monotone in |v| beyond, with a jump at w
  const T least = smallest_magnitude_of(v), most = largest_magnitude_of(v);
  const auto jumps = least <= damper.rate && damper.rate <= most;
  range.include(select(jumps, damper.near_zero, first));
  range.include(select(jumps, T(damper.exponent * damper.near_zero), first));
  return range;
}

/// Secant damping at the rate v ≥ 0, N·m·s/rad: the moment over the rate, for a power law at no less than w.
/// For the other laws the damping at rest.
[[nodiscard]] inline double secant(const DamperTerms<double>& damper, double v) {
  if (damper.law != DamperLaw::power) return damper_damping(damper, 0.0);
  const double rate = std::max(v, damper.rate);
  return -damper_moment(damper, rate) / rate;
}

/// Largest |moment + taken·v| of a damper for rates up to `most`.
[[nodiscard]] inline double beyond_linear(const DamperTerms<double>& damper, double taken,
                                          double most) {
  const auto left = [&](double v) { return std::abs(damper_moment(damper, v) + taken * v); };
  switch (damper.law) {
  case DamperLaw::viscous:
    break;
  case DamperLaw::power: { // beyond w the difference from the line taken·v has one extreme
    double largest = left(most);
    if (most > damper.rate) largest = std::max(largest, left(damper.rate));
    const double p = damper.exponent, steep = damper.strength * p;
    if (p != 1 && taken > 0 && steep > 0) {
      const double v = std::pow(steep / taken, 1 / (1 - p));
      if (v > damper.rate && v < most) largest = std::max(largest, left(v));
    }
    return largest;
  }
  case DamperLaw::eddy_current: // the difference is S r³/(1 + r²), which rises
    return left(most);
  }
  return 0;
}

/// A hinge's damper as a law of real_hinge.hpp.
template <class T> struct HingeDamper {
  const DamperTerms<T>& terms;
  const T& acts; ///< 1 or 0

  void add_moment(T& m, const T& /*angle*/, const T& rate) const {
    m = fused(acts, damper_moment(terms, rate), m);
  }
  void add_resistance(HingeResistance<T>& r, const T& /*angle*/, const T& rate) const {
    r.damping = fused(acts, damper_damping(terms, rate), r.damping);
  }
  void add_range(ValueRange<T>& m, const ValueRange<T>& /*angle*/,
                 const ValueRange<T>& rate) const {
    m = m + scaled(acts, damper_range(terms, rate));
  }
  /// Unknown while an eddy-current damper acts: the slope of (3) is not bounded here, so the peak search takes samples.
  [[nodiscard]] auto has_slopes(const ValueRange<T>& /*angle*/) const {
    return terms.law == DamperLaw::eddy_current ? !(acts > T(0)) : T(0) <= T(0);
  }
  void add_slopes(MomentSlopes<T>& m, const ValueRange<T>& /*angle*/,
                  const ValueRange<T>& rate) const {
    if (terms.law != DamperLaw::eddy_current)
      m.by_rate = m.by_rate + scaled(T(-acts), damping_range(terms, rate));
  }
  void add_potential(T& /*P*/, const T& /*latched*/, const T& /*angle*/) const {}
};

} // namespace wingspread
