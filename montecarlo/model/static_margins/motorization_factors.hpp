/// The terms of a static motorization margin, and the factors that the standards put on them: what a
/// campaign gives. The formulas: motorization.hpp.
///
///   symbol  term (N·m, each ≥ 0)                                         class
///   T       what the spring gives in the deploying sense
///   I       inertial load that resists                                   fixed (known)
///   S       a spring that resists                                        fixed (known)
///   HM      a motor's magnetic losses                                    variable
///   FR      friction                                                     variable
///   HY      hysteresis                                                   variable
///   HA      harness                                                      variable
///   HD      adhesion                                                     variable
///   DA      dampers and viscous friction at a stated rate; 0 at rest     variable
///   TD      inertial torque to be delivered                              acceleration
///   TL      torque to be delivered                                       fixed (known)
///
/// ECSS has a factor f for each term (DA has friction's), a factor m on all that resists and a on what is
/// available; NASA has one for each class, FS_f, FS_v and FS_a; GEVS and AIAA for two of the classes.
#pragma once

#include <array>
#include <string_view>

namespace wingspread {

/// Symbols as above, N·m.
struct MotorizationTerms {
  double available = 0;                   ///< T
  double inertia = 0, spring = 0;         ///< I, S
  double motor = 0, friction = 0;         ///< HM, FR
  double hysteresis = 0, harness = 0;     ///< HY, HA
  double adhesion = 0;                    ///< HD
  double acceleration = 0, delivered = 0; ///< TD, TL
  double damping = 0;                     ///< DA
};

/// Factors of ECSS, as for components whose torques are computed ("theoretical").
struct EcssFactors {
  double inertia = 1.1, spring = 1.2, motor = 1.5, friction = 3, hysteresis = 3, harness = 3,
         adhesion = 3;
  double motorization = 2;    ///< m
  double acceleration = 1.25; ///< f_TD
  double available = 0.8;     ///< a
};
/// For components whose torques are measured.
[[nodiscard]] EcssFactors ecss_measured();

/// Factors of NASA, as for torques known by analysis.
struct NasaFactors {
  double fixed = 1.5, variable = 3, acceleration = 1.25;
};
[[nodiscard]] NasaFactors nasa_development_test();
[[nodiscard]] NasaFactors nasa_acceptance();     ///< flight acceptance at extremes
[[nodiscard]] NasaFactors nasa_one_spring_out(); ///< with one redundant spring lost: 1, 1, 1

/// The phase that GEVS's and AIAA's factors are of; `test` is that of acceptance or qualification.
enum class MarginPhase { preliminary_design, critical_design, test };
inline constexpr std::array<std::string_view, 3> margin_phase_names{"preliminary_design",
                                                                    "critical_design", "test"};

/// Factors of GEVS and of AIAA, as for the critical design.
struct PhaseFactors {
  double known = 1.5, variable = 3;
};
[[nodiscard]] PhaseFactors phase_factors(MarginPhase phase);

} // namespace wingspread
