/// Dampers: moments that oppose a hinge's rate v.
///
///     viscous        −c v
///     power law      −A |v|^p sign v,  linear below the regularization rate w: −A w^{p−1} v
///     eddy current   −2 T_p r/(1 + r²),  r = v/ω_p: most at the peak rate, and less beyond it
#pragma once

#include "core/laws/curve_value.hpp"
#include "core/number/power.hpp"
#include "core/scene/scene.hpp"

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
    using std::pow; // the same where products and sums are not made at once: terms are made there
    const T A = scale * T(damper.coefficient), w(damper.regularization_rate);
    return {damper.law, A, p, w, A * pow(w, T(p - T(1)))};
  }
  case DamperLaw::eddy_current:
    break;
  }
  return {damper.law, scale * T(2 * damper.peak_torque), T(1), T(damper.peak_rate), T(0)};
}

/// Its moment at the rate v, N·m.
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
  const T r = v / damper.rate;
  return -damper.strength * r / fused(r, r, T(1));
}

/// −d/dv of it: the damping that it is for small changes, N·m·s/rad.
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

/// Over a range of rates.
template <class T>
[[nodiscard]] ValueRange<T> damper_range(const DamperTerms<T>& damper, const ValueRange<T>& v) {
  const T first = damper_moment(damper, v.low), last = damper_moment(damper, v.high);
  ValueRange<T> range{smaller(first, last), larger(first, last)};
  if (damper.law != DamperLaw::eddy_current) return range;
  const T half = T(0.5) * damper.strength; // at the peak rate
  const auto braking = v.low < damper.rate && damper.rate < v.high;
  const auto driven_back = v.low < -damper.rate && -damper.rate < v.high;
  range.low = select(braking, T(-half), range.low);
  range.high = select(driven_back, half, range.high);
  return range;
}

/// Of its damping over a range of rates. @pre not an eddy-current damper
template <class T>
[[nodiscard]] ValueRange<T> damping_range(const DamperTerms<T>& damper, const ValueRange<T>& v) {
  const T first = damper_damping(damper, v.low), last = damper_damping(damper, v.high);
  ValueRange<T> range{smaller(first, last), larger(first, last)};
  if (damper.law == DamperLaw::viscous) return range;
  using std::abs;
  // beyond w it rises or falls with |v|, below it is constant, and at w it jumps
  const auto turns = v.low < T(0) && v.high > T(0);
  const T slow = smaller(T(abs(v.low)), T(abs(v.high)));
  const T least = select(turns, T(0), slow), most = larger(T(abs(v.low)), T(abs(v.high)));
  const auto jumps = least <= damper.rate && damper.rate <= most;
  range.include(select(turns || jumps, damper.near_zero, first));
  range.include(select(jumps, T(damper.exponent * damper.near_zero), first));
  return range;
}

/// No |moment| is larger for rates up to `most`.
template <class T> [[nodiscard]] T most_of_damper(const DamperTerms<T>& damper, const T& most) {
  const ValueRange<T> range = damper_range(damper, ValueRange<T>{T(-most), most});
  return larger(range.high, T(-range.low));
}

} // namespace wingspread
