/// Bounds on what every hinge can still see, from the energy alone.
///
/// At any angles, with (1) of peak_bounds.hpp. From T ≥ ½ Σ J ω² alone, by Cauchy and Schwarz,
///
///     φ̇_i² ≤ 2 T σ_i,    σ_i = 1/J_i + 1/J_p  (1/J_p = 0 on a fixed base)                      (2)
///     |M_i| ≤ g_i + √(2E) √(κ_i + δ_i² σ_i) + τ_s                                              (3)
///
/// For the reaction, Gauss's principle: the true accelerations minimise Σ m r̈² + Σ J (ω̇ − L/J)²
/// over those that the hinges allow, L the net hinge moment on each body; comparing with φ̈ = 0,
/// whose r̈ = γ is centripetal,
///
///     Σ m r̈² ≤ Z := Σ m γ² + Σ L²/J,    |Y_i| ≤ √(m outward of i) √Z                           (4)
///
/// γ being bounded along each path with ω² ≤ 2E/J, and L by (3). On a base that is driven all this
/// is as seen from it; γ then stands for γ − f, f the apparent force of apparent_load.hpp.
#pragma once

#include "core/proofs/prospects.hpp"

namespace wingspread {

template <class T> class CoarseBounds {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>; ///< 0 … n, as the bodies are numbered

  /// (3) and (4) of every hinge, for an energy above rest. Cost O(n).
  /// @param outward_mass of body i and all that hangs on it, kg
  template <class AnySystem>
  void bound(const AnySystem& system, const Prospects<T>& prospects, const T& energy,
             const Numbers& outward_mass, Numbers& moment, Numbers& force) {
    using std::sqrt;
    bound_moments(system, prospects, energy, moment);
    T Z = centripetal(system, prospects.load(), energy);
    for (int i = first_body<AnySystem>; i < net_.size(); ++i)
      Z = Z + net_(i) * net_(i) / system.wing().bodies[i].central_inertia;
    for (int i = 1; i < net_.size(); ++i) force(i) = sqrt(outward_mass(i) * Z);
  }

private:
  /// The first that moves.
  template <class AnySystem>
  static constexpr int first_body = AnySystem::base_motion == BaseMotion::free ? 0 : 1;

  /// (3), and L: the most that the hinges of each body come to.
  template <class AnySystem>
  void bound_moments(const AnySystem& system, const Prospects<T>& prospects, const T& energy,
                     Numbers& moment) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    net_.setZero(moment.size()), rate_.setZero(moment.size());
    for (int i = 1; i < moment.size(); ++i) {
      const int p = system.topology().parent_of(i);
      const T& damping = prospects.damping(i);
      T sigma = T(1) / wing.bodies[i].central_inertia;
      if (p >= first_body<AnySystem>) sigma = sigma + T(1) / wing.bodies[p].central_inertia;
      rate_(i) = sqrt(T(2) * energy * sigma);
      moment(i) = sqrt(T(2) * energy * fused(damping * damping, sigma, prospects.stiffness(i))) +
                  wing.hinges[i].most_friction() + prospects.steady(i);
      // what y* adds: the moment at rest is zero by (1), so nothing
    }
    if (wing.is_real()) add_real(wing, energy, moment);
    for (int i = 1; i < moment.size(); ++i) {
      const int p = system.topology().parent_of(i);
      net_(i) = net_(i) + moment(i);
      net_(p) = net_(p) + moment(i);
    }
  }

  /// What dampers and loops may add at the largest rates; the energy of a loop bounds what it
  /// carries, with a slack strand too: (K e)² ≤ 2 K E.
  void add_real(const Wing<T>& wing, const T& energy, Numbers& moment) const {
    using std::sqrt;
    for (int i = 1; i < static_cast<int>(wing.real.size()); ++i)
      if (wing.real[i].has_damper)
        moment(i) = moment(i) + most_of_damper(wing.real[i].damper, T(rate_(i)));
    for (const LoopTerms<T>& loop : wing.loops) {
      const T gear = largest_gear(loop);
      const T torque = sqrt(T(2) * loop.stiffness * energy) +
                       loop.damping * fused(gear, T(rate_(loop.first)), T(rate_(loop.second)));
      moment(loop.first) = moment(loop.first) + gear * torque;
      moment(loop.second) = moment(loop.second) + torque;
    }
  }

  /// Σ m γ² of (4).
  template <class AnySystem>
  [[nodiscard]] T centripetal(const AnySystem& system, const ApparentLoad<T>& load,
                              const T& energy) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    const auto length = [](const Vec2<T>& v) { return T(sqrt(dot(v, v))); };
    const auto spin = [&](int i) { // bound on ω_i²
      return i < first_body<AnySystem> ? T(0) : T(2) * energy / wing.bodies[i].central_inertia;
    };
    T sum(0);
    gamma_.setZero(net_.size()), speed_.setZero(net_.size());
    for (int i = 1; i < gamma_.size(); ++i) {
      const int p = system.topology().parent_of(i);
      gamma_(i) = gamma_(p) + spin(p) * length(wing.bodies[i].arm);
      T gamma = gamma_(i) + spin(i) * length(wing.bodies[i].center);
      if constexpr (AnySystem::base_motion == BaseMotion::prescribed) {
        speed_(i) = speed_(p) + sqrt(spin(p)) * length(wing.bodies[i].arm);
        const T speed = speed_(i) + sqrt(spin(i)) * length(wing.bodies[i].center);
        gamma = gamma + load.specific(i) + T(2) * load.spin() * speed;
      }
      sum = fused(wing.bodies[i].mass, gamma * gamma, sum);
    }
    return sum;
  }

  Numbers net_;   ///< L, N·m
  Numbers rate_;  ///< no rate of the hinge is larger, rad/s
  Numbers gamma_; ///< γ of the hinge's point, m/s²
  Numbers speed_; ///< of the hinge's point, as seen from a base that is driven, m/s
};

} // namespace wingspread
