/// Bounds on what every hinge can still see near rest, from the energy and the linear model there.
///
/// On a base that is fixed or driven, with E of prospects.hpp: hinge i stays within
/// √(2E/κ_i) + g_i/κ_i of its rest, so body k within ρ_k, the sum along its path. Turning the
/// bodies so far changes the velocities of all masses by at most Σ ρ_k a_k |ω_k| in the norm
/// √(Σ m v²), a_k² = Σ m (lever of a mass about the hinge of k)², and |ω_k| ≤ √W_k ‖ω‖ in the norm
/// of the mass matrix M_0 at rest, W = its inverse in absolute rates. Hence with
///
///     η = Σ ρ_k a_k √W_k:    (1 − η)² M_0 ≤ M ≤ (1 + η)² M_0                                   (5)
///     |M_i| ≤ √(2E) √(κ_i + δ_i² (M_0⁻¹)_ii / (1 − η)²) + τ_s + g_i                            (6)
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
/// to which friction and what keeps the balance of apparent forces, τ = τ_s + g, add Σ |F_ik| τ
/// and, in A, Σ √(M_0⁻¹)_kk τ. Γ is with √(Σ m f²) of these forces, 2 |Ω| √(2E) of it Coriolis's:
/// like centripetal accelerations they stand against what the hinges allow.
///
/// All sums are written out: in a library's their order, and so the last bits, would depend on the
/// instruction set, and with them the step at which a run ends.
#pragma once

#include "core/mechanics/linear_solve.hpp"
#include "core/proofs/prospects.hpp"

#include <vector>

namespace wingspread {

/// Kept for √(2E) = 1; numbered 0 … n, as the bodies are.
template <class T> class SharpBounds {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  /// Finds all that does not depend on the energy. Cost O(n³); allocates where the wing before had
  /// another number of bodies. @pre every hinge has a rest
  template <class AnySystem>
  void prepare(const AnySystem& system, const Prospects<T>& prospects,
               const Numbers& outward_mass) {
    resize(system.layout().bodies);
    take(system.wing(), prospects);
    invert(system, prospects.rest());
    bound_reactions(system.wing());
    bound_accelerations(system.wing());
    bound_turns(system.wing(), system.topology(), outward_mass);
  }

  /// Whether the energy is so small that they hold. @pre prepared
  [[nodiscard]] bool hold(const T& energy) const {
    using std::sqrt;
    return sqrt(T(2) * energy) * eta_ + steady_eta_ < T(0.2);
  }

  /// (6) and (8) of every hinge. Cost O(n). @pre they hold
  void bound(const T& energy, const Numbers& outward_mass, Numbers& moment, Numbers& force) const {
    using std::sqrt;
    const T size = sqrt(T(2) * energy), eta = size * eta_ + steady_eta_;
    const T k = T(1) / (T(1) - eta), mu = eta * (T(2) + eta);
    const T A = k * fused(size, acceleration_, k * steady_acceleration_);
    const T rest = A * (eta + mu) / (T(1) - mu) + T(2) * size * size * k * k * centripetal_ +
                   T(2) * fused(T(2) * spin_of_base_, size, push_);
    for (int i = 1; i < moment.size(); ++i) {
      const T sharp = sqrt(fused(k * k, damping_(i) * damping_(i) * inverse_(i, i), stiffness_(i)));
      moment(i) = rounded_up(size * sharp + steady_(i));
      force(i) = rounded_up(fused(size * k, reaction_(i), steady_reaction_(i)) +
                            sqrt(outward_mass(i)) * rest);
    }
  }

private:
  using Square = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

  [[nodiscard]] static T rounded_up(const T& x) { return x * T(1 + 1e-9); }
  [[nodiscard]] static T length(const Vec2<T>& v) {
    using std::sqrt;
    return sqrt(dot(v, v));
  }

  void resize(int n) {
    for (Numbers* v : {&stiffness_, &damping_, &steady_, &reaction_, &steady_reaction_, &alpha_,
                       &lever_, &angle_, &steady_angle_, &spin_, &gamma_})
      v->setZero(n + 1);
    for (Square* m : {&inverse_, &inverse_absolute_, &F_x_, &F_y_}) m->setZero(n + 1, n + 1);
    point_.assign(n + 1, {T(0), T(0)});
    column_.resize(n);
  }

  /// κ, δ, τ and what apparent forces do to the whole.
  void take(const Wing<T>& wing, const Prospects<T>& prospects) {
    for (int i = 1; i <= wing.size(); ++i) {
      stiffness_(i) = prospects.stiffness(i), damping_(i) = prospects.damping(i);
      steady_(i) = wing.hinges[i].most_friction() + prospects.steady(i);
      steady_angle_(i) = prospects.steady(i) / prospects.stiffness(i);
    }
    push_ = prospects.load().push(), spin_of_base_ = prospects.load().spin();
  }

  /// M_0⁻¹ and F, a unit moment of hinge k at a time.
  template <class AnySystem> void invert(const AnySystem& system, const State<T>& rest) {
    const int n = system.layout().bodies;
    linear_.factorize_unlocked(system, rest, T(0)); // what sticks may slip later
    for (int k = 1; k <= n; ++k) {
      linear_.solve(
          system, [k](int i) { return T(i == k ? 1 : 0); }, column_.data());
      for (int i = 1; i <= n; ++i) inverse_(i, k) = column_[i - 1];
      find_reactions(system.wing(), system.topology(), k);
    }
  }

  /// F_ik, where the wing begins to accelerate as M_0⁻¹'s column k says: mass times acceleration of
  /// all that is outward of hinge i.
  template <class Topology> void find_reactions(const Wing<T>& wing, const Topology& tree, int k) {
    const std::vector<BodyFrame<T>>& frames = linear_.frames();
    for (int i = 1; i <= tree.bodies(); ++i) {
      const int p = tree.parent_of(i);
      alpha_(i) = alpha_(p) + inverse_(i, k);
      point_[i] = fused(alpha_(p), turned(frames[i].arm), point_[p]);
      set_F(
          i, k,
          fused(alpha_(i), turned(frames[i].mass_moment), scaled(wing.bodies[i].mass, point_[i])));
    }
    for (int i = tree.bodies(); i >= 1; --i)
      if (const int p = tree.parent_of(i); p != 0) set_F(p, k, F(p, k) + F(i, k));
  }

  /// (7), and what friction adds to it.
  void bound_reactions(const Wing<T>& wing) {
    using std::sqrt;
    const int n = wing.size();
    for (int i = 1; i <= n; ++i) {
      Sym2<T> G{T(0), T(0), T(0)};
      for (int k = 1; k <= n; ++k) {
        const Vec2<T> f = F(i, k);
        Vec2<T> damped{T(0), T(0)};
        for (int l = 1; l <= n; ++l)
          damped = fused(T(inverse_(k, l) * damping_(l)), F(i, l), damped);
        const Vec2<T> g = fused(damping_(k), damped, scaled(stiffness_(k), f));
        G = G + Sym2<T>{f.x * g.x, T(0.5) * (f.x * g.y + f.y * g.x), f.y * g.y};
        steady_reaction_(i) = fused(steady_(k), length(f), steady_reaction_(i));
      }
      const T half = T(0.5) * (G.xx - G.yy);
      reaction_(i) = sqrt(T(0.5) * (G.xx + G.yy) + sqrt(fused(half, half, G.xy * G.xy)));
    }
  }

  /// A, and what friction adds to it.
  void bound_accelerations(const Wing<T>& wing) {
    using std::sqrt;
    T trace(0);
    steady_acceleration_ = T(0);
    for (int i = 1; i <= wing.size(); ++i) {
      const T own = inverse_(i, i);
      steady_acceleration_ = fused(steady_(i), T(sqrt(own)), steady_acceleration_);
      trace = fused(own, stiffness_(i), trace);
      for (int k = 1; k <= wing.size(); ++k)
        trace = fused(inverse_(i, k) * damping_(k), inverse_(k, i) * damping_(i), trace);
    }
    acceleration_ = sqrt(trace);
  }

  /// η of (5), and Γ.
  template <class Topology>
  void bound_turns(const Wing<T>& wing, const Topology& tree, const Numbers& outward_mass) {
    using std::sqrt;
    find_levers(wing, tree, outward_mass);
    T squares(0);
    eta_ = steady_eta_ = T(0);
    for (int i = 1; i <= wing.size(); ++i) {
      const BodyTerms<T>& body = wing.bodies[i];
      const int p = tree.parent_of(i);
      angle_(i) = angle_(p) + T(1) / sqrt(stiffness_(i));
      steady_angle_(i) = steady_angle_(p) + steady_angle_(i);
      inverse_absolute_.row(i) = inverse_absolute_.row(p) + inverse_.row(i);
      for (int k = i; k != 0; k = tree.parent_of(k)) spin_(i) = spin_(i) + inverse_absolute_(i, k);
      const T turns = sqrt(lever_(i) * spin_(i));
      eta_ = fused(angle_(i), turns, eta_);
      steady_eta_ = fused(steady_angle_(i), turns, steady_eta_);
      gamma_(i) = fused(spin_(p), length(body.arm), gamma_(p));
      const T here = fused(spin_(i), length(body.center), gamma_(i));
      squares = fused(body.mass, here * here, squares);
    }
    centripetal_ = sqrt(squares);
  }

  /// a_k² of all that is outward of hinge k.
  template <class Topology>
  void find_levers(const Wing<T>& wing, const Topology& tree, const Numbers& outward_mass) {
    for (int i = wing.size(); i >= 1; --i) {
      const BodyTerms<T>& body = wing.bodies[i];
      lever_(i) = fused(body.mass, dot(body.center, body.center), lever_(i));
      T& parents = lever_(tree.parent_of(i));
      parents = fused(outward_mass(i), dot(body.arm, body.arm), parents);
    }
  }

  [[nodiscard]] Vec2<T> F(int i, int k) const { return {F_x_(i, k), F_y_(i, k)}; }
  void set_F(int i, int k, const Vec2<T>& force) { F_x_(i, k) = force.x, F_y_(i, k) = force.y; }

  Numbers stiffness_, damping_, steady_;     ///< κ, δ, τ
  Square inverse_;                           ///< M_0⁻¹
  Square F_x_, F_y_;                         ///< F
  Numbers reaction_, steady_reaction_;       ///< G, and what τ adds
  T acceleration_{}, steady_acceleration_{}; ///< A, and what τ adds
  T eta_{}, steady_eta_{}, centripetal_{};   ///< η, what g adds to it, Γ
  T push_{}, spin_of_base_{};                ///< √(Σ m f²) at rest, and |Ω|
  // scratch
  LinearSolve<T> linear_;
  State<T> column_;
  Numbers alpha_;                ///< of each body
  std::vector<Vec2<T>> point_;   ///< acceleration of each hinge's point
  Numbers lever_;                ///< a_k²
  Numbers angle_, steady_angle_; ///< ρ for √(2E) = 1, and by g
  Square inverse_absolute_;      ///< M_0⁻¹ with rows for absolute rates
  Numbers spin_;                 ///< W
  Numbers gamma_;                ///< γ of each hinge's point
};

} // namespace wingspread
