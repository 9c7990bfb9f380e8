/// The largest force that a hinge sees, inside steps and not only at their ends.
#pragma once

#include "core/dense/step.hpp"
#include "core/number/planar.hpp"
#include "core/peaks/maximum.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// Raises every hinge's `peaks` to its largest |reaction| over the step, given those at both ends.
/// A step with an end within a quarter of a peak is sampled at three inner points by evaluating the
/// recursion on the dense output, and refined beside the largest.
template <class T, class AnySystem> class ForcePeaks {
public:
  std::vector<PeakOf<T>> peaks; ///< 1 … n

  void start(int bodies) {
    peaks.assign(bodies + 1, {});
    before_.assign(bodies + 1, T(0));
    inner_.assign(bodies + 1, {});
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
    bool promising = false;
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      const T end = magnitude(system, static_cast<int>(i));
      inner_[i] = {before_[i], T(0), T(0), T(0), end};
      promising = promising || T(1.25) * larger(before_[i], end) > peaks[i].value;
      before_[i] = end;
    }
    if (!promising) return;
    for (int k = 1; k <= 3; ++k) {
      evaluate(system, step, T(k) / T(4), x, dxdt);
      for (std::size_t i = 1; i < peaks.size(); ++i)
        inner_[i][k] = magnitude(system, static_cast<int>(i));
    }
    for (std::size_t i = 1; i < peaks.size(); ++i)
      raise(system, step, static_cast<int>(i), x, dxdt);
  }

  /// Where a step of the method must make sure of a maximum found by the dense output, as a
  /// fraction of the step; none if nothing is in doubt.
  [[nodiscard]] std::optional<T> doubtful() const {
    if (doubts_.empty()) return std::nullopt;
    return doubts_.back().s;
  }

  /// That step has been made, and its last evaluation was there.
  void confirm(const AnySystem& system) {
    const Doubt doubt = doubts_.back();
    doubts_.pop_back();
    peaks[doubt.hinge].raise(magnitude(system, doubt.hinge), doubt.time);
  }

private:
  struct Doubt {
    int hinge;
    T s, time;
  };

  [[nodiscard]] static T magnitude(const AnySystem& system, int i) {
    using std::sqrt;
    const Vec2<T>& f = system.work().forces[i];
    return sqrt(dot(f, f));
  }

  static void evaluate(AnySystem& system, const Step<T>& step, const T& s, State<T>& x,
                       State<T>& dxdt) {
    step.interpolate(system.layout(), s, x);
    system(x, dxdt, step.t + s * step.h);
  }

  void raise(AnySystem& system, const Step<T>& step, int i, State<T>& x, State<T>& dxdt) {
    std::size_t best = 0;
    for (std::size_t k = 1; k <= 4; ++k)
      if (inner_[i][k] > inner_[i][best]) best = k;
    if (inner_[i][best] < T(sample_margin) * peaks[i].value) return;
    peaks[i].raise(inner_[i][0], step.t);
    peaks[i].raise(inner_[i][4], step.t + step.h);
    if (at_an_end_for_sure(inner_[i], best)) return;
    const auto [found, vertex] = maximum_near(inner_[i], best, [&](const T& s) {
      evaluate(system, step, s, x, dxdt);
      return magnitude(system, i);
    });
    if (found.value > peaks[i].value) doubts_.push_back({i, vertex, T(step.t + vertex * step.h)});
  }

  /// The samples rise or fall towards an end so steeply that a parabola through the last three has
  /// its vertex well outside the step.
  [[nodiscard]] static bool at_an_end_for_sure(const std::array<T, 5>& f, std::size_t best) {
    using std::abs;
    if (best != 0 && best != 4) return false;
    const T a = best == 0 ? f[0] : f[4], b = best == 0 ? f[1] : f[3], c = f[2];
    const T slope = T(3) * a - T(4) * b + c; // towards the end, times 2 spacings
    const T curvature = a - T(2) * b + c;
    return slope > T(2) * abs(curvature);
  }

  std::vector<T> before_;
  std::vector<std::array<T, 5>> inner_;
  std::vector<Doubt> doubts_; ///< last in, first out
};

} // namespace wingspread
