/// Proof that no peak can be exceeded any more, so that a run may stop.
///
/// After the last latch every hinge is a spring and a damper about its own rest, and the energy
///
///     E = T + Σ ½ κ_i (y_i − y*_i)²,    y* = drive/κ                                          (1)
///
/// never grows on a base that is fixed or free (for a free one T is taken about the common centre
/// of mass, whose energy is constant). Friction adds at most τ_s to a moment.
///
/// **Coarse**, at any angles. With T ≥ ½ Σ J ω² alone, by Cauchy and Schwarz,
///
///     φ̇_i² ≤ 2 T σ_i,    σ_i = 1/J_i + 1/J_p  (1/J_p = 0 on a fixed base)                      (2)
///     |M_i| ≤ √(2E) √(κ_i + δ_i² σ_i) + τ_s                                                    (3)
///
/// For the reaction, Gauss's principle: the true accelerations minimise Σ m r̈² + Σ J (ω̇ − L/J)²
/// over those that the hinges allow, L the net hinge moment on each body; comparing with φ̈ = 0,
/// whose r̈ = γ is centripetal,
///
///     Σ m r̈² ≤ Z := Σ m γ² + Σ L²/J,    |Y_i| ≤ √(m outward of i) √Z                           (4)
///
/// γ being bounded along each path with ω² ≤ 2E/J, and L by (3).
///
/// **Sharp**, near rest on a fixed base. By (1) hinge i stays within √(2E/κ_i) of its rest, so body
/// k within ρ_k, the sum along its path. Turning the bodies so far changes the velocities of all
/// masses by at most Σ ρ_k a_k |ω_k| in the norm √(Σ m v²), a_k² = Σ m (lever of a mass about the
/// hinge of k)², and |ω_k| ≤ √W_k ‖ω‖ in the norm of the mass matrix M_0 at rest, W = its inverse
/// in absolute rates. Hence with
///
///     η = Σ ρ_k a_k √W_k:    (1 − η)² M_0 ≤ M ≤ (1 + η)² M_0                                   (5)
///     |M_i| ≤ √(2E) √(κ_i + δ_i² (M_0⁻¹)_ii / (1 − η)²) + τ_s                                  (6)
///
/// Let F_ik be the reaction at hinge i to a unit moment of hinge k at rest. The moments are
/// √κ u + δ φ̇ with |u|² + ‖φ̇‖² ≤ 2E, so at rest the reactions would be within √(2E) G_i,
///
///     G_i² = largest eigenvalue of Σ κ_k F_ik F_ikᵀ + Σ F_ik δ_k (M_0⁻¹)_kl δ_l F_ilᵀ  (2×2)   (7)
///
/// and the accelerations within A = √(2E) √tr(M_0⁻¹ (κ + δ M_0⁻¹ δ)) in the norm of M_0. Off rest,
/// with μ = 2η + η² and Γ² = Σ m γ², ω_k² ≤ 2E W_k / (1 − η)²,
///
///     |Y_i| ≤ √(2E) G_i/(1 − η) + √(m outward of i) (A/(1 − η) (η + μ)/(1 − μ) + 2 Γ)          (8)
///
/// to which friction adds Σ |F_ik| τ_s and, in A, Σ √(M_0⁻¹)_kk τ_s.
#pragma once

#include "core/mechanics/system.hpp"

#include <algorithm>
#include <vector>

namespace wingspread {

/// Bounds on what every hinge will see from now on.
template <class T> class PeakBounds {
public:
  std::vector<T> moment; ///< 1 … n, N·m
  std::vector<T> force;  ///< 1 … n, N

  /// Every hinge has latched: finds all that does not depend on the energy. Cost O(n³), and none of
  /// it for more than `most_bodies`, where the coarse bounds must do.
  template <class AnySystem> void prepare(AnySystem& system) {
    const int n = system.layout().bodies;
    moment.assign(n + 1, T(0)), force.assign(n + 1, T(0));
    weigh(system);
    sharp_ = fixed<AnySystem> && n <= most_bodies;
    if (sharp_) linearize(system);
  }

  /// For an energy above rest. Cost O(n). @pre prepared
  template <class AnySystem> void bound(const AnySystem& system, const T& energy) {
    using std::sqrt;
    const T size = sqrt(T(2) * energy), eta = size * eta_;
    if (!sharp_ || !(eta < T(0.2))) return bound_coarsely(system, energy);
    const T k = T(1) / (T(1) - eta), mu = eta * (T(2) + eta);
    const T A = k * fused(size, acceleration_, k * friction_acceleration_);
    const T rest = A * (eta + mu) / (T(1) - mu) + T(2) * size * size * k * k * centripetal_;
    for (std::size_t i = 1; i < moment.size(); ++i) {
      const HingeTerms<T>& hinge = system.wing().hinges[i];
      moment[i] = rounded_up(size * sqrt(fused(k * k, damping_[i], stiffness_[i])) + hinge.coulomb +
                             hinge.limit);
      force[i] = rounded_up(fused(size * k, reaction_[i], friction_reaction_[i]) +
                            sqrt(outward_mass_[i]) * rest);
    }
  }

private:
  static constexpr int most_bodies = 24;
  template <class AnySystem> static constexpr bool fixed = AnySystem::motion == BaseMotion::fixed;

  [[nodiscard]] static T rounded_up(const T& x) { return x * T(1 + 1e-9); }

  template <class AnySystem> void weigh(const AnySystem& system) {
    const Wing<T>& wing = system.wing();
    const int n = system.layout().bodies;
    outward_mass_.assign(n + 1, T(0));
    for (int i = n; i >= 1; --i) {
      outward_mass_[i] = outward_mass_[i] + wing.bodies[i].mass;
      T& parents = outward_mass_[wing.tree.parent_of(i)];
      parents = parents + outward_mass_[i];
    }
  }

  /// M_0⁻¹ and F of (7), and what is made of them.
  template <class AnySystem> void linearize(AnySystem& system) {
    using std::abs, std::sqrt;
    const Wing<T>& wing = system.wing();
    const Layout& at = system.layout();
    const int n = at.bodies;
    const auto cell = [n](int i, int k) { return i * (n + 1) + k; };
    State<T> rest(at.size(), T(0)), unit(n);
    stiffness_.assign(n + 1, T(0)), damping_.assign(n + 1, T(0));
    for (int i = 1; i <= n; ++i) {
      const LinearLaw<T> law = linear_law(wing.hinges[i], true);
      stiffness_[i] = law.stiffness, damping_[i] = law.damping;
      rest[at.angle(i)] = law.latched + law.drive / law.stiffness;
    }
    system.place_all(rest, T(0));
    system.factorize_at(rest, T(0), [](int) { return T(0); });
    inverse_.assign((n + 1) * (n + 1), T(0)), reactions_.assign((n + 1) * (n + 1), {T(0), T(0)});
    for (int k = 1; k <= n; ++k) {
      system.solve([k](int i) { return T(i == k ? 1 : 0); }, unit.data());
      for (int i = 1; i <= n; ++i) inverse_[cell(i, k)] = unit[i - 1];
      find_reactions(system, unit, [&](int i) -> Vec2<T>& { return reactions_[cell(i, k)]; });
    }
    T trace(0);
    friction_acceleration_ = T(0);
    reaction_.assign(n + 1, T(0)), friction_reaction_.assign(n + 1, T(0));
    const auto friction = [&](int i) { return wing.hinges[i].coulomb + wing.hinges[i].limit; };
    for (int i = 1; i <= n; ++i) {
      const T inverse = inverse_[cell(i, i)];
      trace = fused(inverse, stiffness_[i], trace);
      friction_acceleration_ = fused(friction(i), T(sqrt(inverse)), friction_acceleration_);
      Sym2<T> G{T(0), T(0), T(0)};
      for (int k = 1; k <= n; ++k) {
        const Vec2<T>& f = reactions_[cell(i, k)];
        Vec2<T> damped{T(0), T(0)};
        for (int l = 1; l <= n; ++l)
          damped = fused(T(inverse_[cell(k, l)] * damping_[l]), reactions_[cell(i, l)], damped);
        const Vec2<T> g = fused(damping_[k], damped, scaled(stiffness_[k], f));
        G = G + Sym2<T>{f.x * g.x, T(0.5) * (f.x * g.y + f.y * g.x), f.y * g.y};
        const T damping = inverse_[cell(i, k)] * damping_[k];
        trace = fused(damping, inverse_[cell(k, i)] * damping_[i], trace);
        friction_reaction_[i] = fused(friction(k), T(sqrt(dot(f, f))), friction_reaction_[i]);
      }
      const T half = T(0.5) * (G.xx - G.yy);
      reaction_[i] = sqrt(T(0.5) * (G.xx + G.yy) + sqrt(fused(half, half, G.xy * G.xy)));
    }
    acceleration_ = sqrt(trace);
    turn_bodies(system);
    for (int i = 1; i <= n; ++i)
      damping_[i] = damping_[i] * damping_[i] * inverse_[cell(i, i)]; // as (6) needs it
  }

  /// Forces on the hinges where the wing, at rest in the workspace's frames, begins to accelerate.
  template <class AnySystem, class Force>
  void find_reactions(const AnySystem& system, const State<T>& accelerations, Force&& on) {
    const Wing<T>& wing = system.wing();
    const std::vector<BodyFrame<T>>& frames = system.work().frames;
    const int n = system.layout().bodies;
    alpha_.assign(n + 1, T(0)), hinge_.assign(n + 1, {T(0), T(0)});
    for (int i = 1; i <= n; ++i) {
      const int p = wing.tree.parent_of(i);
      alpha_[i] = alpha_[p] + accelerations[i - 1];
      hinge_[i] = fused(alpha_[p], turned(frames[i].arm), hinge_[p]);
      on(i) =
          fused(alpha_[i], turned(frames[i].mass_moment), scaled(wing.bodies[i].mass, hinge_[i]));
    }
    for (int i = n; i >= 1; --i)
      if (const int p = wing.tree.parent_of(i); p != 0) on(p) = on(p) + on(i);
  }

  /// η and Γ, of √(2E) = 1.
  template <class AnySystem> void turn_bodies(const AnySystem& system) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    const int n = system.layout().bodies;
    std::vector<T> lever(n + 1, T(0)), angle(n + 1, T(0)), spin(n + 1, T(0)), gamma(n + 1, T(0));
    std::vector<T> row((n + 1) * (n + 1), T(0)); // of M_0⁻¹, summed along the path of each body
    T squares(0);
    eta_ = T(0);
    for (int i = n; i >= 1; --i) {
      const BodyTerms<T>& body = wing.bodies[i];
      lever[i] = fused(body.mass, dot(body.center, body.center), lever[i]);
      T& parents = lever[wing.tree.parent_of(i)];
      parents = fused(outward_mass_[i], dot(body.arm, body.arm), parents);
    }
    for (int i = 1; i <= n; ++i) {
      const BodyTerms<T>& body = wing.bodies[i];
      const int p = wing.tree.parent_of(i);
      angle[i] = angle[p] + T(1) / sqrt(stiffness_[i]);
      for (int k = 1; k <= n; ++k)
        row[i * (n + 1) + k] = row[p * (n + 1) + k] + inverse_[i * (n + 1) + k];
      for (int k = i; k != 0; k = wing.tree.parent_of(k)) spin[i] = spin[i] + row[i * (n + 1) + k];
      eta_ = fused(angle[i], T(sqrt(lever[i] * spin[i])), eta_);
      gamma[i] = fused(spin[p], T(sqrt(dot(body.arm, body.arm))), gamma[p]);
      const T here = fused(spin[i], T(sqrt(dot(body.center, body.center))), gamma[i]);
      squares = fused(body.mass, here * here, squares);
    }
    centripetal_ = sqrt(squares);
  }

  /// (2)-(4)
  template <class AnySystem> void bound_coarsely(const AnySystem& system, const T& energy) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    const int n = system.layout().bodies;
    net_.assign(n + 1, T(0)), hinge_gamma_.assign(n + 1, T(0));
    T Z(0);
    const auto spin = [&](int i) { // bound on ω_i²
      return i == 0 && fixed<AnySystem> ? T(0) : T(2) * energy / wing.bodies[i].central_inertia;
    };
    for (int i = 1; i <= n; ++i) {
      const int p = wing.tree.parent_of(i);
      const LinearLaw<T> law = linear_law(wing.hinges[i], true);
      T sigma = T(1) / wing.bodies[i].central_inertia;
      if (p != 0 || !fixed<AnySystem>) sigma = sigma + T(1) / wing.bodies[p].central_inertia;
      moment[i] = sqrt(T(2) * energy * fused(law.damping * law.damping, sigma, law.stiffness)) +
                  wing.hinges[i].coulomb + wing.hinges[i].limit;
      // what y* adds: the moment at rest is zero by (1), so nothing
      net_[i] = net_[i] + moment[i];
      net_[p] = net_[p] + moment[i];
      hinge_gamma_[i] =
          hinge_gamma_[p] + spin(p) * sqrt(dot(wing.bodies[i].arm, wing.bodies[i].arm));
      const Vec2<T>& g = wing.bodies[i].center;
      const T gamma = hinge_gamma_[i] + spin(i) * sqrt(dot(g, g));
      Z = fused(wing.bodies[i].mass, gamma * gamma, Z);
    }
    for (int i = fixed<AnySystem> ? 1 : 0; i <= n; ++i)
      Z = Z + net_[i] * net_[i] / wing.bodies[i].central_inertia;
    for (int i = 1; i <= n; ++i) force[i] = sqrt(outward_mass_[i] * Z);
  }

  bool sharp_ = false;
  std::vector<T> outward_mass_;
  // all of √(2E) = 1
  T eta_ = T(0), acceleration_ = T(0), centripetal_ = T(0), friction_acceleration_ = T(0);
  std::vector<T> stiffness_, damping_;          ///< κ, δ² (M_0⁻¹)_ii
  std::vector<T> reaction_, friction_reaction_; ///< G_i, and what friction adds
  std::vector<T> inverse_;                      ///< M_0⁻¹, (n+1)²
  std::vector<Vec2<T>> reactions_;              ///< F, (n+1)²
  std::vector<T> alpha_, net_, hinge_gamma_;    // scratch
  std::vector<Vec2<T>> hinge_;
};

} // namespace wingspread
