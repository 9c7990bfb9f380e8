/// What an engineer writes first: a chain in absolute angles with a dense mass matrix, by hand with
/// Eigen. The benchmark's yardstick, and a check of what it times; the product does not use it.
///
///     M_ij = (J_i if i = j) + Σ_{k ≥ max(i,j)} m_k J_ik · J_jk,   r_k = Σ_i J_ik-turned
///
/// with J_ik = e3 × v_ik, v_ik = R(θ_i) (l_{i+1} if k > i, g_i if k = i).
#pragma once

#include "core/scene/scene.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace wingspread::study {

/// A chain on a fixed base, hinges in order. N: compile-time size, or Eigen::Dynamic.
template <int N> class DenseChain {
public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  explicit DenseChain(const Scene& scene) : n_(static_cast<int>(scene.bodies.size())), links_(n_) {
    mass_.resize(n_, n_), load_.resize(n_), outer_.resize(n_), inner_.resize(n_);
    double outward = 0;
    for (int i = n_ - 1; i >= 0; --i) {
      Link& link = links_[i];
      const Hinge& hinge = scene.hinges[i];
      link.center = -hinge.child_point;
      link.arm = i + 1 < n_ ? Eigen::Vector2d(scene.hinges[i + 1].parent_point + link.center)
                            : Eigen::Vector2d(0, 0);
      link.mass = scene.bodies[i].mass, link.inertia = scene.bodies[i].inertia;
      link.outward = outward; // mass beyond this body
      outward += link.mass;
    }
  }

  /// θ, ω, hinge moments → ω̇.
  void accelerate(const Vector& angle, const Vector& rate, const Vector& moment, Vector& out) {
    for (int i = 0; i < n_; ++i) {
      const double s = std::sin(angle[i]), c = std::cos(angle[i]);
      const auto turn = [&](const Eigen::Vector2d& v) {
        return Eigen::Vector2d(c * v.x() - s * v.y(), s * v.x() + c * v.y());
      };
      const Eigen::Vector2d g = turn(links_[i].center), l = turn(links_[i].arm);
      inner_[i] = links_[i].mass * g + links_[i].outward * l; // Σ m_k v_ik over k ≥ i
      outer_[i] = l;
      mass_(i, i) = links_[i].inertia + links_[i].mass * g.squaredNorm() +
                    links_[i].outward * l.squaredNorm();
      load_[i] = moment[i] - (i + 1 < n_ ? moment[i + 1] : 0.0);
    }
    // body k > i moves by l_i with θ_i and by v_jk with θ_j: Σ_k m_k v_jk = inner_j
    for (int i = 0; i < n_; ++i)
      for (int j = i + 1; j < n_; ++j) {
        mass_(i, j) = mass_(j, i) = outer_[i].dot(inner_[j]);
        const double cross = outer_[i].x() * inner_[j].y() - outer_[i].y() * inner_[j].x();
        load_[i] += rate[j] * rate[j] * cross;
        load_[j] -= rate[i] * rate[i] * cross;
      }
    out = mass_.ldlt().solve(load_);
  }

private:
  struct Link {
    Eigen::Vector2d center, arm;
    double mass, inertia, outward;
  };
  int n_;
  std::vector<Link> links_;
  Matrix mass_;
  Vector load_;
  std::vector<Eigen::Vector2d> outer_, inner_;
};

} // namespace wingspread::study
