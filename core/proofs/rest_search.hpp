/// The search for a wing's rest: the angles at which the moments of its hinges balance.
///
/// The moments r are minus the gradient of a potential, and K is its second derivative.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {

/// @tparam Balance called without arguments: sets K, r and the moments at the angles
template <class Balance> class RestSearch {
public:
  /// @param angles   of the hinges, rad: where the search begins, and rest where it succeeds
  /// @param K        stiffness, N·m/rad
  /// @param r        residual moments, N·m; 0 for hinges that are held
  /// @param moments  the hinges' own parts of r, of which rounding is a share, N·m
  RestSearch(Eigen::VectorXd& angles, const Eigen::MatrixXd& K, const Eigen::VectorXd& r,
             const Eigen::VectorXd& moments, Balance balance)
      : angles_(angles), K_(K), r_(r), moments_(moments), balance_(std::move(balance)) {}

  /// Newton's method. A hinge that nothing holds stays: the least solution does not move it. Eight full steps and eight
  /// half steps by turns end cycles about the kink of a linear table or of a strand.
  /// @return whether it settles at a stable rest by short steps that descend the potential. Others may leap a barrier,
  ///         to a rest that hinges do not reach that creep from here
  [[nodiscard]] bool converge() {
    for (int pass = 0; pass < 100; ++pass) {
      balance_();
      const Eigen::VectorXd way = K_.completeOrthogonalDecomposition().solve(r_);
      if (way.lpNorm<Eigen::Infinity>() > longest || r_.dot(way) < 0) return false;
      angles_ += (pass % 16 < 8 ? 1 : 0.5) * way;
      if (!(way.lpNorm<Eigen::Infinity>() > settled)) return is_stable(); // or not a number
    }
    return false;
  }

  /// Descends the potential: along each eigenvector q of K by q·r/|λ|, at most 0.3 rad, and not beyond the first place
  /// at which the way no longer descends. So it ends at a stable rest, the one that hinges reach that creep from here.
  /// @return false if there is none within the passes: hinges turn on and on
  [[nodiscard]] bool descend() {
    constexpr int passes = 300; // of at most 0.3 rad: more than ten turns
    balance_();
    for (int pass = 0; pass < passes; ++pass) {
      if (!K_.allFinite() || !r_.allFinite()) return false;
      const Eigen::VectorXd way = descent();
      if (!(way.lpNorm<Eigen::Infinity>() > settled)) return is_stable();
      follow(way);
    }
    return false;
  }

private:
  static constexpr double settled = 1e-12; ///< rad: a way that counts as none
  /// A longer step counts as one that may leap a barrier, rad. Heuristic: a smaller value takes more steps.
  static constexpr double longest = 0.3;

  /// Whether moments balance, to rounding, and no mode grows. @pre K and r are those of the angles
  [[nodiscard]] bool is_stable() const {
    const auto scale = K_.cwiseAbs().rowwise().sum().array();
    const auto least = 1e-9 * moments_.array().abs() + 10 * settled * scale;
    if (!(r_.array().abs() <= least).all()) return false;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K_, Eigen::EigenvaluesOnly);
    return modes.eigenvalues()(0) >= -1e-9 * modes.eigenvalues()(K_.rows() - 1);
  }

  [[nodiscard]] Eigen::VectorXd descent() const {
    constexpr double nudge = 1e-3; // rad
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K_);
    const double stiffest = modes.eigenvalues().cwiseAbs().maxCoeff();
    Eigen::VectorXd way = Eigen::VectorXd::Zero(K_.rows());
    for (Eigen::Index k = 0; k < K_.rows(); ++k) {
      const auto q = modes.eigenvectors().col(k);
      const double along = q.dot(r_), lambda = modes.eigenvalues()(k);
      double turn = 0;
      if (std::abs(along) > 1e-14 * stiffest)
        turn = along / std::max(std::abs(lambda), std::abs(along) / longest);
      else if (lambda < -1e-9 * stiffest)
        turn = nudge; // off an unstable rest
      way += turn * q;
    }
    return way;
  }

  /// Goes along the way, at most to where it no longer descends.
  void follow(const Eigen::VectorXd& way) {
    constexpr int halvings = 30;
    const Eigen::VectorXd from = angles_;
    const double steep = 0.1 * r_.dot(way);
    double low = 0, high = 1, step = 1;
    for (int k = 0; k < halvings; ++k, step = (low + high) / 2) {
      angles_ = from + step * way;
      balance_();
      const double slope = r_.dot(way);
      if (std::abs(slope) <= steep || (step == 1 && slope > 0)) return;
      (slope > 0 ? low : high) = step;
    }
    angles_ = from + low * way;
    balance_();
  }

  Eigen::VectorXd& angles_;
  const Eigen::MatrixXd& K_;
  const Eigen::VectorXd &r_, &moments_;
  Balance balance_;
};

} // namespace wingspread
