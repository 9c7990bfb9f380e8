/// A latched wing about its rest: the linear model of its motion, and how far the truth may differ
/// from it. For a base that is fixed, or pushed without turning.
///
/// Let u be the ways of the hinges from a rest φ*, S u the turns of the bodies: S_kl = 1 where l is
/// k or inward of it. With A_kl the way across body k towards body l, and Y_l the first moment about
/// hinge l of what l's own turning moves,
///
///     M_kl = c_kl cos Δ + s_kl sin Δ    c = A_kl·Y_l,  |s| = |A_kl × Y_l|,  Δ = (S u)_l − (S u)_k  (1)
///
/// is the mass matrix in absolute rates ω for k inward of l, c and s at rest, and with
/// M_0 = SᵀM(rest)S
///
///     M_0 ü = −K u − C u̇ + Sᵀn + f                                                              (2)
///     |n_k| ≤ Σ_l (½|c|Δ² + |s||Δ|) |ω̇_l| + Σ_l (|s| + |c||Δ|) ω_l² + |a| |Y_k| |(S u)_k|       (3)
///
/// The first sum is M(θ) − M(rest), the second what centripetal accelerations come to, the third
/// how a push a of the base turns. f is what the moments of the hinges have beyond K and C:
/// friction, curves that bend, dampers that are not viscous, loops that go slack.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/mechanics/workspace.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wingspread {

/// Hinges and bodies count from 0 here.
struct RestModel {
  /// |f| ≤ steady + bend |u|, and what the damper has beyond its part of C.
  struct Remainder {
    double steady = 0; ///< N·m
    double bend = 0;   ///< N·m/rad
    std::optional<DamperTerms<double>> damper;
    double taken = 0;     ///< N·m·s/rad of it that is in C
    double tuned_for = 0; ///< the rate for which that is so, rad/s; 0: for any
  };
  struct Loop {
    int first, second;
    double torque;             ///< |τ| at rest, N·m
    double gear, gear_changes; ///< largest |g'|, and by how much g' may differ from that at rest
    double stiffness, damping; ///< whole, N·m/rad and N·m·s/rad
    double until_slack; ///< K |e| may rise so far before a strand is slack, N·m; < 0: one is
  };

  std::vector<int> parents;           ///< −1: the base
  Eigen::VectorXd angles;             ///< φ*, rad
  Eigen::MatrixXd mass;               ///< M_0
  Eigen::MatrixXd stiffness, damping; ///< K, C
  Eigen::MatrixXd cosine, sine;       ///< |c|, |s|, both ways; 0 on the diagonal and off the paths
  /// (i, k): first moment of what is outward of hinge i, as far as body k's turning moves it, kg·m
  Eigen::MatrixXd lever_x, lever_y;
  Eigen::VectorXd pushed; ///< |a| |Y|, N·m
  Eigen::VectorXd weight; ///< |a| times the mass outward, N
  Eigen::VectorXd moment; ///< M of each hinge at rest, N·m
  Eigen::VectorXd room;   ///< no other law holds within this way from rest, rad
  std::vector<Remainder> remainders;
  std::vector<Loop> loops;

  [[nodiscard]] int size() const { return static_cast<int>(parents.size()); }

  /// Whether dampers are linear for about these rates.
  [[nodiscard]] bool is_tuned_for(const Eigen::VectorXd& rates) const;
  /// The most that f of hinges comes to, for ways up to u and rates up to v.
  void bound_remainders(const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                        Eigen::VectorXd& f) const;
};

/// Makes the model of a wing all of whose latches have engaged. Cost O(n³).
/// @param angles 1 … n at `angles[i − 1]`: from where rest is sought
/// @param rates  of the hinges: for which dampers are made linear
/// @return whether it has one: a base that turns, backlash, air and more than 40 bodies have none
[[nodiscard]] bool make_rest_model(const Wing<double>& wing, const Workspace<double>& work,
                                   const double* angles, const double* rates, RestModel& model);

} // namespace wingspread
