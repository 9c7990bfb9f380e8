/// Static motorization margins of a hinge: by how much its spring's torque exceeds what resists,
/// with the standards' factors on every term. Kinetic energy and viscous terms are not counted.
///
///   symbol  term (N·m, each ≥ 0)                                         NASA's class
///   T       what the spring gives in the deploying sense
///   I       inertial load that resists                                   fixed
///   S       a spring that resists                                        fixed
///   HM      a motor's magnetic losses                                    variable
///   FR      friction                                                     variable
///   HY      hysteresis                                                   variable
///   HA      harness                                                      variable
///   HD      adhesion                                                     variable
///   TD      inertial torque to be delivered                              acceleration
///   TL      torque to be delivered                                       fixed
///
///   ECSS-E-ST-33-01C:  T_min = m (f_I I + f_S S + f_HM HM + f_FR FR + f_HY HY + f_HA HA + f_HD HD)
///                              + f_TD TD + TL,     margin = a T / T_min − 1                  (1)
///   NASA-STD-5017B:    margin = T / (FS_f ΣT_f + FS_v ΣT_v + FS_a ΣT_a) − 1                 (2)
///
/// with m = 2, a = 0.8 for springs; the static margin of (2) leaves T_a out. Both have to be ≥ 0.
///
/// Every term is linear in the travel x but where a torque changes its sense, and (1) and (2) are
/// quotients of them: between such places they are monotone, so the worst is at one of them or at
/// an end, and is found exactly.
#pragma once

#include "core/scene/scene.hpp"

#include <string_view>
#include <vector>

namespace wingspread {

inline constexpr std::string_view ecss_standard = "ECSS-E-ST-33-01C";
inline constexpr std::string_view nasa_standard = "NASA-STD-5017B";

/// Symbols as above, N·m.
struct MotorizationTerms {
  double available = 0;                   ///< T
  double inertia = 0, spring = 0;         ///< I, S
  double motor = 0, friction = 0;         ///< HM, FR
  double hysteresis = 0, harness = 0;     ///< HY, HA
  double adhesion = 0;                    ///< HD
  double acceleration = 0, delivered = 0; ///< TD, TL
};

/// Factors of (1), as for components whose torques are computed ("theoretical").
struct EcssFactors {
  double inertia = 1.1, spring = 1.2, motor = 1.5, friction = 3, hysteresis = 3, harness = 3,
         adhesion = 3;
  double motorization = 2;    ///< m
  double acceleration = 1.25; ///< f_TD
  double available = 0.8;     ///< a
};
/// For components whose torques are measured.
[[nodiscard]] EcssFactors ecss_measured();

/// Factors of (2), as for torques known by analysis.
struct NasaFactors {
  double fixed = 1.5, variable = 3, acceleration = 1.25;
};
[[nodiscard]] NasaFactors nasa_development_test();
[[nodiscard]] NasaFactors nasa_acceptance();     ///< flight acceptance at extremes
[[nodiscard]] NasaFactors nasa_one_spring_out(); ///< with one redundant spring lost: 1, 1, 1

/// T_min of (1).
[[nodiscard]] double ecss_required(const MotorizationTerms& terms, const EcssFactors& factors);
/// (1). +∞ where nothing resists a spring; −1 where there is no torque at all.
[[nodiscard]] double ecss_margin(const MotorizationTerms& terms, const EcssFactors& factors);
/// (2) without T_a; the special values of ecss_margin.
[[nodiscard]] double nasa_static_margin(const MotorizationTerms& terms, const NasaFactors& factors);
/// (2) in full.
[[nodiscard]] double nasa_dynamic_margin(const MotorizationTerms& terms,
                                         const NasaFactors& factors);

/// The hinge's terms at x of its travel, 0 stowed … 1 latched, on top of `other` that the scene
/// does not know. A torque that changes its sense changes its side: a spring that pulls back is S.
/// A harness that helps is not counted on. FR is the level that holds at rest: `static` of the
/// exact friction, else `coulomb`.
[[nodiscard]] MotorizationTerms terms_at(const Hinge& hinge, double x,
                                         const MotorizationTerms& other = {});

/// Where the margins may have their least: both ends of the travel, and where spring or harness
/// changes its sense; ascending.
[[nodiscard]] std::vector<double> turning_points(const Hinge& hinge);

} // namespace wingspread
