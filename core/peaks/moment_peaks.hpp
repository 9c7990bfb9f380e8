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
      : hinge_(system.wing().hinges[i]), step_(step), latch_state_(system.layout().latch(i)),
        epsilon_(system.epsilon()), smoothed_(system.layout().smoothed && hinge_.has_latch) {
    const Layout& at = system.layout();
    const LinearLaw<T>& law = system.work().laws[i];
    const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
    rate_ = derivative(angle, step.h);
    for (int k = 0; k < 6; ++k) linear_[k] = linear_moment(law, angle[k], rate_[k]);
    for (int k = 0; smoothed_ && k < 6; ++k)
      latch_[k] = fused(hinge_.stiffness, angle[k] - hinge_.latched, hinge_.damping * rate_[k]);
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
    const T linear = larger(high, T(-low));
    return smoothed_ ? linear + bound(latch_) : linear;
  }

  /// d²/dt² at s, by differences.
  [[nodiscard]] T bend(const T& s) const {
    const T width = T(1) / T(32), at = smaller(larger(s, width), T(T(1) - width));
    const T apart = width * step_.h;
    return ((*this)(T(at + width)) - T(2) * (*this)(at) + (*this)(T(at - width))) / (apart * apart);
  }

  [[nodiscard]] T operator()(const T& s) const {
    T m = value(linear_, s);
    if (hinge_.regularized_friction > T(0))
      m = m + regularized_friction_moment(hinge_, value(rate_, s));
    if (smoothed_) m = m - smooth_step(step_.cubic(latch_state_, s) / epsilon_) * value(latch_, s);
    return m;
  }

private:
  const HingeTerms<T>& hinge_;
  const Step<T>& step_;
  int latch_state_;
  T epsilon_;
  bool smoothed_;
  Quintic<T> rate_, linear_, latch_;
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
  const T damping = system.wing().hinges[i].regularized_friction > T(0)
                        ? law.damping + regularized_friction_damping(system.wing().hinges[i], rate)
                        : law.damping;
  return -fused(law.stiffness, rate, damping * dxdt[at.rate(i)]);
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
  using std::abs;
  const MomentOverStep<T, AnySystem> moment(system, step, i);
  if (!(moment.most() > peak.value)) return std::nullopt;
  PeakOf<T> candidate = peak;
  raise_by_interpolant(candidate, moment, step);
  if (!(candidate.value > peak.value)) return std::nullopt;
  const T s = (candidate.time - step.t) / step.h;
  constexpr double at_an_end = 1e-5; // there the interpolant is right to round-off
  if (s < T(at_an_end) || s > T(1 - at_an_end)) {
    peak = candidate;
    return std::nullopt;
  }
  peak.raise(T(abs(moment(T(0)))), step.t);
  peak.raise(T(abs(moment(T(1)))), step.t + step.h);
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
/// @return where a step of the method must make sure of it
template <class T, class AnySystem, class Load>
[[nodiscard]] std::optional<T> raise_held_moment(PeakOf<T>& peak, const AnySystem& system,
                                                 const Step<T>& step, int i,
                                                 HeldLoadBound<T>& bound, Load&& load) {
  const T most = MomentOverStep<T, AnySystem>(system, step, i).most();
  if (!(most + system.wing().hinges[i].static_friction > peak.value)) return std::nullopt;
  bound.over_step(system, step);
  const T first = load(T(0)), last = load(T(1));
  const Sampled<T> found =
      largest_of(load, first, last, bound.rise(i), peak.value, T(1e-10) * peak.value);
  peak.raise(first, step.t);
  peak.raise(last, step.t + step.h);
  if (!(found.value > peak.value)) return std::nullopt;
  return found.s;
}

} // namespace wingspread
