/// A Rosenbrock-W method for stiff latches, whose linear solve is the recursion itself.
///
/// With u = (q, v), q̇ = v, v̇ = a(t, q, v), and only the stiffness and damping of latches, springs and
/// friction in the Jacobian,
///
///     J = [ 0  E2 ; −M⁻¹K  −M⁻¹D ],    K, D diagonal over the hinges, M at the step's start  (1)
///
/// a W-method keeps its order whatever J is; J decides its stability. In the usual variables
/// without products by J [Hairer & Wanner II, IV.7], each stage i solves
///
///     (1 − hγJ) U_i = R,    R = hγ f(t + α_i h, u + Σ_j a_ij U_j) + γ Σ_j c_ij U_j         (2)
///
/// and eliminating the half of q,
///
///     U_v = R_v − (M + E)⁻¹ (E R_v + hγ K R_q),    E = hγ D + h²γ² K                       (3)
///     U_q = R_q + hγ U_v                                                                   (4)
///
/// (M + E)⁻¹ is augmented.hpp's: each hinge carries the inertia E. O(n), no matrix.
///
/// The command of a motor turns time into moments, by its gain c, which can be stiff. Time is then one more variable, with
/// ṫ = 1: J has the column ∂f/∂t = (0, M⁻¹ c ẇ) of it at the step's start. Its share U_t of a stage is a known number, and
/// adds to (3)
///
///     (M + E)⁻¹ hγ c ẇ U_t                                                                    (5)
///
/// ROS34PW2: four stages, order 3(2), L-stable, stiffly accurate [J. Rang & L. Angermann, New
/// Rosenbrock W-methods of order 3 for partial differential algebraic equations of index 1, BIT 45
/// (2005) 761-787].
#pragma once

#include "core/mechanics/linear_solve.hpp"
#include "core/methods/method.hpp"

#include <array>

namespace wingspread {

/// Coefficients of (2) and of the step, in the transformed variables.
struct RosenbrockTableau {
  static constexpr int stages = 4;
  using Row = std::array<double, stages>;
  using Table = std::array<Row, stages>;
  double gamma{};
  Table a{}, c{};
  Row nodes{}; ///< α_i
  Row m{};     ///< of the step
  Row error{}; ///< m less the embedded m̂

  /// From the tableau as published: slopes k_i with α_ij, γ_ij, weights b and b̂; with Γ = (γ_ij),
  /// a = α Γ⁻¹, c = 1/γ − Γ⁻¹, m = b Γ⁻¹.
  constexpr RosenbrockTableau(const Table& alpha, const Table& Gamma, const Row& b,
                              const Row& b_hat)
      : gamma(Gamma[0][0]) {
    const Table inverse = inverted(Gamma);
    for (int i = 0; i < stages; ++i) {
      for (int j = 0; j < stages; ++j) {
        nodes[i] += alpha[i][j];
        c[i][j] = -inverse[i][j];
        m[i] += b[j] * inverse[j][i];
        error[i] += (b[j] - b_hat[j]) * inverse[j][i];
        for (int k = 0; k < stages; ++k) a[i][j] += alpha[i][k] * inverse[k][j];
      }
    }
  }

private:
  /// Of a lower triangular matrix.
  [[nodiscard]] static constexpr Table inverted(const Table& L) {
    Table X{};
    for (int j = 0; j < stages; ++j) {
      X[j][j] = 1 / L[j][j];
      for (int i = j + 1; i < stages; ++i) {
        for (int k = j; k < i; ++k) X[i][j] -= L[i][k] * X[k][j];
        X[i][j] /= L[i][i];
      }
    }
    return X;
  }
};

inline constexpr double ros34pw2_gamma = 4.3586652150845900e-1;
inline constexpr RosenbrockTableau ros34pw2(
    {{{0, 0, 0, 0},
      {8.7173304301691801e-1, 0, 0, 0},
      {8.4457060015369423e-1, -1.1299064236484185e-1, 0, 0},
      {0, 0, 1, 0}}},
    {{{ros34pw2_gamma, 0, 0, 0},
      {-8.7173304301691801e-1, ros34pw2_gamma, 0, 0},
      {-9.0338057013044082e-1, 5.4180672388095326e-2, ros34pw2_gamma, 0},
      {2.4212380706095346e-1, -1.2232505839045147, 5.4526025533510214e-1, ros34pw2_gamma}}},
    {2.4212380706095346e-1, -1.2232505839045147, 1.5452602553351020, ros34pw2_gamma},
    {3.7810903145819369e-1, -9.6042292212423178e-2, 5.0000000000000000e-1, 2.1793326075422950e-1});

/// (1 − ηJ)⁻¹ by (3) to (5), with η = hγ.
template <class T> class LinearlyImplicit {
public:
  /// M + E at the step's start. Cost about half an evaluation.
  template <class System> void factorize(System& system, const Start<T>& from, const T& eta) {
    const Layout& at = system.layout();
    eta_ = eta;
    added_.resize(at.bodies + 1), spring_.resize(at.bodies + 1);
    pushed_.assign(system.wing().motors.size(), T(0));
    solved_.resize(at.freedoms());
    for (int i = 1; i <= at.bodies; ++i) {
      const auto hinge = resistance(system, from.x, from.t, i);
      spring_[i] = eta * hinge.stiffness;
      added_[i] = eta * (hinge.damping + spring_[i]);
      if (!pushed_.empty()) pushed_[i] = eta * command_push(system, from.x, from.t, i);
    }
    linear_.factorize(system, from.x, from.t, [&](int i) { return added_[i]; });
    if (system.wing().loops.empty()) return;
    loop_resistances(system, from.x, loops_);
    linear_.add_loops(system, loops_, [&](const LoopResistance<T>& loop) {
      return eta * fused(eta, loop.stiffness, loop.damping);
    });
  }

  /// R ← (1 − ηJ)⁻¹ R. Cost about half an evaluation.
  /// @param time U_t, s
  template <class System> void solve(System& system, State<T>& R, const T& time) {
    const Layout& at = system.layout();
    linear_.solve(
        system,
        [&](int i) {
          const T resisted = fused(added_[i], R[at.rate(i)], spring_[i] * R[at.angle(i)]);
          const T pushed = pushed_.empty() ? T(0) : T(pushed_[i] * time);
          return (resisted - pushed) + of_loops(at, R, i);
        },
        solved_.data());
    const int v = at.freedoms();
    for (int k = 0; k < v; ++k) {
      R[v + k] = R[v + k] - solved_[k];
      R[k] = fused(eta_, R[v + k], R[k]);
    }
  }

private:
  /// c ẇ of the motor of hinge i at (x, t), N·m/s.
  template <class System>
  [[nodiscard]] static T command_push(const System& system, const State<T>& x, const T& t, int i) {
    const MotorPiece<T>& motor = system.work().motors[i];
    const T excess = command_excess(motor, t, T(x[system.layout().rate(i)]));
    return motor_damping(system.wing().motors[i], motor, excess) *
           cubic_slope(motor.rate, T(t - motor.from));
  }

  /// The loops' share of E R_v + hγ K R_q at hinge i.
  [[nodiscard]] T of_loops(const Layout& at, const State<T>& R, int i) const {
    T sum(0);
    for (const LoopResistance<T>& loop : loops_) {
      if (loop.first != i && loop.second != i) continue;
      const T rate = loop.along([&](int k) { return R[at.rate(k)]; });
      const T angle = loop.along([&](int k) { return R[at.angle(k)]; });
      const T pull =
          eta_ * fused(fused(eta_, loop.stiffness, loop.damping), rate, loop.stiffness * angle);
      sum = fused(loop.first == i ? loop.on_first : loop.on_second, pull, sum);
    }
    return sum;
  }

  LinearSolve<T> linear_;
  T eta_ = T(0);
  State<T> added_, spring_, solved_;
  std::vector<T> pushed_; ///< hγ c ẇ, 1 … n; empty without motors
  std::vector<LoopResistance<T>> loops_;
};

template <class T> struct RosenbrockW {
  static constexpr int order = 3, error_order = 2;
  static constexpr const RosenbrockTableau& tableau = ros34pw2;

  template <class System>
  void estimate(System& system, const Start<T>& from, const T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error) {
    for (State<T>& u : U_) u.resize(from.x.size());
    const T hg = h * T(tableau.gamma);
    linear_.factorize(system, from, hg);
    std::array<T, RosenbrockTableau::stages> time; // U_t of the stages
    for (int i = 0; i < RosenbrockTableau::stages; ++i) {
      if (i > 0) {
        combine(from.x, tableau.a[i], i, x1);
        system(x1, dxdt1, from.t + T(tableau.nodes[i]) * h);
      }
      T sum(0);
      for (int j = 0; j < i; ++j) sum = fused(T(tableau.c[i][j]), time[j], sum);
      time[i] = fused(T(tableau.gamma), sum, hg);
      stage(system, i == 0 ? from.dxdt : dxdt1, i, hg, time[i]);
    }
    combine(from.x, tableau.m, RosenbrockTableau::stages, x1);
    zero_.assign(from.x.size(), T(0));
    combine(zero_, tableau.error, RosenbrockTableau::stages, error);
    evaluate_end(system, x1, dxdt1, T(from.t + h));
  }

private:
  /// out = x + Σ_j<count w_j U_j
  void combine(const State<T>& x, const RosenbrockTableau::Row& w, int count, State<T>& out) const {
    for (std::size_t k = 0; k < x.size(); ++k) {
      T sum = x[k];
      for (int j = 0; j < count; ++j) sum = fused(T(w[j]), U_[j][k], sum);
      out[k] = sum;
    }
  }

  /// Eqs. (2)-(5): U_i from f at its stage. @param time U_t
  template <class System>
  void stage(System& system, const State<T>& f, int i, const T& hg, const T& time) {
    State<T>& U = U_[i];
    for (std::size_t k = 0; k < f.size(); ++k) {
      T sum(0);
      for (int j = 0; j < i; ++j) sum = fused(T(tableau.c[i][j]), U_[j][k], sum);
      U[k] = fused(T(tableau.gamma), sum, hg * f[k]);
    }
    linear_.solve(system, U, time);
  }

  LinearlyImplicit<T> linear_;
  std::array<State<T>, RosenbrockTableau::stages> U_;
  State<T> zero_;
};

} // namespace wingspread
