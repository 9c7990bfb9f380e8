/// The torque terms of a static margin, and the factors of the standards. The formulas: static_margin.hpp.
///
///   symbol  term (N·m, each ≥ 0)                                         class
///   T       the torque of spring and motor, in the deploying sense
///   I       inertial load that resists                                   fixed (known)
///   S       spring or motor that resists                                 fixed (known)
///   HM      a motor's magnetic losses                                    variable
///   FR      friction                                                     variable
///   HY      hysteresis                                                   variable
///   HA      harness                                                      variable
///   HD      adhesion                                                     variable
///   DA      dampers and viscous friction at a stated rate; 0 at rest     variable
///   TD      inertial torque to be delivered                              acceleration
///   TL      torque to be delivered                                       fixed (known)
///
/// ECSS has a factor f for each term (DA: friction's), m for the sum of the resisting terms and a for the available
/// torque. NASA has one factor for each class: FS_f, FS_v and FS_a. GEVS and AIAA have factors for two classes.
#pragma once

#include <array>
#include <string_view>

namespace wingspread {

/// Symbols as above, N·m.
struct TorqueTerms {
  double available = 0;                   ///< T
  double inertia = 0, spring = 0;         ///< I, S
  double motor = 0, friction = 0;         ///< HM, FR
  double hysteresis = 0, harness = 0;     ///< HY, HA
  double adhesion = 0;                    ///< HD
  double acceleration = 0, delivered = 0; ///< TD, TL
  double damping = 0;                     ///< DA
};

/// ECSS's factors; the defaults are those for computed torques ("theoretical").
struct EcssFactors {
  double inertia = 1.1, spring = 1.2, motor = 1.5, friction = 3, hysteresis = 3, harness = 3,
         adhesion = 3;
  double motorization = 2;    ///< m
  double acceleration = 1.25; ///< f_TD
  double available = 0.8;     ///< a
};
/// For measured torques.
[[nodiscard]] EcssFactors ecss_measured();

/// NASA's factors; the defaults are those for torques known by analysis.
struct NasaFactors {
  double fixed = 1.5, variable = 3, acceleration = 1.25;
};
[[nodiscard]] NasaFactors nasa_development_test();
[[nodiscard]] NasaFactors nasa_acceptance();     ///< flight acceptance at extremes
[[nodiscard]] NasaFactors nasa_one_spring_out(); ///< with one redundant spring lost: 1, 1, 1

/// The project phase of GEVS's and AIAA's factors; `test`: acceptance or qualification test.
enum class MarginPhase { preliminary_design, critical_design, test };
inline constexpr std::array<std::string_view, 3> margin_phase_names{"preliminary_design",
                                                                    "critical_design", "test"};

/// The factors of GEVS and AIAA; the defaults are those for the critical design.
struct PhaseFactors {
  double known = 1.5, variable = 3;
};
[[nodiscard]] PhaseFactors phase_factors(MarginPhase phase);

} // namespace wingspread
