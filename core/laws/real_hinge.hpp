/// What a hinge may have beyond springs, friction and latches that are linear: torques by tables,
/// the friction that a torque test both ways shows, dampers, a stop at the stowed side.
///
///     M = w_s S(φ) + w_h H(φ) − σ f F(φ) + [damper acts] damper(φ̇) + [in contact] s k δ max(0, 1 + c δ̇)
///
/// | symbol | meaning                                                                  | unit  |
/// |--------|--------------------------------------------------------------------------|-------|
/// | S, H   | curves of spring and harness; w: s and −s times their scales             | N·m   |
/// | F, f   | level of friction by a torque test both ways; friction's scale           | N·m   |
/// | σ      | sense of sliding, −1, 0, 1; with regularized friction φ̇/√(φ̇² + ω_s²)      |       |
/// | δ      | penetration of the stop, s (φ_contact − φ)                               | rad   |
///
/// Whether the damper acts and the stop is in contact is not asked of the angle but kept as a mode
/// of the run, which changes at events: inside a step the moment is smooth.
#pragma once

#include "core/laws/curve_value.hpp"
#include "core/laws/damper.hpp"
#include "core/number/over_root.hpp"
#include "core/scene/scene.hpp"

#include <cmath>
#include <optional>

namespace wingspread {

/// What a run changes of a real hinge.
template <class T> struct HingeMode {
  T in_contact;  ///< 1 while the stop is, else 0
  T damper_acts; ///< 1 or 0
  T sliding;     ///< sense in which exact friction is overcome: −1, 0, 1
};

template <class T> struct RealHingeTerms {
  const Curve *spring, *harness, *friction; ///< null: none
  T spring_weight, harness_weight, friction_weight;
  T slip_rate;      ///< ω_s where the friction is regularized, rad/s
  bool regularized; ///< the friction's model
  T most_friction;  ///< no f F is larger, N·m
  bool has_damper, has_window, has_stop, has_backlash;
  DamperTerms<T> damper;
  T window_low, window_high; ///< rad
  T sense;                   ///< s
  T stop_stiffness, stop_dissipation;
  T contact_angle; ///< rad
  T half_backlash; ///< β/2 of the latch, rad
};

/// Whether a hinge has anything of it.
[[nodiscard]] inline bool is_real(const Hinge& hinge) {
  return hinge.spring.table || hinge.harness.table || hinge.damper || hinge.stop ||
         (hinge.latch && hinge.latch->backlash > 0);
}

namespace detail {

template <class T> [[nodiscard]] T largest_value(const Curve& curve) {
  T most(0);
  for (std::size_t k = 0; k < curve.knots().size(); ++k)
    most = larger(most, T(curve.pieces()[k + 1].c[0]));
  return most + T(curve.overshoot());
}

template <class T> void set_torques(RealHingeTerms<T>& terms, const Hinge& hinge, const T& sense) {
  const auto curve = [](const HingeTorque& torque) -> const Curve* {
    return torque.table ? &torque.table->drive() : nullptr;
  };
  terms.spring = curve(hinge.spring), terms.harness = curve(hinge.harness);
  terms.spring_weight = sense * T(hinge.spring.scale);
  terms.harness_weight = -sense * T(hinge.harness.scale);
  terms.friction_weight = T(hinge.friction.scale);
  terms.slip_rate = T(hinge.friction.regularization_rate);
  terms.regularized = hinge.friction.model == FrictionModel::regularized;
  if (!hinge.spring.table || !hinge.spring.table->both_ways()) return;
  terms.friction = &hinge.spring.table->friction();
  terms.most_friction = terms.friction_weight * largest_value<T>(*terms.friction);
}

} // namespace detail

template <class T>
[[nodiscard]] RealHingeTerms<T> real_hinge_terms(const Hinge& hinge, const T& sense) {
  RealHingeTerms<T> terms{};
  terms.sense = sense;
  detail::set_torques(terms, hinge, sense);
  if (hinge.damper) {
    terms.has_damper = true;
    terms.damper = damper_terms<T>(*hinge.damper);
    terms.has_window = hinge.damper->window.has_value();
    if (const auto& window = hinge.damper->window) {
      terms.window_low = smaller(T((*window)[0]), T((*window)[1]));
      terms.window_high = larger(T((*window)[0]), T((*window)[1]));
    }
  }
  if (hinge.stop) {
    terms.has_stop = true;
    terms.stop_stiffness = T(hinge.stop->stiffness);
    terms.stop_dissipation = T(hinge.stop->dissipation);
    terms.contact_angle = fused(-sense, T(hinge.stop->gap), T(hinge.stowed));
  }
  terms.has_backlash = hinge.latch && hinge.latch->backlash > 0;
  if (hinge.latch) terms.half_backlash = T(0.5) * T(hinge.latch->backlash);
  return terms;
}

/// Level of the friction by a torque test, f F ≥ 0, N·m.
template <class T>
[[nodiscard]] T measured_friction(const RealHingeTerms<T>& hinge, const T& angle) {
  if (!hinge.friction) return T(0);
  return larger(T(hinge.friction_weight * value(*hinge.friction, angle)), T(0));
}

/// σ.
template <class T>
[[nodiscard]] T sense_of_friction(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                  const T& rate) {
  if (!hinge.regularized) return mode.sliding;
  return over_root(rate, fused(rate, rate, hinge.slip_rate * hinge.slip_rate));
}

/// The stop's moment, N·m.
template <class T>
[[nodiscard]] T stop_moment(const RealHingeTerms<T>& hinge, const T& angle, const T& rate) {
  const T depth = hinge.sense * (hinge.contact_angle - angle);
  const T pushes = larger(fused(-hinge.stop_dissipation, T(hinge.sense * rate), T(1)), T(0));
  return hinge.sense * hinge.stop_stiffness * depth * pushes;
}

/// The curves' moment, N·m.
template <class T> [[nodiscard]] T curves_moment(const RealHingeTerms<T>& hinge, const T& angle) {
  T m(0);
  if (hinge.spring) m = fused(hinge.spring_weight, value(*hinge.spring, angle), m);
  if (hinge.harness) m = fused(hinge.harness_weight, value(*hinge.harness, angle), m);
  return m;
}

/// Its moment, N·m.
template <class T>
[[nodiscard]] T real_moment(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                            const T& angle, const T& rate) {
  T m = curves_moment(hinge, angle);
  if (hinge.friction)
    m = m - sense_of_friction(hinge, mode, rate) * measured_friction(hinge, angle);
  if (hinge.has_damper) m = fused(mode.damper_acts, damper_moment(hinge.damper, rate), m);
  if (hinge.has_stop) m = fused(mode.in_contact, stop_moment(hinge, angle, rate), m);
  return m;
}

/// −∂M/∂φ and −∂M/∂φ̇.
template <class T> struct RealResistance { T stiffness, damping; };

template <class T>
[[nodiscard]] RealResistance<T> real_resistance(const RealHingeTerms<T>& hinge,
                                                const HingeMode<T>& mode, const T& angle,
                                                const T& rate) {
  using std::sqrt;
  RealResistance<T> r{T(0), T(0)};
  if (hinge.spring) r.stiffness = -hinge.spring_weight * slope(*hinge.spring, angle);
  if (hinge.harness)
    r.stiffness = fused(-hinge.harness_weight, slope(*hinge.harness, angle), r.stiffness);
  if (hinge.friction) {
    const T steepness = hinge.friction_weight * slope(*hinge.friction, angle);
    r.stiffness = fused(sense_of_friction(hinge, mode, rate), steepness, r.stiffness);
    if (hinge.regularized) {
      const T slip = hinge.slip_rate * hinge.slip_rate, square = fused(rate, rate, slip);
      r.damping = measured_friction(hinge, angle) * slip / (square * sqrt(square));
    }
  }
  if (hinge.has_damper)
    r.damping = fused(mode.damper_acts, damper_damping(hinge.damper, rate), r.damping);
  if (hinge.has_stop) {
    const T depth = hinge.sense * (hinge.contact_angle - angle);
    const T pushes = larger(fused(-hinge.stop_dissipation, T(hinge.sense * rate), T(1)), T(0));
    const T contact = mode.in_contact * hinge.stop_stiffness;
    r.stiffness = fused(contact, pushes, r.stiffness);
    r.damping =
        fused(select(pushes > T(0), contact, T(0)), hinge.stop_dissipation * depth, r.damping);
  }
  return r;
}

/// Its moment over ranges of angle and rate.
template <class T>
[[nodiscard]] ValueRange<T> real_range(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                       const ValueRange<T>& angle, const ValueRange<T>& rate) {
  ValueRange<T> range{T(0), T(0)};
  if (hinge.spring) range = range + scaled(hinge.spring_weight, range_of(*hinge.spring, angle));
  if (hinge.harness) range = range + scaled(hinge.harness_weight, range_of(*hinge.harness, angle));
  if (hinge.friction) {
    const T most = scaled(hinge.friction_weight, range_of(*hinge.friction, angle)).high;
    const T first = -sense_of_friction(hinge, mode, rate.low);
    const T last = -sense_of_friction(hinge, mode, rate.high);
    ValueRange<T> sides{smaller(first, last), larger(first, last)};
    sides.include(T(0));
    range = range + scaled(larger(most, T(0)), sides);
  }
  if (hinge.has_damper) range = range + scaled(mode.damper_acts, damper_range(hinge.damper, rate));
  if (hinge.has_stop) {
    ValueRange<T> push{T(0), T(0)};
    for (const T& a : {angle.low, angle.high})
      for (const T& v : {rate.low, rate.high}) push.include(stop_moment(hinge, a, v));
    range = range + scaled(mode.in_contact, push);
  }
  return range;
}

/// A range, and where it is known.
template <class T> struct KnownRange {
  using Mask = decltype(T(0) < T(0));
  ValueRange<T> range{T(0), T(0)};
  Mask known = T(0) <= T(0);

  void add(const ValueRange<T>& more) { range = range + more; }
};

/// dM/dt over ranges of angle, rate and acceleration; unknown where its laws have no smooth bound here:
/// regularized friction by a test, an eddy-current damper, a stop in contact.
template <class T>
[[nodiscard]] KnownRange<T> real_change(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                        const ValueRange<T>& angle, const ValueRange<T>& rate,
                                        const ValueRange<T>& acceleration) {
  KnownRange<T> change;
  if (hinge.has_stop) change.known = !(mode.in_contact > T(0));
  if (hinge.friction && hinge.regularized) change.known = T(0) < T(0);
  if (hinge.has_damper && hinge.damper.law == DamperLaw::eddy_current)
    change.known = change.known && !(mode.damper_acts > T(0));
  if (hinge.friction) change.known = change.known && range_of(*hinge.friction, angle).low > T(0);
  if (!any(change.known)) return change;
  ValueRange<T> slopes{T(0), T(0)};
  const auto add = [&](const Curve* curve, const T& weight) {
    if (curve) slopes = slopes + scaled(weight, range_of_slope(*curve, angle));
  };
  add(hinge.spring, hinge.spring_weight), add(hinge.harness, hinge.harness_weight);
  add(hinge.friction, T(-(mode.sliding * hinge.friction_weight)));
  change.add(slopes * rate);
  if (hinge.has_damper && hinge.damper.law != DamperLaw::eddy_current)
    change.add(scaled(T(-mode.damper_acts), damping_range(hinge.damper, rate)) * acceleration);
  return change;
}

/// Between what their stiffness −∂M/∂φ lies, at any angle.
template <class T> [[nodiscard]] ValueRange<T> stiffness_of_curves(const RealHingeTerms<T>& hinge) {
  ValueRange<T> range{T(0), T(0)};
  const auto add = [&range](const Curve* curve, const T& weight) {
    if (curve)
      range = range + scaled(T(-weight),
                             ValueRange<T>{T(curve->steepest_fall()), T(curve->steepest_rise())});
  };
  add(hinge.spring, hinge.spring_weight), add(hinge.harness, hinge.harness_weight);
  return range;
}

/// Potential of curves and stop, zero at the latched angle, J. @param in_contact 1 or 0
template <class T>
[[nodiscard]] T real_potential(const RealHingeTerms<T>& hinge, const T& latched, const T& angle,
                               const T& in_contact) {
  T P(0);
  const auto curve = [&](const Curve* law, const T& weight) {
    if (law) P = fused(-weight, integral(*law, angle) - integral(*law, latched), P);
  };
  curve(hinge.spring, hinge.spring_weight), curve(hinge.harness, hinge.harness_weight);
  const T depth = hinge.contact_angle - angle;
  if (hinge.has_stop) P = fused(in_contact * T(0.5) * hinge.stop_stiffness * depth, depth, P);
  return P;
}

} // namespace wingspread
