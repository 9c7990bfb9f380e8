/// Samples of hinge forces at quarters of a step, and bounds of the forces between samples.
///
/// T is a number or a pack of numbers: lanes and single runs decide by the same expressions. Decisions are bools
/// for a number and masks for a pack.
#pragma once

#include "core/peaks/peak.hpp"
#include "core/peaks/reaction_bound.hpp"

#include <array>
#include <vector>

namespace wingspread {

template <class T> class ForceSamples {
public:
  static constexpr int middle = 2, last = 4;

  void resize(int bodies) {
    samples_.assign(bodies + 1, {T(0), T(0), T(0), T(0), T(0)});
    bound_.resize(bodies);
  }

  /// Bounds the forces of a step. @param levers of its wing, 0 … n
  template <class AnySystem>
  void begin(const AnySystem& system, const std::vector<Lever<T>>& levers, const Step<T>& step) {
    bound_.over_step(system, levers, step);
  }

  /// |reaction| of hinge i at quarters of the step, N.
  [[nodiscard]] std::array<T, 5>& of(int i) { return samples_[i]; }
  [[nodiscard]] const std::array<T, 5>& of(int i) const { return samples_[i]; }

  /// Stores the forces of the system's last evaluation, which was at k quarters of the step.
  template <class AnySystem> void keep(const AnySystem& system, int k) {
    for (int i = 1; i < static_cast<int>(samples_.size()); ++i)
      samples_[i][k] = magnitude(system.work().forces[i]);
  }
  [[nodiscard]] static T magnitude(const Vec2<T>& force) {
    using std::sqrt;
    return sqrt(dot(force, force));
  }

  /// Whether any force may exceed its peak between the step's ends.
  [[nodiscard]] auto may_rise(const std::vector<PeakOf<T>>& peaks) const {
    auto may = T(0) < T(0);
    for (int i = 1; i < static_cast<int>(samples_.size()); ++i)
      may = may || may_rise(i, samples_[i][0], samples_[i][last], T(1), peaks[i]);
    return may;
  }
  /// Whether any force may exceed its peak in either half, given the sample in the middle.
  [[nodiscard]] auto may_rise_in_a_half(const std::vector<PeakOf<T>>& peaks) const {
    auto may = T(0) < T(0);
    for (int i = 1; i < static_cast<int>(samples_.size()); ++i)
      for (const int end : {0, last})
        may = may || may_rise(i, samples_[i][end], samples_[i][middle], T(1) / T(4), peaks[i]);
    return may;
  }

  /// Raises a peak to the samples at the ends.
  void raise_to_ends(int i, const Step<T>& step, PeakOf<T>& peak) const {
    peak.raise(samples_[i][0], step.t);
    peak.raise(samples_[i][last], step.t + step.h);
  }
  /// Whether a maximum above the peak may lie beside sample k.
  [[nodiscard]] auto wants_search(int i, int k, const PeakOf<T>& peak) const {
    const std::array<T, 5>& f = samples_[i];
    return crests(i, k) && may_rise(i, f[k], f[k], T(1) / T(16), peak);
  }
  /// The same in air, by the samples alone, because the bound has no term for air. A resolved crest exceeds the samples
  /// by at most an eighth of their second difference. Heuristic: four times as much is allowed; with less, a crest is
  /// lost if the peak so far lies between it and the samples.
  [[nodiscard]] auto wants_search_in_air(int i, int k, const PeakOf<T>& peak) const {
    using std::abs;
    const T excess = abs(bend(i, k)) / T(32);
    return crests(i, k) && samples_[i][k] + excess > peak.value;
  }

  /// d²/ds² by the samples about the k-th, N.
  [[nodiscard]] T bend(int i, int k) const {
    const std::array<T, 5>& f = samples_[i];
    const int m = k == 0 ? 1 : k == last ? last - 1 : k;
    return T(16) * (f[m - 1] - T(2) * f[m] + f[m + 1]);
  }

private:
  /// Whether sample k is no less than its neighbours, and a maximum may lie beside it.
  [[nodiscard]] auto crests(int i, int k) const {
    const std::array<T, 5>& f = samples_[i];
    auto crest = T(0) <= T(0);
    if (k > 0) crest = crest && f[k] >= f[k - 1];
    if (k < last) crest = crest && f[k] >= f[k + 1];
    return k == 0 || k == last ? crest && !at_an_end_for_sure(f, k) : crest;
  }

  /// @param part of the rise over the whole step
  [[nodiscard]] auto may_rise(int i, const T& a, const T& b, const T& part,
                              const PeakOf<T>& peak) const {
    return !(fused(part, bound_.rise(i), larger(a, b)) <= peak.value);
  }

  /// The samples rise or fall towards an end so steeply that a parabola through the last three has
  /// its vertex well outside the step.
  [[nodiscard]] static auto at_an_end_for_sure(const std::array<T, 5>& f, int end) {
    using std::abs;
    const T a = end == 0 ? f[0] : f[4], b = end == 0 ? f[1] : f[3], c = f[2];
    const T slope = T(3) * a - T(4) * b + c; // towards the end, times 2 spacings
    const T curvature = a - T(2) * b + c;
    return slope > T(2) * abs(curvature);
  }

  ReactionBound<T> bound_;
  std::vector<std::array<T, 5>> samples_; ///< 0 … n
};

} // namespace wingspread
