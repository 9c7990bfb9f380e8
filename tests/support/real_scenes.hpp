/// Scenes with real hinges: random features on random wings, and wings with a known
/// answer.
#pragma once

#include "tests/support/random_scenes.hpp"

#include <memory>
#include <vector>

namespace wingspread::oracle {

/// The features that a random scene may have. Each hinge, body and pair of hinges is drawn separately.
struct RealFeatures {
  bool tables = true;   ///< springs and harnesses by tables of either interpolation
  bool measured = true; ///< springs with torques measured both deploying and stowing
  bool scales = true;   ///< and offsets, of every law that has them
  bool dampers = true, windows = true;
  bool stops = true, backlash = true, loops = true, preloads = true;
  bool gravity = true, air = true;
  bool dissipation = true; ///< of latches, in place of their damping
  /// Stiffnesses of stops and loops, N·m/rad, log-uniform. Latches have their own.
  double softest = 1e1, stiffest = 1e4;
};

/// The scene with random features, each there with probability 1/2.
[[nodiscard]] Scene with_real_hinges(Scene scene, std::uint64_t seed,
                                     const RealFeatures& features = {});

/// A table of a curve.
[[nodiscard]] std::shared_ptr<const TorqueTable>
torque_table(std::vector<double> angle, std::vector<double> torque,
             Interpolation how = Interpolation::monotone);
[[nodiscard]] std::shared_ptr<const TorqueTable>
torque_table(std::vector<double> angle, std::vector<double> deploying, std::vector<double> stowing,
             Interpolation how = Interpolation::monotone);

/// A loop's table: the travel of the second hinge against that of the first.
void tabulate(Synchronisation& loop, std::vector<double> travel,
              std::vector<double> travel_of_second);

/// The scene on a base driven by a random table over time. The table has rates or accelerations, with either
/// interpolation. It may start before or after 0, and end before or after t_end. Quantities without a column are constant.
[[nodiscard]] Scene driven_by_table(Scene scene, std::uint64_t seed, double t_end);

/// N equal uniform panels with hinges at their ends, folded flat. The root turns from 0 to π/2, each other hinge from 0 to
/// ±π. Loops of this stiffness (root to second hinge, each further hinge to the next) keep these at twice the root's
/// travel. Torques are 0.1 (π − x) and 0.05 (3π/2 − x). Only the root has a latch, which exerts no moment.
struct EqualPanels {
  int panels = 3;
  double mass = 10, length = 2;
  double stiffness = 1e4, damping = 0; ///< of the loops

  [[nodiscard]] Scene scene() const;
};

/// A fixed base, one panel of 3 kg·m² about its hinge in the origin (latching_panel's), from
/// `stowed` to `stowed` + 1 rad, no torque, no latch.
[[nodiscard]] Scene free_panel(double stowed = 0, double initial_rate = 0);

/// A yoke of 0.8 m and four panels of 1.8 m, folded as an accordion.
[[nodiscard]] Scene yoke_wing();
/// The same wing with a stop on every hinge.
[[nodiscard]] Scene yoke_wing_with_stops();

} // namespace wingspread::oracle
