/// A latched wing about rest by the dense formulation: an oracle of its mass, stiffness and damping.
#pragma once

#include "tests/support/decompositions.hpp"
#include "tests/support/dense_wing.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace wingspread::oracle {

inline double hertz(double omega) { return omega / (2 * std::numbers::pi); }

/// A latched scene about rest by the dense formulation: differences of its accelerations, in extended precision. Its mass
/// matrix is the inverse of what unit moments at the hinges do.
class DenseRest {
  using Real = long double;

public:
  /// @param latched hinges that move, beside those without a latch
  DenseRest(const Scene& scene, const std::vector<double>& rest, const std::vector<int>& latched)
      : scene_(scene), wing_(scene), state_(wing_.initial_state()) {
    state_.base_rate = 0, state_.base_velocity.setZero();
    state_.rates.setZero();
    const int n = wing_.size();
    for (int i = 0; i < n; ++i) {
      const bool moves = !scene.hinges[i].latch || std::ranges::count(latched, i) > 0;
      (moves ? moving_ : held_).push_back(i);
      state_.angles(i) = rest[i];
      state_.engagement(i) = scene.hinges[i].latch && moves ? 1 : 0;
    }
    const Matrix<Real> whole = yields(state_).inverse()(moving_, moving_);
    unbalanced = (whole * accelerations(state_)).cast<double>();
    Matrix<Real> by_angle(moving_.size(), moving_.size()), by_rate = by_angle;
    for (Eigen::Index j = 0; j < by_angle.cols(); ++j) {
      by_angle.col(j) = difference(state_, state_.angles(moving_[j]));
      by_rate.col(j) = difference(state_, state_.rates(moving_[j]));
    }
    mass = whole.cast<double>();
    stiffness = (-whole * by_angle).cast<double>();
    damping = (-whole * by_rate).cast<double>();
  }

  Eigen::VectorXd unbalanced; ///< of the hinges that move, N·m
  Eigen::MatrixXd mass, stiffness, damping;

  /// Frequency, Hz, and ζ of each mode, lowest first.
  [[nodiscard]] std::vector<std::array<double, 2>> modes() const {
    if (moving_.empty()) return {};
    const Eigen::MatrixXd K = 0.5 * (stiffness + stiffness.transpose());
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, mass);
    std::vector<std::array<double, 2>> found;
    for (Eigen::Index k = 0; k < K.rows(); ++k) {
      const Eigen::VectorXd v = solver.eigenvectors().col(k); // vᵀM v = 1
      const double omega = std::sqrt(std::max(0.0, solver.eigenvalues()(k)));
      found.push_back({hertz(omega), omega > 0 ? v.dot(damping * v) / (2 * omega) : 0});
    }
    return found;
  }

private:
  /// M⁻¹: the accelerations of all hinges by their moments.
  [[nodiscard]] Matrix<Real> yields(const WingState<Real>& state) const {
    const int n = wing_.size();
    const Vector<Real> none = wing_.respond(state, Vector<Real>::Zero(n)).hinge_accelerations;
    Matrix<Real> found(n, n);
    for (int j = 0; j < n; ++j)
      found.col(j) = wing_.respond(state, Vector<Real>::Unit(n, j)).hinge_accelerations - none;
    return found;
  }

  /// Of the hinges that move, while moments hold the others. Motors have the last rate of their command.
  [[nodiscard]] Vector<Real> accelerations(const WingState<Real>& state) const {
    Vector<Real> moments = wing_.moments(state);
    for (const int i : moving_) {
      const std::optional<Motor>& motor = scene_.hinges[i].motor;
      if (!motor) continue;
      const Real rate = motor->table ? Real(motor->scale * motor->rates.back()) : Real(motor->rate);
      const Real wanted = motor->gain * (rate - wing_.sense(i) * state.rates(i));
      moments(i) += wing_.sense(i) *
                    std::clamp(wanted, Real(-motor->torque_limit), Real(motor->torque_limit));
    }
    const Vector<Real> free = wing_.respond(state, moments).hinge_accelerations;
    if (held_.empty()) return free(moving_);
    const Matrix<Real> by_moment = yields(state);
    const Vector<Real> holding = by_moment(held_, held_).inverse() * free(held_);
    return free(moving_) - by_moment(moving_, held_) * holding;
  }
  /// Of the accelerations, by a coordinate of `state`.
  [[nodiscard]] Vector<Real> difference(WingState<Real>& state, Real& coordinate) const {
    constexpr Real step = 1e-5L;
    const Real at = coordinate;
    coordinate = at + step;
    const Vector<Real> ahead = accelerations(state);
    coordinate = at - step;
    const Vector<Real> behind = accelerations(state);
    coordinate = at;
    return (ahead - behind) / (2 * step);
  }

  const Scene& scene_;
  DenseWing<Real> wing_;
  WingState<Real> state_;
  std::vector<int> moving_, held_;
};

} // namespace wingspread::oracle
