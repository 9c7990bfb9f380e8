/// Static motorization margins: by how much the torque that is available exceeds what resists, with the
/// standards' factors on every term. Symbols and factors: motorization_factors.hpp; the terms of hinges
/// and loops: drive.hpp.
///
///   ECSS:              T_min = m (f_I I + f_S S + f_HM HM + f_FR (FR + DA) + f_HY HY + f_HA HA + f_HD HD)
///                              + f_TD TD + TL,     margin = a T / T_min − 1 (1)
///   NASA:              margin = T / (FS_f ΣT_f + FS_v ΣT_v + FS_a ΣT_a) − 1 (2)
///   GEVS, AIAA:        margin = T / (FS_k ΣT_f + FS_v ΣT_v) − 1 (3)
///
/// with m = 2, a = 0.8 for springs; the static margin of (2) leaves T_a out. All have to be ≥ 0.
#pragma once

#include "montecarlo/model/static_margins/motorization_spec.hpp"

#include <array>
#include <string_view>

namespace wingspread {

/// With the editions that the factors are of. ECSS's has been revised since (Rev.2 of 1 March 2019).
inline constexpr std::string_view ecss_standard = "ECSS-E-ST-33-01C (6 March 2009)";
inline constexpr std::string_view nasa_standard = "NASA-STD-5017B (6 December 2022)";
inline constexpr std::string_view gevs_standard = "GSFC-STD-7000A (22 April 2013)";
inline constexpr std::string_view aiaa_standard = "AIAA S-114-2005";

/// T_min of (1).
[[nodiscard]] double ecss_required(const MotorizationTerms& terms, const EcssFactors& factors);
/// (1). +∞ where nothing resists a spring; −1 where there is no torque at all.
[[nodiscard]] double ecss_margin(const MotorizationTerms& terms, const EcssFactors& factors);
/// (2) without T_a; the special values of ecss_margin.
[[nodiscard]] double nasa_static_margin(const MotorizationTerms& terms, const NasaFactors& factors);
/// (2) in full.
[[nodiscard]] double nasa_dynamic_margin(const MotorizationTerms& terms,
                                         const NasaFactors& factors);
/// (3); the special values of ecss_margin.
[[nodiscard]] double phase_margin(const MotorizationTerms& terms, const PhaseFactors& factors);

/// A margin by ECSS, by NASA, by NASA with one of the hinge's springs lost, by GEVS and by AIAA.
enum class MarginKind { ecss, nasa, nasa_one_spring_out, gevs, aiaa };
inline constexpr std::array<std::string_view, 5> margin_kind_names{
    "ecss", "nasa", "nasa_one_spring_out", "gevs", "aiaa"};
/// As people write them.
inline constexpr std::array<std::string_view, 5> margin_kind_texts{
    "ECSS", "NASA", "NASA, one spring out", "GEVS", "AIAA"};
/// One of each kind, in their order. ≥ 0 is enough; +∞ where nothing resists.
using Margins = std::array<double, margin_kind_names.size()>;

/// The margins of a hinge's terms.
[[nodiscard]] Margins margins_of(const MotorizationTerms& terms, const MotorizationSpec& spec);

} // namespace wingspread
