/// The largest moment that a hinge sees, inside steps and not only at their ends.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/held_load.hpp"
#include "core/mechanics/hinge_moment.hpp"
#include "core/peaks/maximum.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <optional>

namespace wingspread {

/// The moment of one hinge over a step, by the dense output.
template <class T, class AnySystem> class MomentOverStep {
public:
  MomentOverStep(const AnySystem& system, const Step<T>& step, int i)
      : system_(system), hinge_(system.wing().hinges[i]), step_(step), i_(i),
        latch_state_(system.layout().latch(i)), epsilon_(system.epsilon()),
        smoothed_(system.layout().smoothed && hinge_.has_latch) {
    const Layout& at = system.layout();
    const LinearLaw<T>& law = system.work().laws[i];
    angle_ = step.coordinate(at.angle(i), at.freedoms());
    rate_ = derivative(angle_, step.h);
    for (int k = 0; k < 6; ++k) linear_[k] = linear_moment(law, angle_[k], rate_[k]);
    for (int k = 0; smoothed_ && k < 6; ++k)
      latch_[k] = fused(hinge_.stiffness, angle_[k] - hinge_.latched, hinge_.damping * rate_[k]);
  }

  /// No |moment| in the step is larger, by the hulls of the polynomials; friction opposes the rate,
  /// so that it adds to one side only where the rate keeps its sign.
  [[nodiscard]] T most() const {
    T low = linear_[0], high = linear_[0], slowest = rate_[0], fastest = rate_[0];
    for (int k = 1; k < 6; ++k) {
      low = smaller(low, linear_[k]), high = larger(high, linear_[k]);
      slowest = smaller(slowest, rate_[k]), fastest = larger(fastest, rate_[k]);
    }
    low = low - select(fastest > T(0), hinge_.regularized_friction, T(0));
    high = high + select(slowest < T(0), hinge_.regularized_friction, T(0));
    if (system_.wing().is_real()) {
      const ValueRange<T> real = range_of_real();
      low = low + real.low, high = high + real.high;
    }
    const T linear = larger(high, T(-low));
    return smoothed_ ? linear + bound(latch_) : linear;
  }

  /// Of the real hinge and the loops, by the hulls of angle and rate.
  [[nodiscard]] ValueRange<T> range_of_real() const {
    const Wing<T>& wing = system_.wing();
    ValueRange<T> range{T(0), T(0)};
    if (!wing.real.empty())
      range = real_range(wing.real[i_], system_.work().modes[i_], hull(angle_), hull(rate_));
    for (const LoopTerms<T>& loop : wing.loops)
      if (loop.first == i_ || loop.second == i_) range = range + range_of(loop);
    return range;
  }

  /// Whether it only rises or only falls over the step, by the hulls of what it is made of: then it
  /// is largest at an end. Not asked where the latch is smoothed. For a pack: in which lanes.
  [[nodiscard]] auto keeps_direction() const {
    KnownRange<T> change;
    change.range = hull(derivative(linear_, step_.h));
    const Wing<T>& wing = system_.wing();
    if (wing.has_regularized_friction) change.add(change_of_friction());
    if (!wing.real.empty()) {
      const KnownRange<T> own = real_change(wing.real[i_], system_.work().modes[i_], hull(angle_),
                                            hull(rate_), hull(derivative(rate_, step_.h)));
      change.known = own.known, change.add(own.range);
    }
    for (const LoopTerms<T>& loop : wing.loops)
      if (any(change.known) && (loop.first == i_ || loop.second == i_)) {
        const KnownRange<T> own = change_of(loop);
        change.known = change.known && own.known, change.add(own.range);
      }
    if (smoothed_) change.known = T(0) < T(0);
    return change.known && (change.range.low > T(0) || change.range.high < T(0));
  }

  /// d²/dt² at s, by differences.
  [[nodiscard]] T bend(const T& s) const {
    const T width = T(1) / T(32), at = smaller(larger(s, width), T(T(1) - width));
    const T apart = width * step_.h;
    return ((*this)(T(at + width)) - T(2) * (*this)(at) + (*this)(T(at - width))) / (apart * apart);
  }

  [[nodiscard]] T operator()(const T& s) const {
    T m = value(linear_, s);
    if (any(hinge_.regularized_friction > T(0)))
      m = m + regularized_friction_moment(hinge_, value(rate_, s));
    if (smoothed_) m = m - smooth_step(step_.cubic(latch_state_, s) / epsilon_) * value(latch_, s);
    if (!system_.wing().is_real()) return m;
    if (!system_.wing().real.empty())
      m = m + real_moment(system_.wing().real[i_], system_.work().modes[i_], value(angle_, s),
                          value(rate_, s));
    for (const LoopTerms<T>& loop : system_.wing().loops)
      if (loop.first == i_ || loop.second == i_) m = m + of_loop(loop, s);
    return m;
  }

private:
  [[nodiscard]] Quintic<T> angle_of(int i) const {
    return step_.coordinate(system_.layout().angle(i), system_.layout().freedoms());
  }

  [[nodiscard]] T of_loop(const LoopTerms<T>& loop, const T& s) const {
    const Quintic<T> a = angle_of(loop.first), b = angle_of(loop.second);
    const LoopState<T> state = loop_state(loop, value(a, s), value(derivative(a, step_.h), s),
                                          value(b, s), value(derivative(b, step_.h), s));
    return (loop.first == i_ ? on_first(loop, state.gear) : on_second(loop)) *
           loop_torque(loop, state);
  }

  /// d/dt of regularized friction, which is a damping that falls with the rate.
  [[nodiscard]] ValueRange<T> change_of_friction() const {
    using std::abs;
    const ValueRange<T> rate = hull(rate_);
    const T size = smaller(T(abs(rate.low)), T(abs(rate.high)));
    const T least = select(rate.low < T(0) && rate.high > T(0), T(0), size);
    const T most = larger(T(abs(rate.low)), T(abs(rate.high)));
    const ValueRange<T> resistance{-regularized_friction_damping(hinge_, least),
                                   -regularized_friction_damping(hinge_, most)};
    return resistance * hull(derivative(rate_, step_.h));
  }

  /// d/dt of what a loop does; unknown where a strand goes slack, or its gear is a table's.
  [[nodiscard]] KnownRange<T> change_of(const LoopTerms<T>& loop) const {
    KnownRange<T> change;
    change.known = T(0) < T(0);
    if (loop.table) return change;
    const Quintic<T> a = angle_of(loop.first), b = angle_of(loop.second);
    Quintic<T> elastic;
    for (int k = 0; k < 6; ++k)
      elastic[k] = loop_state(loop, a[k], T(0), b[k], T(0)).elastic; // K e is a polynomial too
    const ValueRange<T> carried = hull(elastic);
    const auto elastic_too = loop.stiffness > T(0);
    change.known = carried.high <= loop.slack_beyond && carried.low >= -loop.slack_beyond &&
                   (elastic_too || !(loop.damping > T(0)));
    const Quintic<T> rise = derivative(elastic, step_.h), bend = derivative(rise, step_.h);
    const T time = select(elastic_too, T(loop.damping / loop.stiffness), T(0));
    Quintic<T> rate;
    for (int k = 0; k < 6; ++k) rate[k] = fused(time, bend[k], rise[k]);
    const T on = loop.first == i_ ? on_first(loop, T(loop.ratio)) : on_second(loop);
    change.range = scaled(on, hull(rate));
    return change;
  }

  /// What a loop may do over the step: K e and D ė as polynomials, about the table's slope at the
  /// step's start; what its bend adds is at most half the largest second derivative times the square
  /// of the way.
  [[nodiscard]] ValueRange<T> range_of(const LoopTerms<T>& loop) const {
    using std::abs;
    const Quintic<T> a = angle_of(loop.first), b = angle_of(loop.second);
    const Quintic<T> va = derivative(a, step_.h), vb = derivative(b, step_.h);
    const LoopState<T> start = loop_state(loop, a[0], va[0], b[0], vb[0]);
    const T on_a = loop.sense_a * start.gear;
    Quintic<T> elastic, viscous;
    for (int k = 0; k < 6; ++k) {
      elastic[k] =
          fused(loop.stiffness, on_a * (a[k] - a[0]) - loop.sense_b * (b[k] - b[0]), start.elastic);
      viscous[k] = loop.damping * (on_a * va[k] - loop.sense_b * vb[k]);
    }
    ValueRange<T> carried = hull(elastic), damped = hull(viscous);
    T gear = abs(start.gear);
    if (loop.table) {
      const ValueRange<T> way = hull(a), speed = hull(va);
      const T longest = way.high - way.low, fastest = larger(T(abs(speed.low)), T(abs(speed.high)));
      const T bend(loop.table->sharpest_bend()), turns = bend * longest;
      const T off = loop.stiffness * T(0.5) * turns * longest;
      carried = {carried.low - off, carried.high + off};
      damped = {damped.low - loop.damping * turns * fastest,
                damped.high + loop.damping * turns * fastest};
      gear = gear + turns;
    }
    damped.include(T(0)); // half of it where slack
    const T low = carried_by_strands(loop, carried.low) + damped.low;
    const T high = carried_by_strands(loop, carried.high) + damped.high;
    if (loop.second == i_) return scaled(loop.sense_b, ValueRange<T>{low, high});
    const T most = gear * larger(T(abs(low)), T(abs(high)));
    return {-most, most};
  }

  [[nodiscard]] static ValueRange<T> hull(const Quintic<T>& p) {
    ValueRange<T> range{p[0], p[0]};
    for (int k = 1; k < 6; ++k) range.include(p[k]);
    return range;
  }

  const AnySystem& system_;
  const HingeTerms<T>& hinge_;
  const Step<T>& step_;
  int i_;
  int latch_state_;
  T epsilon_;
  bool smoothed_;
  Quintic<T> angle_, rate_, linear_, latch_;
};

/// Raises `peak` to the largest |moment| over the step as the dense output has it. Most steps are
/// dismissed by the hull; the others are sampled, and refined beside the largest sample.
template <class T, class AnySystem>
void raise_by_interpolant(PeakOf<T>& peak, const MomentOverStep<T, AnySystem>& moment,
                          const Step<T>& step) {
  using std::abs;
  std::array<T, 9> samples;
  std::size_t best = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k] = abs(moment(T(k) / T(samples.size() - 1)));
    if (samples[k] > samples[best]) best = k;
  }
  if (samples[best] < T(sample_margin) * peak.value) return;
  const auto [found, vertex] =
      maximum_near(samples, best, [&](const T& s) { return T(abs(moment(s))); });
  peak.raise(found.value, step.t + found.s * step.h);
  peak.raise(T(abs(moment(vertex))), step.t + vertex * step.h);
}

/// dM/dt of hinge i, which slides or has no exact friction, at a state and its derivative; without
/// a smoothed latch, N·m/s.
template <class T, class AnySystem>
[[nodiscard]] T moment_rate(const AnySystem& system, const State<T>& x, const State<T>& dxdt,
                            int i) {
  const Layout& at = system.layout();
  const LinearLaw<T>& law = system.work().laws[i];
  const T& rate = x[at.rate(i)];
  T stiffness = law.stiffness, damping = law.damping;
  if (system.wing().hinges[i].regularized_friction > T(0))
    damping = damping + regularized_friction_damping(system.wing().hinges[i], rate);
  if (!system.wing().real.empty()) {
    const RealResistance<T> real =
        real_resistance(system.wing().real[i], system.work().modes[i], x[at.angle(i)], rate);
    stiffness = stiffness + real.stiffness, damping = damping + real.damping;
  }
  T change = -fused(stiffness, rate, damping * dxdt[at.rate(i)]);
  for (const LoopTerms<T>& loop : system.wing().loops) {
    if (loop.first != i && loop.second != i) continue; // its gear's change is neglected
    const LoopState<T> state = system.state_of(loop, x);
    const T a = loop.sense_a * state.gear, b = loop.sense_b;
    const T e1 = a * x[at.rate(loop.first)] - b * x[at.rate(loop.second)];
    const T e2 = a * dxdt[at.rate(loop.first)] - b * dxdt[at.rate(loop.second)];
    const T torque = taut_share(loop, state.elastic) * fused(loop.stiffness, e1, loop.damping * e2);
    change = fused(loop.first == i ? on_first(loop, state.gear) : on_second(loop), torque, change);
  }
  return change;
}

/// Raises `peak` to the |moment| at both ends of the step.
template <class T, class AnySystem>
void raise_to_ends(PeakOf<T>& peak, const MomentOverStep<T, AnySystem>& moment,
                   const Step<T>& step) {
  using std::abs;
  peak.raise(T(abs(moment(T(0)))), step.t);
  peak.raise(T(abs(moment(T(1)))), step.t + step.h);
}

/// A maximum of |moment| inside a step, known by the dense output alone.
template <class T> struct DoubtfulMoment {
  T s;    ///< fraction of the step
  T bend; ///< d²M/dt² there
  int corrections = 0;
};

/// Raises `peak` to the largest |moment| of hinge i over the step where that lies at one of its
/// ends. A maximum inside that the dense output finds must be made sure of by a step of the method
/// that ends there: then the peak has the method's accuracy, not the interpolant's.
/// @return where; `confirm_moment` takes it from there
template <class T, class AnySystem>
[[nodiscard]] std::optional<DoubtfulMoment<T>>
raise_moment(PeakOf<T>& peak, const AnySystem& system, const Step<T>& step, int i) {
  const MomentOverStep<T, AnySystem> moment(system, step, i);
  if (!(moment.most() > peak.value)) return std::nullopt;
  if (moment.keeps_direction()) {
    raise_to_ends(peak, moment, step);
    return std::nullopt;
  }
  PeakOf<T> candidate = peak;
  raise_by_interpolant(candidate, moment, step);
  if (!(candidate.value > peak.value)) return std::nullopt;
  const T s = (candidate.time - step.t) / step.h;
  if (s < T(next_to_an_end) || s > T(1 - next_to_an_end)) {
    peak = candidate;
    return std::nullopt;
  }
  raise_to_ends(peak, moment, step);
  return DoubtfulMoment<T>{s, moment.bend(s)};
}

/// A step of the method to `doubt.s` gave (x, dxdt): raises the peak, and corrects the instant by
/// Newton's method.
/// @return whether a step to the new `doubt.s` is worth making
template <class T, class AnySystem>
[[nodiscard]] bool confirm_moment(DoubtfulMoment<T>& doubt, PeakOf<T>& peak,
                                  const AnySystem& system, const Step<T>& step, int i,
                                  const State<T>& x, const State<T>& dxdt) {
  using std::abs;
  const T M = system.moment(x, i);
  peak.raise(T(abs(M)), step.t + doubt.s * step.h);
  const T late = system.layout().smoothed ? T(0) : T(moment_rate(system, x, dxdt, i) / doubt.bend);
  const T gain = T(0.5) * late * late * abs(doubt.bend);
  doubt.s = doubt.s - late / step.h;
  return M * doubt.bend < T(0) && gain > T(1e-12) * abs(M) && doubt.s > T(0) && doubt.s < T(1) &&
         ++doubt.corrections < 4;
}

/// The same for a hinge that sticks, whose moment takes an evaluation to know: it is at most its
/// linear part and the static limit; what that does not dismiss is sought by its curvature.
/// @param load load(s): |moment| by an evaluation on the dense output
/// @param budget spent: the moment is not known
/// @return where a step of the method must make sure of it
template <class T, class AnySystem, class Load>
[[nodiscard]] std::optional<T>
raise_held_moment(PeakOf<T>& peak, const AnySystem& system, const Step<T>& step, int i,
                  HeldLoadBound<T>& bound, SampleBudget& budget, Load&& load) {
  const T most = MomentOverStep<T, AnySystem>(system, step, i).most();
  if (!(most + system.static_limit(step.x, i) > peak.value)) return std::nullopt;
  bound.over_step(system, step);
  const T first = load(T(0)), last = load(T(1));
  const Sampled<T> found = largest_of(load, first, last, Bulge<T>{bound.rise(i)}, peak.value,
                                      T(1e-10) * peak.value, budget);
  peak.raise(first, step.t);
  peak.raise(last, step.t + step.h);
  if (!(found.value > peak.value)) return std::nullopt;
  return found.s;
}

} // namespace wingspread
