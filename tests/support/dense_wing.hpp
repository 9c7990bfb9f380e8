/// An independent oracle of the mechanics: the wing as one dense system in absolute angles.
///
/// The oracle shares only the parameters with the recursion of core/. The laws of real hinges are in hinge_laws.hpp.
/// The generalized coordinates are q = (x_0, y_0, θ_0, θ_1 … θ_n): the base's origin and the absolute angles of the base
/// and of every body. Then
///
///     r_j  = r_p + R(θ_p) c_pj − R(θ_j) c_jj                          (1)
///     r̈_j  = J_j q̈ + b_j,   J_j = ∂r_j/∂q,  b_j = J̇_j q̇              (2)
///     M    = Σ m_j J_jᵀ J_j + diag(J)                                 (3)
///     M q̈  = Q − Σ m_j J_jᵀ b_j                                       (4)
///     f_i  = Σ (m_j r̈_j − F_j) over the bodies outward of hinge i     (5)
///     Q    = ±hinge moments + Σ (J_jᵀ F_j + L_j on θ_j)               (6)
///
/// | symbol | meaning                                           | shape   | unit   |
/// |--------|---------------------------------------------------|---------|--------|
/// | q      | generalized coordinates                           | n + 3   | m, rad |
/// | J_j    | Jacobian of body j's centre of mass               | 2×(n+3) | m, 1   |
/// | b_j    | acceleration of this point at q̈ = 0               | 2       | m/s²   |
/// | M      | mass matrix                                       | (n+3)²  | kg …   |
/// | Q      | generalized forces                                | n + 3   | N, N·m |
/// | F_j    | gravity and air on body j, inertial axes          | 2       | N      |
/// | L_j    | moment of the air about body j's centre of mass   | 1       | N·m    |
/// | f_i    | force of hinge i on its child, inertial axes      | 2       | N      |
#pragma once

#include "core/scene/scene.hpp"
#include "tests/support/body_loads.hpp"
#include "tests/support/hinge_laws.hpp"

#include <Eigen/Core>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <vector>

namespace wingspread::oracle {

/// IEEE quadruple precision, 113 bits.
using Quad = boost::multiprecision::cpp_bin_float_quad;

template <class Scalar> using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
template <class Scalar> using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <class Scalar> using Columns2 = Eigen::Matrix<Scalar, 2, Eigen::Dynamic>;

/// The state of a scene by hinge angles. Vectors over hinges are in Scene order.
template <class Scalar> struct WingState {
  Vector<Scalar> angles;     ///< φ, n, rad
  Vector<Scalar> rates;      ///< φ̇, n, rad/s
  Vector<Scalar> engagement; ///< n, 0: latch open, 1: engaged, between: smoothed
  Vector2<Scalar> base_position = Vector2<Scalar>::Zero(); ///< m
  Vector2<Scalar> base_velocity = Vector2<Scalar>::Zero(); ///< m/s
  Scalar base_angle{0};                                    ///< θ_0, rad
  Scalar base_rate{0};                                     ///< rad/s
  Scalar time{0}; ///< s; used only by a base that a table drives

  /// The same state in another number type.
  template <class Other> [[nodiscard]] WingState<Other> cast() const {
    return {angles.template cast<Other>(),        rates.template cast<Other>(),
            engagement.template cast<Other>(),    base_position.template cast<Other>(),
            base_velocity.template cast<Other>(), static_cast<Other>(base_angle),
            static_cast<Other>(base_rate),        static_cast<Other>(time)};
  }
};

/// Accelerations and loads in a state. Hinges are in Scene order.
template <class Scalar> struct WingResponse {
  Vector<Scalar> hinge_accelerations; ///< φ̈, n, rad/s²
  Vector2<Scalar> base_acceleration;  ///< of the origin, m/s²
  Scalar base_angular_acceleration;   ///< rad/s²
  Vector<Scalar> moments;             ///< across each hinge, on the child, n, N·m
  Columns2<Scalar> forces;            ///< of each hinge on its child, inertial axes, 2×n, N
};

/// Energies and momenta of the bodies, and of the base if it is free.
template <class Scalar> struct WingBalance {
  Scalar kinetic;   ///< J
  Scalar potential; ///< energy of springs, harnesses, latches, stops, loops and gravity's work, J
  Vector2<Scalar> linear_momentum; ///< kg·m/s
  Scalar angular_momentum;         ///< about the inertial origin, kg·m²/s
};

/// The smooth step u²(3 − 2u), 0 below u = 0 and 1 above u = 1.
template <class Scalar> [[nodiscard]] Scalar smooth_step(const Scalar& u) {
  if (u <= 0) return Scalar(0);
  if (u >= 1) return Scalar(1);
  return u * u * (3 - 2 * u);
}

/// A scene as a dense system. Scalar: double, long double or Quad. Friction: regularized only.
template <class Scalar> class DenseWing {
public:
  /// @throws std::invalid_argument when the hinges form no tree,
  /// or when a hinge has exact friction.
  explicit DenseWing(const Scene& scene);

  /// The number of hinges, n.
  [[nodiscard]] int size() const { return static_cast<int>(links_.size()); }

  /// The state at t = 0: stowed, latches open.
  /// A base that is not free starts in the inertial origin.
  [[nodiscard]] WingState<Scalar> initial_state() const;

  /// The moment across each hinge, n, N·m.
  [[nodiscard]] Vector<Scalar> moments(const WingState<Scalar>& state) const;

  /// Accelerations, moments and reactions. Cost O(n³).
  [[nodiscard]] WingResponse<Scalar> respond(const WingState<Scalar>& state) const;

  /// The same with the given hinge moments, n, N·m.
  [[nodiscard]] WingResponse<Scalar> respond(const WingState<Scalar>& state,
                                             const Vector<Scalar>& moments) const;

  /// Energies and momenta. Cost O(n).
  [[nodiscard]] WingBalance<Scalar> balance(const WingState<Scalar>& state) const;

  /// How far hinge `hinge` has gone past its latched angle, in the deploying sense, rad.
  [[nodiscard]] Scalar overtravel(int hinge, const Scalar& angle) const;

  /// sign(φ_latched − φ_stowed) of hinge `hinge`.
  [[nodiscard]] Scalar sense(int hinge) const;

  /// s (φ − φ_stowed) of hinge `hinge`, rad.
  [[nodiscard]] Scalar travel(int hinge, const Scalar& angle) const;

  [[nodiscard]] bool has_latch(int hinge) const;

private:
  /// A hinge with its child. Links are numbered outward: a parent's number is below its child's.
  struct Link {
    int hinge;  ///< index into Scene::hinges
    int parent; ///< link of the parent, −1: the base
    Scalar mass, inertia;
    Vector2<Scalar> parent_point, child_point;
    Scalar stowed, latched, initial_rate, sense;
    TorqueLaw<Scalar> spring, harness;
    Scalar coulomb, viscous, friction_scale, regularization_rate;
    std::optional<Damper> damper;
    std::optional<Stop> stop, far_stop;
    std::optional<Latch> latch;
    std::optional<Joint> joint;
    std::optional<Plate> plate;
  };

  /// Absolute motion of the links, in outward order.
  struct Motion {
    Vector<Scalar> angles, rates;         ///< θ, ω
    Columns2<Scalar> positions, velocity; ///< r, ṙ
  };

  [[nodiscard]] static Link make_link(const Scene& scene, int hinge);
  void number_outward(const Scene& scene);
  [[nodiscard]] const Link& link_of(int hinge) const { return links_[link_of_hinge_[hinge]]; }
  [[nodiscard]] Scalar moment(const Link& link, const WingState<Scalar>& state) const;
  [[nodiscard]] Scalar friction(const Link& link, const Scalar& angle, const Scalar& rate) const;
  [[nodiscard]] Scalar potential(const Link& link, const WingState<Scalar>& state) const;
  [[nodiscard]] Scalar out_of_step(const Loop<Scalar>& loop, const WingState<Scalar>& state) const;
  void pull(const Loop<Scalar>& loop, const WingState<Scalar>& state,
            Vector<Scalar>& moments) const;
  [[nodiscard]] Load<Scalar> load(int k, const Motion& at) const;
  [[nodiscard]] Motion motion(const WingState<Scalar>& state) const;
  [[nodiscard]] std::vector<Columns2<Scalar>> jacobians(const Motion& at,
                                                        const Scalar& base_angle) const;
  [[nodiscard]] Columns2<Scalar> biases(const Motion& at, const WingState<Scalar>& state) const;
  [[nodiscard]] Matrix<Scalar> mass_matrix(const std::vector<Columns2<Scalar>>& jacobians) const;
  [[nodiscard]] Vector<Scalar> applied(const Vector<Scalar>& moments) const;
  /// (r̈_0, ω̇_0) of a base that is not free.
  [[nodiscard]] Eigen::Matrix<Scalar, 3, 1> prescribed(const Scalar& time) const;
  [[nodiscard]] Vector<Scalar> solve(const Matrix<Scalar>& mass, const Vector<Scalar>& force,
                                     const Scalar& time) const;

  BaseMotion base_motion_;
  Scalar base_mass_, base_inertia_;
  Vector2<Scalar> gravity_;
  Scalar air_density_;
  DrivenBase<Scalar> driven_;
  WingState<Scalar> initial_;
  std::vector<Link> links_;
  std::vector<Loop<Scalar>> loops_;
  std::vector<int> link_of_hinge_;
  std::vector<std::vector<int>>
      paths_; ///< coordinates that move link k: 0, 1, 2, ancestors, itself
};

extern template class DenseWing<double>;
extern template class DenseWing<long double>;
extern template class DenseWing<Quad>;

} // namespace wingspread::oracle
