/// The largest reaction force of every hinge, inside steps as well as at their ends.
#pragma once

#include "core/dense/latch_states.hpp"
#include "core/number/planar.hpp"
#include "core/peaks/force_samples.hpp"
#include "core/peaks/maximum.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// Raises every hinge's `peaks` to its largest |reaction| over the step, given those at both ends.
/// Where `ReactionBound` allows a force above its peak, the recursion is evaluated at the step's middle, then at
/// its quarters. Where a quarter still allows it, the maximum is searched.
template <class T, class AnySystem> class ForcePeaks {
public:
  std::vector<PeakOf<T>> peaks; ///< 1 … n

  /// A run of the system begins.
  /// @param worth_a_step relative gain above which a further step of the method to a maximum is made
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

  /// Raises the peaks to the forces of the last evaluation of `system`, which was at t.
  void sample(const AnySystem& system, const T& t) {
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      before_[i] = magnitude(system, static_cast<int>(i));
      peaks[i].raise(before_[i], t);
    }
  }

  /// Raises the peaks over a step. A maximum inside the step that only the dense output shows becomes a doubt, for
  /// `confirm`. @pre the last evaluation was at the step's end
  /// @param may_rise whether any force may exceed its peak inside the step, as far as the caller knows
  void over_step(AnySystem& system, const Step<T>& step, State<T>& x, State<T>& dxdt,
                 bool may_rise = true) {
    samples_.keep(system, samples_.last);
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      std::array<T, 5>& f = samples_.of(static_cast<int>(i));
      f[0] = before_[i];
      before_[i] = f[4];
    }
    if (!may_rise) return;
    samples_.begin(system, levers_, step);
    const bool in_air = !system.wing().plates.empty(); // the bound has no term for the air
    if (!in_air && !samples_.may_rise(peaks)) return;
    sample(system, step, samples_.middle, x, dxdt);
    if (!in_air && !samples_.may_rise_in_a_half(peaks)) return;
    for (const int k : {1, 3}) sample(system, step, k, x, dxdt);
    for (std::size_t i = 1; i < peaks.size(); ++i)
      raise(system, step, static_cast<int>(i), x, dxdt);
  }

  /// The fraction of the step at which a step of the method must confirm a maximum; none without a doubt.
  [[nodiscard]] std::optional<T> doubtful() const {
    if (doubts_.empty()) return std::nullopt;
    return doubts_.back().s;
  }

  /// Raises the peak to the force at the end of that step, and corrects the instant by Newton's method where the
  /// gain is worth another step. @pre the last evaluation was at (x, dxdt), the step's end. Overwrites dxdt.
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
    samples_.keep(system, k);
  }

  static void evaluate(AnySystem& system, const Step<T>& step, const T& s, State<T>& x,
                       State<T>& dxdt) {
    interpolate(system, step, s, x);
    system(x, dxdt, step.t + s * step.h);
  }

  /// Given all five samples.
  void raise(AnySystem& system, const Step<T>& step, int i, State<T>& x, State<T>& dxdt) {
    samples_.raise_to_ends(i, step, peaks[i]);
    T highest = peaks[i].value;
    for (int k = 0; k <= samples_.last; ++k) {
      const bool wanted = system.wing().plates.empty()
                              ? samples_.wants_search(i, k, peaks[i])
                              : samples_.wants_search_in_air(i, k, peaks[i]);
      if (!wanted) continue;
      const auto [found, vertex] = maximum_near(samples_.of(i), k, [&](const T& s) {
        evaluate(system, step, s, x, dxdt);
        return magnitude(system, i);
      });
      if (!(found.value > highest)) continue;
      highest = found.value;
      doubts_.push_back({i, vertex, found.value, samples_.bend(i, k)});
    }
  }

  /// Whether the maximum of the dense output may lie elsewhere than that of the force. Their difference varies as
  /// s (1 − s) (1 − 5s + 5s²), the second derivative of the quintic's error: its slope by s is about 10 times the
  /// difference. Heuristic: 100 times are assumed, because the difference is small near the zeros of that polynomial.
  [[nodiscard]] bool may_be_off(const Doubt& doubt, const T& force) const {
    const T slope = T(100) * (force - doubt.force);
    return doubt.corrections < 2 && doubt.bend < T(0) &&
           slope * slope > T(-2) * doubt.bend * worth_a_step_ * force;
  }

  /// d|reaction|/dt at a state and its derivative, by a difference along the tangent, N/s.
  [[nodiscard]] T change(AnySystem& system, const Step<T>& step, const Doubt& doubt,
                         const State<T>& x, State<T>& dxdt) {
    const T way = step.h / T(1024); // the error is of the order of (ω way)² for a swing at ω
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
