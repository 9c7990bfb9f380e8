/// The spectral radius ρ of a wing's linear model, the rate at which its fastest mode rings or decays:
///
///     [ 0  E2 ; −M⁻¹K  −M⁻¹D ]
///
/// of springs, latches and friction at the present configuration.
#pragma once

#include "core/mechanics/linear_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wingspread {

/// Upper bound of |λ| for a wing with its engaged latches in any configuration and at any rates, 1/s. For an
/// eigenvector with velocities v scaled to vᴴMv = 1,
///
///     |λ|² ≤ |λ| vᴴDv + vᴴKv ≤ |λ| Σ δ_i σ_i + Σ κ_i σ_i                                       (1)
///
/// δ, κ a hinge's damping and stiffness, σ_i = (M⁻¹)_ii ≤ mobility_bound. Cost O(n), no evaluation.
/// @return infinity if loops, real hinges or smoothed latches have stiffnesses of their own
template <class T, class AnySystem>
[[nodiscard]] double spectral_radius_bound(const AnySystem& system) {
  const Wing<T>& wing = system.wing();
  if (!wing.real.empty() || !wing.loops.empty() || system.layout().smoothed)
    return std::numeric_limits<double>::infinity();
  double damping = 0, stiffness = 0;
  for (int i = 1; i <= wing.size(); ++i) {
    const LinearLaw<T>& law = system.work().laws[i];
    const HingeTerms<T>& hinge = wing.hinges[i];
    const double sigma = static_cast<double>(mobility_bound(system, i));
    T resisted = law.damping;
    if (hinge.regularized_friction > T(0))
      resisted = resisted + regularized_friction_damping(hinge, T(0)); // where it is largest
    if (!wing.motors.empty()) resisted = resisted + wing.motors[i].gain;
    damping += sigma * static_cast<double>(resisted);
    stiffness += sigma * std::max(0.0, static_cast<double>(law.stiffness));
  }
  return 0.5 * damping + std::sqrt(0.25 * damping * damping + stiffness);
}

/// Estimates ρ by power iteration; keeps the storage.
template <class T> class SpectralRadius {
public:
  /// Largest |λ| of the linear model at (x, t), 1/s, to about a fifth. Starts from fixed vectors, so that runs
  /// are reproducible; each of 16 passes is one solve of the recursion. Cost about six evaluations.
  template <class AnySystem>
  [[nodiscard]] double estimate(AnySystem& system, const State<T>& x, const T& t) {
    const int size = system.layout().freedoms();
    t_ = t;
    linear_.factorize(system, x, t, [](int) { return T(0); });
    loop_resistances(system, x, loops_);
    q_.assign(size, T(0)), next_.assign(size, T(0)), v_.resize(size);
    for (int k = 0; k < size; ++k) v_[k] = T(k % 2 == 0 ? 1 : -1) / T(k + 1);
    const double first = growth(system, x, 0);
    return first > 0 ? growth(system, x, first) : 0;
  }

private:
  /// Geometric mean of the growth over eight passes, in the norm max(|v|, weight·|q|). q is one pass behind v;
  /// with weight ≈ |λ| the norm of a complex pair of modes does not oscillate. Eight passes are heuristic: fewer
  /// miss a fast mode that the start hardly excites, and stability then holds steps back unnoticed.
  template <class AnySystem> double growth(AnySystem& system, const State<T>& x, double weight) {
    double before = norm(weight), mean = 1;
    for (int pair = 0; pair < 4; ++pair) {
      double both = 1;
      for (int pass = 0; pass < 2; ++pass) {
        apply(system, x);
        const double after = norm(weight);
        if (!(after > 1e-200) || !(before > 1e-200)) return 0;
        both *= std::sqrt(after / before);
        const T scale(1 / after);
        for (std::size_t k = 0; k < v_.size(); ++k) q_[k] = scale * q_[k], v_[k] = scale * v_[k];
        before = 1;
      }
      mean *= std::sqrt(std::sqrt(both));
    }
    return mean;
  }

  /// (q, v) → (v, −M⁻¹(Kq + Dv))
  template <class AnySystem> void apply(AnySystem& system, const State<T>& x) {
    const Layout& at = system.layout();
    linear_.solve(
        system,
        [&](int i) {
          const auto hinge = resistance(system, x, t_, i);
          const int k = at.angle(i);
          return -fused(hinge.stiffness, q_[k], hinge.damping * v_[k]) - of_loops(at, i);
        },
        next_.data());
    std::swap(q_, v_);
    std::swap(v_, next_);
  }

  /// The loops' share of Kq + Dv at hinge i.
  [[nodiscard]] T of_loops(const Layout& at, int i) const {
    T sum(0);
    for (const LoopResistance<T>& loop : loops_) {
      if (loop.first != i && loop.second != i) continue;
      const T pull = fused(loop.stiffness, loop.along([&](int k) { return q_[at.angle(k)]; }),
                           loop.damping * loop.along([&](int k) { return v_[at.angle(k)]; }));
      sum = fused(loop.first == i ? loop.on_first : loop.on_second, pull, sum);
    }
    return sum;
  }

  [[nodiscard]] double norm(double weight) const {
    double largest = 0;
    for (std::size_t k = 0; k < v_.size(); ++k)
      largest = std::max({largest, std::abs(static_cast<double>(v_[k])),
                          weight * std::abs(static_cast<double>(q_[k]))});
    return largest;
  }

  LinearSolve<T> linear_;
  std::vector<LoopResistance<T>> loops_;
  State<T> q_, v_, next_;
  T t_ = T(0);
};

} // namespace wingspread
