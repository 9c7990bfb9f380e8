/// The largest force that a hinge sees, inside steps and not only at their ends.
#pragma once

#include "core/dense/step.hpp"
#include "core/number/planar.hpp"
#include "core/peaks/force_samples.hpp"
#include "core/peaks/maximum.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// Raises every hinge's `peaks` to its largest |reaction| over the step, given those at both ends.
/// A step that may rise above a peak by `ReactionBound` is halved, and once more, by evaluating the
/// recursion on the dense output; where a quarter may still, its maximum is sought.
template <class T, class AnySystem> class ForcePeaks {
public:
  std::vector<PeakOf<T>> peaks; ///< 1 … n

  /// A run of the system begins.
  /// @param worth_a_step what a further step of the method to a maximum must gain, relative
  void start(const AnySystem& system, double worth_a_step = 1) {
    const int bodies = system.layout().bodies;
    worth_a_step_ = T(worth_a_step);
    for (State<T>* state : {&beside_, &slope_}) state->resize(system.layout().size());
    peaks.assign(bodies + 1, {});
    before_.assign(bodies + 1, T(0));
    set_levers(system.wing(), system.topology(), levers_);
    samples_.resize(bodies);
    doubts_.clear();
  }

  /// |reaction| at the start of the next step, 1 … n, N.
  [[nodiscard]] std::vector<T>& before() { return before_; }

  /// The last evaluation of `system` was at t: takes the forces as they stand.
  void sample(const AnySystem& system, const T& t) {
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      before_[i] = magnitude(system, static_cast<int>(i));
      peaks[i].raise(before_[i], t);
    }
  }

  /// The last evaluation was at the step's end. What lies inside the step is left in doubt.
  void over_step(AnySystem& system, const Step<T>& step, State<T>& x, State<T>& dxdt) {
    samples_.begin(system, levers_, step);
    samples_.take(system, samples_.last);
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      std::array<T, 5>& f = samples_.of(static_cast<int>(i));
      f[0] = before_[i];
      before_[i] = f[4];
    }
    const bool in_air = !system.wing().plates.empty(); // the bound knows nothing of the air
    if (!in_air && !samples_.may_rise(peaks)) return;
    sample(system, step, samples_.middle, x, dxdt);
    if (!in_air && !samples_.may_rise_in_a_half(peaks)) return;
    for (const int k : {1, 3}) sample(system, step, k, x, dxdt);
    for (std::size_t i = 1; i < peaks.size(); ++i)
      raise(system, step, static_cast<int>(i), x, dxdt);
  }

  /// Where a step of the method must make sure of a maximum found by the dense output, as a
  /// fraction of the step; none if nothing is in doubt.
  [[nodiscard]] std::optional<T> doubtful() const {
    if (doubts_.empty()) return std::nullopt;
    return doubts_.back().s;
  }

  /// That step has been made to (x, dxdt), and its last evaluation was there: raises the peak, and
  /// corrects the instant by Newton's method where that is worth another step. dxdt is overwritten.
  void confirm(AnySystem& system, const Step<T>& step, const State<T>& x, State<T>& dxdt) {
    Doubt doubt = doubts_.back();
    doubts_.pop_back();
    const T force = magnitude(system, doubt.hinge);
    peaks[doubt.hinge].raise(force, step.t + doubt.s * step.h);
    if (!may_be_off(doubt, force)) return;
    const T late = step.h * change(system, step, doubt, x, dxdt) / doubt.bend;
    const T gain = T(-0.5) * late * late * doubt.bend;
    doubt.s = doubt.s - late, ++doubt.corrections;
    if (gain > worth_a_step_ * force && late * late < T(0.01) && doubt.s > T(0) && doubt.s < T(1))
      doubts_.push_back(doubt);
  }

private:
  struct Doubt {
    int hinge;
    T s;     ///< fraction of the step
    T force; ///< there, by the dense output, N
    T bend;  ///< its d²/ds², N
    int corrections = 0;
  };

  [[nodiscard]] static T magnitude(const AnySystem& system, int i) {
    return ForceSamples<T>::magnitude(system.work().forces[i]);
  }

  /// At k quarters of the step.
  void sample(AnySystem& system, const Step<T>& step, int k, State<T>& x, State<T>& dxdt) {
    evaluate(system, step, T(k) / T(4), x, dxdt);
    samples_.take(system, k);
  }

  static void evaluate(AnySystem& system, const Step<T>& step, const T& s, State<T>& x,
                       State<T>& dxdt) {
    step.interpolate(system.layout(), s, x);
    system(x, dxdt, step.t + s * step.h);
  }

  /// Given all five samples.
  void raise(AnySystem& system, const Step<T>& step, int i, State<T>& x, State<T>& dxdt) {
    samples_.raise_to_ends(i, step, peaks[i]);
    T highest = peaks[i].value;
    for (int k = 0; k <= samples_.last; ++k) {
      if (!samples_.wants_search(i, k, peaks[i])) continue;
      const auto [found, vertex] = maximum_near(samples_.of(i), k, [&](const T& s) {
        evaluate(system, step, s, x, dxdt);
        return magnitude(system, i);
      });
      if (!(found.value > highest)) continue;
      highest = found.value;
      doubts_.push_back({i, vertex, found.value, samples_.bend(i, k)});
    }
  }

  /// Whether the dense output is so far from the force that its maximum may stand elsewhere. Their
  /// difference goes with s (1 − s) (1 − 5s + 5s²), a derivative of the quintic's own error: in a
  /// step its slope is 10 times as large, and 100 times but for the neighbourhood of its zeros.
  [[nodiscard]] bool may_be_off(const Doubt& doubt, const T& force) const {
    const T slope = T(100) * (force - doubt.force);
    return doubt.corrections < 2 && doubt.bend < T(0) &&
           slope * slope > T(-2) * doubt.bend * worth_a_step_ * force;
  }

  /// d|reaction|/dt at a state and its derivative, by a difference along the tangent, N/s.
  [[nodiscard]] T change(AnySystem& system, const Step<T>& step, const Doubt& doubt,
                         const State<T>& x, State<T>& dxdt) {
    const T way = step.h / T(1024); // errors of its square, times that of a swing's rate
    const T t = step.t + doubt.s * step.h;
    slope_ = dxdt;
    const auto beside = [&](const T& dt) {
      for (std::size_t c = 0; c < x.size(); ++c) beside_[c] = fused(dt, slope_[c], x[c]);
      system(beside_, dxdt, t + dt);
      return magnitude(system, doubt.hinge);
    };
    const T after = beside(way);
    return (after - beside(-way)) / (T(2) * way);
  }

  std::vector<Lever<T>> levers_; ///< 0 … n
  ForceSamples<T> samples_;
  std::vector<T> before_;
  std::vector<Doubt> doubts_; ///< last in, first out
  T worth_a_step_ = T(0);
  State<T> beside_, slope_; ///< scratch
};

} // namespace wingspread
