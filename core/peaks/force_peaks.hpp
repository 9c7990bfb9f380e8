/// The largest force that a hinge sees, inside steps and not only at their ends.
#pragma once

#include "core/dense/step.hpp"
#include "core/number/planar.hpp"
#include "core/peaks/maximum.hpp"
#include "core/peaks/peak.hpp"
#include "core/peaks/reaction_bound.hpp"

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
  void start(const AnySystem& system) {
    const int bodies = system.layout().bodies;
    peaks.assign(bodies + 1, {});
    before_.assign(bodies + 1, T(0));
    inner_.assign(bodies + 1, {});
    set_levers(system.wing(), system.topology(), levers_);
    bound_.resize(bodies);
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
    bound_.over_step(system, levers_, step);
    bool promising = !system.wing().plates.empty(); // the bound knows nothing of the air
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      const T end = magnitude(system, static_cast<int>(i));
      inner_[i] = {before_[i], T(0), T(0), T(0), end};
      before_[i] = end;
      promising = promising || may_rise(i, inner_[i][0], inner_[i][4], T(1));
    }
    if (!promising) return;
    sample(system, step, 2, x, dxdt);
    promising = !system.wing().plates.empty();
    for (std::size_t i = 1; i < peaks.size(); ++i)
      for (const std::size_t end : {0, 4})
        promising = promising || may_rise(i, inner_[i][end], inner_[i][2], T(1) / T(4));
    if (!promising) return;
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

  /// Whether |reaction| i may exceed its peak between points where it is a and b.
  /// @param part of the rise over the whole step
  [[nodiscard]] bool may_rise(std::size_t i, const T& a, const T& b, const T& part) const {
    return !(fused(part, bound_.rise(static_cast<int>(i)), larger(a, b)) <= peaks[i].value);
  }

  /// At k quarters of the step.
  void sample(AnySystem& system, const Step<T>& step, int k, State<T>& x, State<T>& dxdt) {
    evaluate(system, step, T(k) / T(4), x, dxdt);
    for (std::size_t i = 1; i < peaks.size(); ++i)
      inner_[i][k] = magnitude(system, static_cast<int>(i));
  }

  static void evaluate(AnySystem& system, const Step<T>& step, const T& s, State<T>& x,
                       State<T>& dxdt) {
    step.interpolate(system.layout(), s, x);
    system(x, dxdt, step.t + s * step.h);
  }

  /// Given all five samples.
  void raise(AnySystem& system, const Step<T>& step, int i, State<T>& x, State<T>& dxdt) {
    const std::array<T, 5>& f = inner_[i];
    peaks[i].raise(f[0], step.t);
    peaks[i].raise(f[4], step.t + step.h);
    T highest = peaks[i].value;
    for (std::size_t k = 0; k <= 4; ++k) {
      const bool crest = (k == 0 || f[k] >= f[k - 1]) && (k == 4 || f[k] >= f[k + 1]);
      if (!crest || !may_rise(i, f[k], f[k], T(1) / T(16)) || at_an_end_for_sure(f, k)) continue;
      const auto [found, vertex] = maximum_near(f, k, [&](const T& s) {
        evaluate(system, step, s, x, dxdt);
        return magnitude(system, i);
      });
      if (!(found.value > highest)) continue;
      highest = found.value;
      doubts_.push_back({i, vertex, T(step.t + vertex * step.h)});
    }
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

  std::vector<Lever<T>> levers_; ///< 0 … n
  ReactionBound<T> bound_;
  std::vector<T> before_;
  std::vector<std::array<T, 5>> inner_;
  std::vector<Doubt> doubts_; ///< last in, first out
};

} // namespace wingspread
