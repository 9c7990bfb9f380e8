/// The largest moment of a hinge over a step, inside the step as well as at its ends.
///
/// 1. The laws' ranges bound the moment: a step that cannot exceed the known peak is dismissed (most).
/// 2. The laws' changes prove that the moment only rises or only falls: the peak lies at an end (keeps_direction).
/// 3. Otherwise nine samples and parabolas find the maximum inside the step (raise_by_interpolant), and a step of
///    the method that ends there confirms it (confirm_moment).
///
/// All ranges and changes come from core/laws.
#pragma once

#include "core/dense/latch_states.hpp"
#include "core/dense/step_interpolant.hpp"
#include "core/events/stuck_load.hpp"
#include "core/mechanics/system.hpp"
#include "core/peaks/maximum.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <optional>

namespace wingspread {

/// Moment of one hinge over a step, by the dense output, N·m.
template <class T, class AnySystem> class MomentOverStep {
public:
  MomentOverStep(const AnySystem& system, const Step<T>& step, int i)
      : system_(system), hinge_(system.wing().hinges[i]), step_(step), i_(i),
        epsilon_(system.epsilon()), smoothed_(system.layout().smoothed && hinge_.has_latch) {
    if (smoothed_) latch_state_ = latch_state(system, step, i);
    own_.angle = angle_of(i);
    own_.rate = depends_on_rate() ? rate_of(i) : Quintic<T>{};
    linear_ = linear_moment(system.work().laws[i], own_.angle, own_.rate);
    if (has_motor()) excess_ = motor_excess(system.work().motors[i], step.t, step.h, own_.rate);
  }

  /// Upper bound of |moment| in the step, by the laws' ranges.
  [[nodiscard]] T most() const {
    ValueRange<T> range = hull(linear_) + regularized_friction_range(hinge_, hull(own_.rate));
    if (system_.wing().is_real()) range = range + range_of_real();
    const T linear = larger(range.high, T(-range.low));
    return smoothed_ ? linear + most_of_smoothed_latch(hinge_, own_.angle, own_.rate) : linear;
  }

  /// A range of the real hinge's laws and the loops, N·m.
  [[nodiscard]] ValueRange<T> range_of_real() const {
    const Wing<T>& wing = system_.wing();
    ValueRange<T> range{T(0), T(0)};
    if (!wing.real.empty() && wing.real[i_].has_law())
      range =
          real_range(wing.real[i_], system_.work().modes[i_], hull(own_.angle), hull(own_.rate));
    if (has_motor())
      range = range + motor_range(wing.motors[i_], system_.work().motors[i_], excess_);
    for (const LoopTerms<T>& loop : wing.loops)
      if (joins(loop, i_)) range = range + range_of(loop);
    return range;
  }

  /// Whether the moment provably only rises or only falls over the step, by the laws' changes: then it is
  /// largest at an end. Never with a smoothed latch. For a pack: in which lanes.
  [[nodiscard]] auto keeps_direction() const {
    KnownRange<T> change;
    change.range = hull(derivative(linear_, step_.h));
    const Wing<T>& wing = system_.wing();
    const auto acceleration = [&] { return hull(derivative(own_.rate, step_.h)); };
    if (wing.has_regularized_friction)
      change.add(regularized_friction_change(hinge_, hull(own_.rate), acceleration()));
    if (!wing.real.empty())
      change.add(real_change(wing.real[i_], system_.work().modes[i_], hull(own_.angle),
                             hull(own_.rate), acceleration()));
    if (has_motor())
      change.add(motor_change(wing.motors[i_], system_.work().motors[i_], excess_, step_.h));
    for (const LoopTerms<T>& loop : wing.loops)
      if (any(change.known) && joins(loop, i_))
        change.add(
            loop_moment_change(loop, i_, path(loop.first).angle, path(loop.second).angle, step_.h));
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
      m = m + regularized_friction_moment(hinge_, value(own_.rate, s));
    if (smoothed_)
      m = m + smoothed_latch_moment(hinge_, value(own_.angle, s), value(own_.rate, s),
                                    value(latch_state_, s), epsilon_);
    if (!system_.wing().is_real()) return m;
    if (!system_.wing().real.empty())
      m = m + system_.moment_of_laws(i_, value(own_.angle, s), value(own_.rate, s));
    if (has_motor())
      m = m + motor_moment(system_.wing().motors[i_], system_.work().motors[i_], value(excess_, s));
    for (const LoopTerms<T>& loop : system_.wing().loops)
      if (joins(loop, i_)) m = m + moment_of(loop, s);
    return m;
  }

private:
  [[nodiscard]] Quintic<T> angle_of(int i) const {
    return step_.coordinate(system_.layout().angle(i), system_.layout().freedoms());
  }

  [[nodiscard]] bool has_motor() const {
    return !system_.wing().motors.empty() && system_.wing().motors[i_].present;
  }

  /// Whether any term of the moment depends on the hinge's rate.
  [[nodiscard]] bool depends_on_rate() const {
    return any(!(system_.work().laws[i_].damping == T(0))) || system_.wing().is_nonlinear() ||
           smoothed_;
  }

  [[nodiscard]] Quintic<T> rate_of(int i) const {
    return step_.rate(system_.layout().angle(i), system_.layout().freedoms());
  }

  /// A hinge's motion over the step.
  struct Path {
    Quintic<T> angle, rate;
  };

  /// The motion of the hinge itself, or of one that a loop joins to it: kept, for a step is sampled many times.
  [[nodiscard]] const Path& path(int i) const {
    if (i == i_) return own_;
    const int place = i % 2;
    if (joined_[place] != i) {
      joined_[place] = i;
      paths_[place].angle = angle_of(i);
      paths_[place].rate = rate_of(i);
    }
    return paths_[place];
  }

  /// A range of a loop's moment, N·m.
  [[nodiscard]] ValueRange<T> range_of(const LoopTerms<T>& loop) const {
    const Path &a = path(loop.first), &b = path(loop.second);
    return loop_moment_range(loop, i_, a.angle, a.rate, b.angle, b.rate);
  }

  /// Moment of a loop at s, N·m.
  [[nodiscard]] T moment_of(const LoopTerms<T>& loop, const T& s) const {
    const Path &a = path(loop.first), &b = path(loop.second);
    const LoopState<T> state =
        loop_state(loop, value(a.angle, s), value(a.rate, s), value(b.angle, s), value(b.rate, s));
    return on_hinge(loop, i_, state.gear) * loop_torque(loop, state);
  }

  const AnySystem& system_;
  const HingeTerms<T>& hinge_;
  const Step<T>& step_;
  int i_;
  Quintic<T> latch_state_; ///< if smoothed
  T epsilon_;
  bool smoothed_;
  Path own_;                            ///< its rate only where depends_on_rate
  mutable std::array<int, 2> joined_{}; ///< hinges of `paths_`; 0: none
  mutable std::array<Path, 2> paths_;
  Quintic<T> linear_;
  Quintic<T> excess_; ///< of a motor's command over the rate; only where the hinge has a motor
};

/// |moment| at eighths of a step, N·m.
template <class T, class Moment>
[[nodiscard]] std::array<T, 9> moment_samples(const Moment& moment) {
  using std::abs;
  std::array<T, 9> samples;
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k] =
        abs(moment(T(static_cast<double>(k)) / T(static_cast<double>(samples.size() - 1))));
  return samples;
}

/// Raises `peak` to the largest |moment| that the dense output has over the step: samples the step, and refines
/// the largest sample. @param moment moment(s), as MomentOverStep has it
template <class T, class Moment>
void raise_by_interpolant(PeakOf<T>& peak, const Moment& moment, const Step<T>& step) {
  using std::abs;
  const std::array<T, 9> samples = moment_samples<T>(moment);
  std::size_t best = 0;
  for (std::size_t k = 0; k < samples.size(); ++k)
    if (samples[k] > samples[best]) best = k;
  if (most_by_samples(samples) <= peak.value) return;
  const auto [found, vertex] =
      maximum_near(samples, best, [&](const T& s) { return T(abs(moment(s))); });
  peak.raise(found.value, step.t + found.s * step.h);
  peak.raise(T(abs(moment(vertex))), step.t + vertex * step.h);
}

/// dM/dt of hinge i at a state, its derivative and t, N·m/s. @pre the hinge does not stick and has no smoothed latch
template <class T, class AnySystem>
[[nodiscard]] T moment_rate(const AnySystem& system, const State<T>& x, const State<T>& dxdt,
                            const T& t, int i) {
  const Layout& at = system.layout();
  const LinearLaw<T>& law = system.work().laws[i];
  const T& rate = x[at.rate(i)];
  T stiffness = law.stiffness, damping = law.damping;
  if (system.wing().hinges[i].regularized_friction > T(0))
    damping = damping + regularized_friction_damping(system.wing().hinges[i], rate);
  if (!system.wing().real.empty()) {
    const HingeResistance<T> real =
        real_resistance(system.wing().real[i], system.work().modes[i], x[at.angle(i)], rate);
    stiffness = stiffness + real.stiffness, damping = damping + real.damping;
  }
  T change = -fused(stiffness, rate, damping * dxdt[at.rate(i)]);
  if (!system.wing().motors.empty())
    change = change + motor_moment_rate(system.wing().motors[i], system.work().motors[i], t, rate,
                                        dxdt[at.rate(i)]);
  for (const LoopTerms<T>& loop : system.wing().loops) {
    if (!joins(loop, i)) continue;
    const LoopState<T> state = system.state_of(loop, x);
    const auto of_both = [&](const State<T>& from) -> std::array<T, 2> {
      return {from[at.rate(loop.first)], from[at.rate(loop.second)]};
    };
    const T torque = loop_torque_rate(loop, state, of_both(x), of_both(dxdt));
    change = fused(on_hinge(loop, i, state.gear), torque, change);
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

/// Moment of a stuck hinge at a step's ends, N·m.
template <class T> struct HeldMoments { T first, last; };

/// Raises `peak` to the larger magnitude of a locked hinge's moment at the step's ends.
template <class T>
void raise_to_ends(PeakOf<T>& peak, const HeldMoments<T>& ends, const Step<T>& step) {
  using std::abs;
  peak.raise(T(abs(ends.first)), step.t);
  peak.raise(T(abs(ends.last)), step.t + step.h);
}

/// A maximum of |moment| inside a step, known by the dense output alone.
template <class T> struct DoubtfulMoment {
  T s;    ///< fraction of the step
  T bend; ///< d²M/dt² there
  int corrections = 0;
};

/// Raises `peak` to the largest |moment| of hinge i at the step's ends.
/// @return a maximum inside the step that the dense output finds above the peak. A step of the method must end
/// there and `confirm_moment` be called: then the peak has the method's accuracy, not the interpolant's
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

/// Raises the peak to the moment at the end of a step of the method to `doubt.s`, and corrects `doubt.s` by
/// Newton's method. @param x, dxdt the state and its derivative there
/// @param worth_a_step share of the moment
/// @return whether another step, to the new `doubt.s`, gains more than that; at most 4 corrections
template <class T, class AnySystem>
[[nodiscard]] bool confirm_moment(DoubtfulMoment<T>& doubt, PeakOf<T>& peak,
                                  const AnySystem& system, const Step<T>& step, int i,
                                  const State<T>& x, const State<T>& dxdt, double worth_a_step) {
  using std::abs;
  const T M = system.moment(x, i);
  peak.raise(T(abs(M)), step.t + doubt.s * step.h);
  const T late =
      system.layout().smoothed
          ? T(0)
          : T(moment_rate(system, x, dxdt, T(step.t + doubt.s * step.h), i) / doubt.bend);
  const T gain = T(0.5) * late * late * abs(doubt.bend);
  doubt.s = doubt.s - late / step.h;
  return M * doubt.bend < T(0) && gain > T(worth_a_step) * abs(M) && doubt.s > T(0) &&
         doubt.s < T(1) && ++doubt.corrections < 4;
}

/// Whether a stuck hinge's |moment| may exceed its peak in a step, by the laws' ranges and the static limit.
template <class T, class AnySystem>
[[nodiscard]] Truth<T> held_moment_may_rise(const PeakOf<T>& peak, const AnySystem& system,
                                            const Step<T>& step, int i) {
  const T most = MomentOverStep<T, AnySystem>(system, step, i).most();
  return most + system.static_limit(step.x, i) > peak.value;
}

/// Difference below which two moments of stuck hinge i count as one, N·m: as negligible_load (slipping.hpp).
template <class T>
[[nodiscard]] T negligible(const PeakOf<T>& peak, const HeldLoadBound<T>& bound, int i) {
  return T(1e-10) * larger(peak.value, bound.size(i));
}

/// Raises `peak` to the largest |load| of a locked hinge at the step's ends, and says where inside it is larger.
/// @param rise  largest excess over the larger end
/// @param close difference below which two loads count as one, N·m
/// @param by_parts whether `rise` holds for any part of the step too
/// @param load  as of raise_held_moment
template <class T, class Load>
[[nodiscard]] std::optional<T> raise_locked_load(PeakOf<T>& peak, const Step<T>& step,
                                                 const HeldMoments<T>& ends, const Bulge<T>& rise,
                                                 const T& close, bool by_parts, Load&& load) {
  using std::abs;
  const T first = abs(ends.first), last = abs(ends.last);
  Sampled<T> found{T(0), T(0)};
  if (wants_samples(first, last, rise, peak.value, close)) {
    StepInterpolant<T> interpolant;
    interpolant.begin(load, ends.first, ends.last);
    const auto size = [&](const T& s) { return T(abs(load(s))); };
    if (!by_parts || may_crest_between(interpolant.begun(), rise, peak.value, close))
      found = interpolant.resolve(load, close) ? interpolant.largest_magnitude()
                                               : largest_of(size, first, last, rise, peak.value,
                                                            close, shortest_part(step.t, step.h));
  }
  raise_to_ends(peak, ends, step);
  if (!(found.value > peak.value)) return std::nullopt;
  return found.s;
}

/// Narrows the bound on a locked hinge's load if the wide bound does not dismiss the step.
/// @param rise by the wide bound; other parameters as of raise_locked_load
template <class T, class AnySystem>
void narrow_if_needed(HeldLoadBound<T>& bound, const AnySystem& system, const Step<T>& step, int i,
                      const HeldMoments<T>& ends, const Bulge<T>& rise, const PeakOf<T>& peak,
                      const T& close) {
  using std::abs;
  if (wants_samples(T(abs(ends.first)), T(abs(ends.last)), rise, peak.value, close))
    bound.narrow(system, step, i);
}

/// Raises `peak` to the largest |moment| of a stuck hinge i at the step's ends. A value inside takes an evaluation, so
/// cheaper tests come first: held_moment_may_rise, then the load's curvature, over the whole step and between three
/// samples. The maximum inside is that of a polynomial through samples; where few samples do not resolve the load, it
/// is searched by the load's curvature.
/// @param bound_of_step () → HeldLoadBound<T>&, over the step
/// @param load load(s): the moment by an evaluation on the dense output
/// @return where a step of the method must confirm a larger value
template <class T, class AnySystem, class BoundOfStep, class Load>
[[nodiscard]] std::optional<T>
raise_held_moment(PeakOf<T>& peak, const AnySystem& system, const Step<T>& step, int i,
                  const HeldMoments<T>& ends, const BoundOfStep& bound_of_step, Load&& load) {
  if (!held_moment_may_rise(peak, system, step, i)) return std::nullopt;
  HeldLoadBound<T>& bound = bound_of_step();
  const T close = negligible(peak, bound, i);
  narrow_if_needed(bound, system, step, i, ends, Bulge<T>{bound.rise(i)}, peak, close);
  return raise_locked_load(peak, step, ends, Bulge<T>{bound.rise(i)}, close, true, load);
}

} // namespace wingspread
