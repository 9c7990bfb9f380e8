/// The list of laws that a hinge may have beyond linear_law.hpp, regularized friction and smoothed latch.
///
///     M = w_s S(φ) + w_h H(φ) − σ f F(φ) + [damper acts] damper(φ̇) + [in contact] stop(φ, φ̇)
///         + [in contact] far stop(φ, φ̇) + [latch bears] dissipation(φ, φ̇)                       (1)
///
/// with spring and harness by tables (curve_torque.hpp), measured friction (friction.hpp), a damper (damper.hpp), a
/// stop (stop.hpp) at either side and a latch's dissipation (latch_laws.hpp). Whether the damper acts, a stop is in
/// contact and the latch bears are modes of the run, which change at events: inside a step every law is smooth. Whether
/// the latch engages and lets go: latch_laws.hpp.
///
/// To add a law: README.md.
#pragma once

#include "core/laws/curve_torque.hpp"
#include "core/laws/damper.hpp"
#include "core/laws/friction.hpp"
#include "core/laws/hinge_law.hpp"
#include "core/laws/latch_laws.hpp"
#include "core/laws/stop.hpp"
#include "core/scene/scene.hpp"

namespace wingspread {

/// What events change in a real hinge.
template <class T> struct HingeMode {
  T in_contact;     ///< 1 while the stop is in contact, else 0
  T damper_acts;    ///< 1 or 0
  T sliding;        ///< σ of exact friction: −1, 0, 1
  T bears;          ///< side on which the engaged latch bears: −1, 1; 0: on none
  T in_far_contact; ///< 1 while the far stop is in contact, else 0
};

template <class T> struct RealHingeTerms {
  CurveTorqueTerms<T> spring, harness;
  MeasuredFrictionTerms<T> friction;
  bool has_damper, has_window, has_backlash;
  DamperTerms<T> damper;
  T window_low, window_high; ///< angles between which the damper acts, rad
  StopTerms<T> stop;
  T half_backlash; ///< β/2 of the latch, rad
  LatchDissipationTerms<T> dissipation;
  StopTerms<T> far_stop;
  CaptureTerms<T> capture;

  /// Whether the latch's law changes at the latched angle, or at the ends of its backlash.
  [[nodiscard]] bool has_latch_edge() const { return has_backlash || dissipation.present; }
};

/// Calls visit(law) for each law that the hinge has, in the order of (1). A new law is a line here.
template <class T, class Visit>
void for_each_law(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode, Visit&& visit) {
  const auto offer = [&visit](const HingeLaw<T> auto& law) { visit(law); };
  if (hinge.spring.curve) offer(CurveTorque<T>{hinge.spring});
  if (hinge.harness.curve) offer(CurveTorque<T>{hinge.harness});
  if (hinge.friction.level) offer(MeasuredFriction<T>{hinge.friction, mode.sliding});
  if (hinge.has_damper) offer(HingeDamper<T>{hinge.damper, mode.damper_acts});
  if (hinge.stop.present) offer(HingeStop<T>{hinge.stop, mode.in_contact});
  if (hinge.far_stop.present) offer(HingeStop<T>{hinge.far_stop, mode.in_far_contact});
  if (hinge.dissipation.present) offer(LatchDissipation<T>{hinge.dissipation, mode.bears});
}

/// Whether a hinge has any of the laws, or a latch with backlash or that may miss.
[[nodiscard]] inline bool is_real(const Hinge& hinge) {
  return hinge.spring.table || hinge.harness.table || hinge.damper || hinge.stop ||
         hinge.far_stop ||
         (hinge.latch &&
          (hinge.latch->backlash > 0 || hinge.latch->dissipation || hinge.latch->can_miss()));
}

/// (1), N·m.
template <class T>
[[nodiscard]] T real_moment(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                            const T& angle, const T& rate) {
  T m(0);
  for_each_law(hinge, mode, [&](const auto& law) { law.add_moment(m, angle, rate); });
  return m;
}

/// −∂M/∂φ and −∂M/∂φ̇ of (1).
template <class T>
[[nodiscard]] HingeResistance<T> real_resistance(const RealHingeTerms<T>& hinge,
                                                 const HingeMode<T>& mode, const T& angle,
                                                 const T& rate) {
  HingeResistance<T> r{T(0), T(0)};
  for_each_law(hinge, mode, [&](const auto& law) { law.add_resistance(r, angle, rate); });
  return r;
}

/// A range of (1) over ranges of angle and rate, N·m.
template <class T>
[[nodiscard]] ValueRange<T> real_range(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                       const ValueRange<T>& angle, const ValueRange<T>& rate) {
  ValueRange<T> range{T(0), T(0)};
  for_each_law(hinge, mode, [&](const auto& law) { law.add_range(range, angle, rate); });
  return range;
}

/// A range of dM/dt over ranges of angle, rate and acceleration, N·m/s; unknown where a law has no slopes.
template <class T>
[[nodiscard]] KnownRange<T> real_change(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                        const ValueRange<T>& angle, const ValueRange<T>& rate,
                                        const ValueRange<T>& acceleration) {
  KnownRange<T> change;
  for_each_law(hinge, mode, [&](const auto& law) {
    if (any(change.known)) change.known = change.known && law.has_slopes(angle);
  });
  if (!any(change.known)) return change;
  MomentSlopes<T> slopes;
  for_each_law(hinge, mode, [&](const auto& law) { law.add_slopes(slopes, angle, rate); });
  change.add(slopes.change(rate, acceleration));
  return change;
}

/// Potential of the laws, zero at the latched angle, J.
template <class T>
[[nodiscard]] T real_potential(const RealHingeTerms<T>& hinge, const T& latched, const T& angle,
                               const HingeMode<T>& mode) {
  T P(0);
  for_each_law(hinge, mode, [&](const auto& law) { law.add_potential(P, latched, angle); });
  return P;
}

/// Moment of the springs and harnesses by tables, N·m.
template <class T> [[nodiscard]] T curves_moment(const RealHingeTerms<T>& hinge, const T& angle) {
  T m(0);
  for (const CurveTorqueTerms<T>* torque : {&hinge.spring, &hinge.harness})
    if (torque->curve) CurveTorque<T>{*torque}.add_moment(m, angle);
  return m;
}

/// A range of the stiffness −∂M/∂φ of the springs and harnesses by tables, over all angles, N·m/rad.
template <class T> [[nodiscard]] ValueRange<T> stiffness_of_curves(const RealHingeTerms<T>& hinge) {
  ValueRange<T> range{T(0), T(0)};
  for (const CurveTorqueTerms<T>* torque : {&hinge.spring, &hinge.harness})
    if (torque->curve) CurveTorque<T>{*torque}.add_stiffness_range(range);
  return range;
}

namespace detail {

template <class T> [[nodiscard]] T largest_value(const Curve& curve) {
  T most(0);
  for (std::size_t k = 0; k < curve.knots().size(); ++k)
    most = larger(most, T(curve.pieces()[k + 1].c[0]));
  return most + T(curve.overshoot());
}

template <class T> void set_curves(RealHingeTerms<T>& terms, const Hinge& hinge, const T& sense) {
  const auto curve = [](const HingeTorque& torque) -> const Curve* {
    return torque.table ? &torque.table->drive() : nullptr;
  };
  terms.spring = {curve(hinge.spring), sense * T(hinge.spring.scale)};
  terms.harness = {curve(hinge.harness), -sense * T(hinge.harness.scale)};
  MeasuredFrictionTerms<T>& friction = terms.friction;
  friction.weight = T(hinge.friction.scale);
  friction.slip_rate = T(hinge.friction.regularization_rate);
  friction.regularized = hinge.friction.model == FrictionModel::regularized;
  if (!hinge.spring.table || !hinge.spring.table->both_ways()) return;
  friction.level = &hinge.spring.table->friction();
  friction.most = friction.weight * largest_value<T>(*friction.level);
}

} // namespace detail

/// @param sense sign(φ_latched − φ_stowed)
template <class T>
[[nodiscard]] RealHingeTerms<T> real_hinge_terms(const Hinge& hinge, const T& sense) {
  RealHingeTerms<T> terms{};
  detail::set_curves(terms, hinge, sense);
  if (hinge.damper) {
    terms.has_damper = true;
    terms.damper = damper_terms<T>(*hinge.damper);
    terms.has_window = hinge.damper->window.has_value();
    if (const auto& window = hinge.damper->window) {
      terms.window_low = smaller(T((*window)[0]), T((*window)[1]));
      terms.window_high = larger(T((*window)[0]), T((*window)[1]));
    }
  }
  terms.stop.sense = sense, terms.far_stop.sense = -sense;
  if (hinge.stop)
    terms.stop = {true, sense, T(hinge.stop->stiffness), T(hinge.stop->dissipation),
                  fused(-sense, T(hinge.stop->gap), T(hinge.stowed))};
  if (hinge.far_stop)
    terms.far_stop = {true, -sense, T(hinge.far_stop->stiffness), T(hinge.far_stop->dissipation),
                      fused(sense, T(hinge.far_stop->gap), T(hinge.latched))};
  terms.has_backlash = hinge.latch && hinge.latch->backlash > 0;
  if (hinge.latch) terms.half_backlash = T(0.5) * T(hinge.latch->backlash);
  terms.dissipation = dissipation_terms<T>(hinge);
  terms.capture = capture_terms<T>(hinge, sense);
  return terms;
}

} // namespace wingspread
