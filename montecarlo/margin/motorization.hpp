/// Static motorization margins of a hinge: by how much its spring's torque exceeds what resists,
/// with the standards' factors on every term. Kinetic energy, dampers and other terms of rates are not counted,
/// nor what loops, stops, gravity and air do. A torque test both ways has its friction among the friction.
/// Symbols and factors: motorization_factors.hpp.
///
///   ECSS:              T_min = m (f_I I + f_S S + f_HM HM + f_FR FR + f_HY HY + f_HA HA + f_HD HD)
///                              + f_TD TD + TL,     margin = a T / T_min − 1 (1)
///   NASA:              margin = T / (FS_f ΣT_f + FS_v ΣT_v + FS_a ΣT_a) − 1 (2)
///
/// with m = 2, a = 0.8 for springs; the static margin of (2) leaves T_a out. Both have to be ≥ 0.
///
/// Every term is linear in the travel x but where a torque changes its sense, and (1) and (2) are
/// quotients of them: between such places they are monotone, so the worst is at one of them or at
/// an end, and is found exactly. A table's margins are looked at in eight parts of each of its pieces.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/campaign/motorization_factors.hpp"

#include <string_view>
#include <vector>

namespace wingspread {

/// With the editions that the factors are of. ECSS's has been revised since (Rev.2 of 1 March 2019).
inline constexpr std::string_view ecss_standard = "ECSS-E-ST-33-01C (6 March 2009)";
inline constexpr std::string_view nasa_standard = "NASA-STD-5017B (6 December 2022)";

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
/// exact friction, else `coulomb`, and what a torque test both ways adds.
[[nodiscard]] MotorizationTerms terms_at(const Hinge& hinge, double x,
                                         const MotorizationTerms& other = {});

/// Both ends of the travel, and where spring or harness changes its sense; ascending.
[[nodiscard]] std::vector<double> turning_points(const Hinge& hinge);

/// Where the margins may have their least: the turning points, and places along every table; ascending.
[[nodiscard]] std::vector<double> places_of_least(const Hinge& hinge);

} // namespace wingspread
