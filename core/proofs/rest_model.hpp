/// A latched wing about its rest: the linear model of its motion, and bounds on what the model leaves
/// out. The base is fixed, pushed, turned at a constant rate or faster and faster, or free.
///
/// | symbol  | meaning                                                                    | unit       |
/// |---------|----------------------------------------------------------------------------|------------|
/// | φ*, u   | angles of the hinges at rest; ways off rest                                | rad        |
/// | ω, Δ    | rates of the bodies, the base's first; turn of one body against another    | rad/s, rad |
/// | Y_k     | first moment of all outward of hinge k, as far as body k's turning moves it | kg·m      |
/// | A_kl    | way across body k towards body l                                           | m          |
/// | M, m    | mass matrix in absolute rates; mass of the whole                           | kg·m², kg  |
/// | 1, I    | the rigid rotation, and its inertia 1ᵀM 1                                  | –, kg·m²   |
/// | S       | rates of the bodies for rates of the hinges                                | –          |
/// | M_0, K, C | SᵀM(rest)S, stiffness and damping of the hinges                          | kg·m², …   |
/// | r, H    | rigid rotation beside S u̇; angular momentum                                | rad/s, …   |
/// | n, f    | moments that M_0, K and C leave out: on bodies, at hinges                  | N·m        |
///
///     M_kl = c_kl cos Δ + s_kl sin Δ                                                             (1)
///
/// c = A_kl·Y_l and |s| = |A_kl × Y_l| at rest, for k inward of l. On a free base the masses are taken
/// about the common centre of mass: less Y_k·Y_l/m and Y_k × Y_l/m, for all pairs. S u̇ turns each body
/// by the hinges inward of it, on a free base less the rotation by which the angular momentum at rest
/// stays zero. Then ω = S u̇ + r 1 and
///
///     M_0 ü = −K u − C u̇ + Sᵀn + f                                                              (2)
///     |n_k| ≤ Σ_l (½|c|Δ² + |s||Δ|) |ω̇_l| + Σ_l (|s| + |c||Δ|) ω_l² + what a push does             (3)
///     |r| ≤ (|H| + Σ_kl (½|c|Δ² + |s||Δ|) |ω_l|)/I,  ṙ = 1ᵀn/I     on a free base                 (4)
///
/// The first sum of (3) is M(θ) − M(rest), the second bounds centripetal accelerations. On a base that
/// turns, r is the base's rate and has no first sum; the push on the wing at rest, which comes and goes
/// as the base turns, is kept apart. On a base with a constant angular acceleration ε, r is the largest rate up to the
/// run's end, every ω̇ has ε beside S ü, and n has at most ε |Σ_l M_kl(rest)| + |push| |Y_k| more. f
/// holds friction, curves that bend, dampers that are not viscous, motors that pass their limits, and
/// loops that go slack.
#pragma once

#include "core/laws/motor.hpp"
#include "core/mechanics/wing.hpp"
#include "core/mechanics/workspace.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace wingspread {

/// No wing of more bodies has a model: proofs by energy alone must do. Heuristic: a proof costs O(n²),
/// and at first O(n³); a longer chain would spend more on proofs than they save.
inline constexpr int most_modelled_bodies = 40;

using HingeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_modelled_bodies, 1>;
using BodyVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_modelled_bodies + 1, 1>;

/// Hinges count from 0 here; so do bodies, 0 being the base.
struct RestModel {
  /// Two bodies; the first has the lesser number.
  struct Pair {
    int first, second, meet; ///< the outermost body inward of both, or one of them
    double cosine, sine;     ///< |c|, |s|
  };

  /// |f| ≤ steady + (bend + dissipation |v|) |u| + what damper and motor exert beyond their parts of C.
  struct Remainder {
    double steady = 0;      ///< N·m
    double bend = 0;        ///< N·m/rad
    double dissipation = 0; ///< k c of a latch, N·m·s/rad²
    std::optional<DamperTerms<double>> damper;
    double taken = 0;     ///< its part of C, N·m·s/rad
    double tuned_for = 0; ///< the rate at which `taken` is exact, rad/s; 0: at any
    MotorAtRest motor{};
  };
  struct Loop {
    int first, second;
    double torque;             ///< |τ| at rest, N·m
    double gear, gear_changes; ///< largest |g'|, and by how much g' may differ from that at rest
    double stiffness, damping; ///< whole, N·m/rad and N·m·s/rad
    double until_slack; ///< rise of K |e| before a strand goes slack, N·m; < 0: one is slack
  };

  std::vector<int> parents;           ///< of hinge i: the body that it hangs on
  Eigen::VectorXd angles;             ///< φ*, rad
  Eigen::MatrixXd mass;               ///< M_0
  Eigen::MatrixXd stiffness, damping; ///< K, C
  Eigen::MatrixXd turns;              ///< S: bodies by hinges
  double rigid = 0;                   ///< 1/I of a free base, else 0
  double spin = 0;                    ///< largest |r| of a base that turns, rad/s
  double quickening = 0;              ///< |ε|, rad/s²
  std::vector<Pair> pairs;            ///< all with c or s ≠ 0
  /// (i, k): first moment of what is outward of hinge i, as far as body k's turning moves it, kg·m
  Eigen::MatrixXd lever_x, lever_y;
  Eigen::VectorXd pushed; ///< 0 … n: |a| |Y|, N·m
  /// On a base that turns, else 0: the push turns body k at rest by cosine cos ψ + sine sin ψ, N·m, where
  /// the base has turned by ψ = turn_rate (t − since).
  Eigen::VectorXd push_cosine, push_sine;
  double turn_rate = 0, since = 0; ///< rad/s, s
  Eigen::VectorXd dragged;         ///< 0 … n: what n has more where ε is not 0, N·m
  Eigen::VectorXd weight;          ///< |a| times the mass outward, N
  Eigen::VectorXd moment;          ///< M of each hinge at rest, N·m
  Eigen::VectorXd room; ///< way from rest to where another law holds or overtravel begins, rad
  std::vector<Remainder> remainders;
  std::vector<Loop> loops;

  [[nodiscard]] int size() const { return static_cast<int>(parents.size()); }

  /// Whether a damper was made linear for a rate: other rates may then need another model.
  [[nodiscard]] bool depends_on_rates() const {
    return std::ranges::any_of(remainders, [](const auto& f) { return f.tuned_for != 0; });
  }
  /// Whether the model's dampers fit these rates. Heuristic: a poor fit makes f large and the bounds
  /// useless, never wrong.
  [[nodiscard]] bool is_tuned_for(const HingeVector& rates) const;
  /// Bounds |f| of every hinge, for ways up to u and rates up to v, N·m.
  [[nodiscard]] HingeVector bound_remainders(const HingeVector& u, const HingeVector& v) const;

  /// Bounds on the effects of the bodies' turns off rest.
  struct Turned {
    BodyVector ways;     ///< of the bodies, rad
    BodyVector moments;  ///< |n| by (3), N·m
    double momentum = 0; ///< the sum in (4), N·m·s
  };
  /// Bounds of turns by an energy: Σ κ u² ≤ size², where u counts from rests that are `apart` from the model's. The
  /// bound of one body's turn against another is closer than the sum of the bounds of the hinges between them.
  struct EnergyOfTurns {
    double size; ///< √J
    BodyVector softness,
        apart; ///< sums from the base to each body: of 1/κ; of the distances of the rests, rad
    /// Bounds the turn of body k against body l. @param meet the outermost body inward of both
    [[nodiscard]] double turn(int k, int l, int meet) const {
      const double soft = softness(k) + softness(l) - 2 * softness(meet);
      return size * std::sqrt(std::max(0.0, soft)) + (apart(k) + apart(l) - 2 * apart(meet));
    }
  };
  /// Bounds (3) and (4), for ways of the hinges up to u, accelerations and rates of the bodies up to these.
  /// @param energy null: not known
  [[nodiscard]] Turned bound_turns(const HingeVector& u, const BodyVector& accelerations,
                                   const BodyVector& rates,
                                   const EnergyOfTurns* energy = nullptr) const;
};

namespace detail {

/// Finds `room` and the `remainders` of friction and curves. @pre the model has its angles at rest
void find_remainders(const Wing<double>& wing, RestModel& model);

/// Whether a damper acts at rest, whatever the hinge's present side of its window. At an edge `room` is 0: no bound.
[[nodiscard]] inline bool damper_acts_at_rest(const RealHingeTerms<double>& real, double rest) {
  return !real.has_window || (rest > real.window_low && rest < real.window_high);
}

} // namespace detail

/// Makes the model of a wing all of whose latches have engaged. Cost O(n³).
/// @param angles of the hinges, 0 … n − 1: where the search for rest begins
/// @param rates  of the hinges, for which dampers are made linear
/// @param t_end  the run's end, s: the model of a base that turns faster and faster holds up to there
/// @return whether there is a model: not for backlash, air, or more than most_modelled_bodies, nor where the
///         base's accelerations change
[[nodiscard]] bool make_rest_model(const Wing<double>& wing, const Workspace<double>& work,
                                   const double* angles, const double* rates, double t_end,
                                   RestModel& model);

/// Which hinges, 0 … n − 1, holds keep near their stowed angles: such a hinge has neither latch nor motor.
struct HoldsAtRest {
  std::vector<char> rigid; ///< it stays at its angle, with a row and column of the unit matrix in K
  std::vector<char>
      elastic; ///< a spring and damper about the stowed angle, those of Wing::releases
};

/// The angles at rest, mass, stiffness, damping and turns alone, of a wing of any size: no bounds, and no part of air,
/// friction and backlash. The stiffness includes the push of a base that does not turn, and the bend of loaded gears.
/// Motors have the command after their last knot. Cost O(n³).
/// @param angles  of the hinges, 0 … n − 1: where the search for rest begins
/// @return whether rest was found, and all is finite
[[nodiscard]] bool make_linear_model(const Wing<double>& wing, const double* angles,
                                     const HoldsAtRest& holds, RestModel& model);

} // namespace wingspread
