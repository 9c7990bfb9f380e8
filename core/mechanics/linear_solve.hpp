/// Linear solves with a wing's mass matrix M, by the recursion itself: O(n), no matrix.
///
///     (M + E + Σ c_l v_l v_lᵀ) q̈ = τ,    E diagonal over the hinges                            (1)
///
/// | symbol | meaning                                               | shape | unit       |
/// |--------|-------------------------------------------------------|-------|------------|
/// | q̈, τ   | accelerations, moments                                | n     | rad/s², N·m |
/// | E      | inertia added to the hinges                           | n     | kg·m²      |
/// | v_l    | moments of loop l at its two hinges for a torque of 1 | n     | 1          |
/// | c_l    | weight of loop l                                      |       | kg·m²      |
///
/// A stuck hinge does not move. With A = M + E, V of the columns v_l and C = diag(c_l) [Sherman, Morrison & Woodbury]
///
///     q̈ = q̈_0 − Z (E2 + C VᵀZ)⁻¹ C Vᵀ q̈_0,    q̈_0 = A⁻¹τ,   Z = A⁻¹V                           (2)
///
/// Each loop costs one more solve per factorization. The caller owns the storage.
#pragma once

#include "core/mechanics/augmented.hpp"
#include "core/mechanics/system.hpp"

#include <Eigen/LU>

#include <vector>

namespace wingspread {

/// Damping and stiffness of a hinge in the linear model, which can make the equations stiff.
template <class T> struct Resistance {
  T damping;   ///< N·m·s/rad, ≥ 0
  T stiffness; ///< N·m/rad, ≥ 0
};

/// Damping and stiffness of hinge i at (x, t).
template <class T, class Topology, BaseMotion M>
[[nodiscard]] Resistance<T> resistance(const System<T, Topology, M>& system, const State<T>& x,
                                       const T& t, int i) {
  const Layout& at = system.layout();
  const LinearLaw<T>& law = system.work().laws[i];
  const HingeTerms<T>& hinge = system.wing().hinges[i];
  Resistance<T> r{law.damping, larger(law.stiffness, T(0))};
  if (hinge.regularized_friction > T(0))
    r.damping = r.damping + regularized_friction_damping(hinge, x[at.rate(i)]);
  if (at.smoothed && hinge.has_latch) {
    const T weight = smooth_step(x[at.latch(i)] / system.epsilon());
    r.damping = fused(weight, smoothed_latch_damping(hinge, x[at.angle(i)]), r.damping);
    r.stiffness = fused(weight, hinge.stiffness, r.stiffness);
  }
  if (!system.wing().motors.empty()) {
    const MotorPiece<T>& motor = system.work().motors[i];
    const T excess = command_excess(motor, t, T(x[at.rate(i)]));
    r.damping = r.damping + motor_damping(system.wing().motors[i], motor, excess);
  }
  if (!system.wing().real.empty()) {
    const HingeResistance<T> real = real_resistance(system.wing().real[i], system.work().modes[i],
                                                    x[at.angle(i)], x[at.rate(i)]);
    r.damping = larger(T(r.damping + real.damping), T(0));
    r.stiffness = larger(T(r.stiffness + real.stiffness), T(0));
  }
  return r;
}

/// A loop in the linear model: stiffness, damping, and v of (1).
template <class T> struct LoopResistance {
  int first, second; ///< bodies
  T on_first, on_second;
  T damping, stiffness;

  /// vᵀ times numbers of the hinges. @param of of(i) of hinge i
  template <class Of> [[nodiscard]] T along(Of&& of) const {
    return fused(on_first, T(of(first)), on_second * T(of(second)));
  }
};

template <class T, class Topology, BaseMotion M>
void loop_resistances(const System<T, Topology, M>& system, const State<T>& x,
                      std::vector<LoopResistance<T>>& loops) {
  loops.clear();
  for (const LoopTerms<T>& loop : system.wing().loops) {
    const LoopState<T> state = system.state_of(loop, x);
    const T share = taut_share(loop, state.elastic);
    loops.push_back({loop.first, loop.second, on_first(loop, state.gear), on_second(loop),
                     share * loop.damping, share * loop.stiffness});
  }
}

/// Upper bound of (M⁻¹)_ii, 1/(kg·m²): 1/J_i + 1/J_p. J_i and J_p are the inertias of the hinge's two bodies about
/// their own centres of mass; 1/J_p = 0 for a base that does not move freely. It is a bound because joints only make
/// bodies less free to turn [Gauss's principle].
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T mobility_bound(const System<T, Topology, M>& system, int i) {
  const auto alone = [&](int body) {
    const bool held = body == 0 && M != BaseMotion::free;
    return held ? T(0) : T(T(1) / system.wing().bodies[body].central_inertia);
  };
  return alone(i) + alone(system.topology().parent_of(i));
}

template <class T> class LinearSolve {
public:
  /// Factorizes M + E at (x, t) for the added inertias of the hinges, E(i). Cost O(n), about half
  /// an evaluation.
  template <class Topology, BaseMotion M, class AddedInertia>
  void factorize(const System<T, Topology, M>& system, const State<T>& x, const T& t,
                 AddedInertia&& added) {
    factorize_with(system, x, t, [&](int i) {
      return HingeConstraint<T>{added(i), system.is_locked(i)};
    });
    loops_.clear();
  }

  /// Adds the loops to the last factorization, with c = weight(loop). Cost a solve each.
  template <class Topology, BaseMotion M, class Weight>
  void add_loops(const System<T, Topology, M>& system, const std::vector<LoopResistance<T>>& loops,
                 Weight&& weight) {
    const int count = static_cast<int>(loops.size()), size = system.layout().freedoms();
    columns_.resize(count);
    weights_.resize(count);
    for (int l = 0; l < count; ++l) {
      const LoopResistance<T>& loop = loops[l];
      weights_[l] = weight(loop);
      columns_[l].resize(size);
      solve_without_loops(
          system,
          [&](int i) {
            return i == loop.first ? loop.on_first : i == loop.second ? loop.on_second : T(0);
          },
          columns_[l].data());
    }
    loops_ = loops;
    if (count == 0) return;
    Square small = Square::Identity(count, count);
    for (int l = 0; l < count; ++l)
      for (int m = 0; m < count; ++m)
        small(l, m) += weights_[l] * along<M>(loops[l], columns_[m].data());
    small_.compute(small);
    right_.resize(count);
  }

  /// Solves (1) by (2) with the last factorization. @param tau tau(i) of hinge i; a free base has none
  /// @param qdd freedoms() numbers: those of a free base first
  template <class Topology, BaseMotion M, class Moment>
  void solve(const System<T, Topology, M>& system, Moment&& tau, T* qdd) {
    solve_without_loops(system, tau, qdd);
    if (loops_.empty()) return;
    for (std::size_t l = 0; l < loops_.size(); ++l)
      right_(static_cast<int>(l)) = weights_[l] * along<M>(loops_[l], qdd);
    right_ = small_.solve(right_).eval();
    for (std::size_t l = 0; l < loops_.size(); ++l)
      for (std::size_t k = 0; k < columns_[l].size(); ++k)
        qdd[k] = fused(T(-right_(static_cast<int>(l))), columns_[l][k], qdd[k]);
  }

  /// Frames of the bodies at the last factorization, 0 … n.
  [[nodiscard]] const std::vector<BodyFrame<T>>& frames() const { return parts_.frames; }

private:
  using Square = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  using Column = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  /// vᵀq̈.
  template <BaseMotion M>
  [[nodiscard]] static T along(const LoopResistance<T>& loop, const T* qdd) {
    return loop.along([&](int i) { return qdd[base_freedoms<M> + i - 1]; });
  }

  template <class Topology, BaseMotion M, class Moment>
  void solve_without_loops(const System<T, Topology, M>& system, Moment&& tau, T* qdd) {
    load_all<M>(system.topology(), parts_, tau);
    if constexpr (M == BaseMotion::free) {
      const AugmentedFrame<T>& base = parts_.bodies[0];
      qdd[0] = base.acceleration.x, qdd[1] = base.acceleration.y;
      qdd[2] = base.angular_acceleration;
    }
    system.topology().outward([&](int i) {
      qdd[base_freedoms<M> + i - 1] =
          accelerate_augmented(system.topology(), parts_.frames, parts_.bodies, i);
    });
  }

  /// @param constraint constraint(i) of hinge i
  template <class Topology, BaseMotion M, class Constraint>
  void factorize_with(const System<T, Topology, M>& system, const State<T>& x, const T& t,
                      Constraint&& constraint) {
    if (static_cast<int>(parts_.frames.size()) != system.layout().bodies + 1)
      parts_.resize(system.layout().bodies);
    place_base<M>(system.wing(), system.layout(), system.work().driven, parts_.frames[0], x, t);
    place_bodies<M>(system.wing(), system.topology(), parts_.frames, x);
    factorize_all<M>(system.wing(), system.topology(), parts_, constraint);
  }

  Augmented<T> parts_;
  std::vector<LoopResistance<T>> loops_; ///< of the last factorization
  std::vector<T> weights_;               ///< c
  std::vector<State<T>> columns_;        ///< Z
  Eigen::PartialPivLU<Square> small_;    ///< E2 + C VᵀZ
  Column right_;
};

} // namespace wingspread
