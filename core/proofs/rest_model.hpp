/// A latched wing about its rest: the linear model of its motion, and how far the truth may differ
/// from it. The base is fixed, pushed, turned at a constant rate, or free.
///
/// Let u be the ways of the hinges from a rest φ*, ω the rates of the bodies, the base's the first.
/// With Y_k the first moment of all outward of hinge k that body k's turning moves, and A_kl the way
/// across body k towards body l, the masses come to
///
///     M_kl = c_kl cos Δ + s_kl sin Δ        Δ: how far l has turned against k since rest           (1)
///
/// c = A_kl·Y_l and |s| = |A_kl × Y_l| at rest for k inward of l. On a free base they are taken about the
/// common centre of mass: less Y_k·Y_l/m and Y_k × Y_l/m, m the whole mass, for all pairs. Let 1 be
/// the rigid rotation, I = 1ᵀM 1, and S u̇ the rates of the bodies that go with u̇: of each body the
/// hinges inward of it, on a free base less the rotation by which the angular momentum at rest stays
/// zero. Then ω = S u̇ + r 1 and, with M_0 = SᵀM(rest)S,
///
///     M_0 ü = −K u − C u̇ + Sᵀn + f                                                              (2)
///     |n_k| ≤ Σ_l (½|c|Δ² + |s||Δ|) |ω̇_l| + Σ_l (|s| + |c||Δ|) ω_l² + what a push does             (3)
///     |r| ≤ (|H| + Σ_kl (½|c|Δ² + |s||Δ|) |ω_l|)/I,  ṙ = 1ᵀn/I     on a free base                 (4)
///
/// The first sum is M(θ) − M(rest), the second what centripetal accelerations come to; H is the
/// angular momentum. On a base that turns r is its rate, there is no first sum for it, and the push on the wing at rest, which
/// comes and goes as the base turns, is told apart. f is what
/// the moments of the hinges have beyond K and C: friction, curves that bend, dampers that are not
/// viscous, loops that go slack.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/mechanics/workspace.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wingspread {

/// Hinges count from 0 here; so do bodies, 0 being the base.
struct RestModel {
  /// Of two bodies, the first with the lesser number.
  struct Pair {
    int first, second, meet; ///< the outermost body inward of both, or one of them
    double cosine, sine;     ///< |c|, |s|
  };

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

  std::vector<int> parents;           ///< of hinge i: the body that it hangs on
  Eigen::VectorXd angles;             ///< φ*, rad
  Eigen::MatrixXd mass;               ///< M_0
  Eigen::MatrixXd stiffness, damping; ///< K, C
  Eigen::MatrixXd turns;              ///< S: bodies by hinges
  double rigid = 0;                   ///< 1/I of a free base, else 0
  double spin = 0;                    ///< |r| of a base that turns, rad/s
  std::vector<Pair> pairs;            ///< those that count
  /// (i, k): first moment of what is outward of hinge i, as far as body k's turning moves it, kg·m
  Eigen::MatrixXd lever_x, lever_y;
  Eigen::VectorXd pushed; ///< 0 … n: |a| |Y|, N·m
  /// Of a base that turns, else 0: what the push does to body k at rest is cosine cos ψ + sine sin ψ, where the base
  /// has turned by ψ = turn_rate (t − since), N·m.
  Eigen::VectorXd push_cosine, push_sine;
  double turn_rate = 0, since = 0; ///< rad/s, s
  Eigen::VectorXd weight;          ///< |a| times the mass outward, N
  Eigen::VectorXd moment;          ///< M of each hinge at rest, N·m
  Eigen::VectorXd room; ///< within this way from rest no other law holds, nor an overtravel, rad
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
/// @return whether it has one: a base that turns faster and faster, backlash, air and more than 40
///         bodies have none
[[nodiscard]] bool make_rest_model(const Wing<double>& wing, const Workspace<double>& work,
                                   const double* angles, const double* rates, RestModel& model);

} // namespace wingspread
