/// Static margins (ECSS: motorization margins): the available torque over the factored resisting torque, less 1.
/// Symbols and factors: torque_factors.hpp; the terms of hinges and loops: drive.hpp.
///
///   ECSS:              T_min = m (f_I I + f_S S + f_HM HM + f_FR (FR + DA) + f_HY HY + f_HA HA + f_HD HD)
///                              + f_TD TD + TL,     margin = a T / T_min − 1 (1)
///   NASA:              margin = T / (FS_f ΣT_f + FS_v ΣT_v + FS_a ΣT_a) − 1 (2)
///   GEVS, AIAA:        margin = T / (FS_k ΣT_f + FS_v ΣT_v) − 1 (3)
///   one spring out:    (2) without T_a, with T − T_s / m_s for T and all factors 1 (4)
///
/// with T_s the largest part of T from one hinge's spring, and m_s equal springs per hinge: of all hinges that loops
/// couple, one loses one spring, namely the hinge whose loss costs most. A motor's torque stays.
/// with m = 2, a = 0.8 for springs; the static margin of (2) omits T_a. A standard is met by a margin ≥ 0.
#pragma once

#include "montecarlo/model/static_margins/static_margin_spec.hpp"

#include <array>
#include <string>
#include <string_view>

namespace wingspread {

/// The editions of the standards from which the factors are taken. ECSS-E-ST-33-01C has a later revision (Rev.2 of 1
/// March 2019).
inline constexpr std::string_view ecss_standard = "ECSS-E-ST-33-01C (6 March 2009)";
inline constexpr std::string_view nasa_standard = "NASA-STD-5017B (6 December 2022)";
inline constexpr std::string_view gevs_standard = "GSFC-STD-7000A (22 April 2013)";
inline constexpr std::string_view aiaa_standard = "AIAA S-114-2005";

/// T_min of (1).
[[nodiscard]] double ecss_required(const TorqueTerms& terms, const EcssFactors& factors);
/// (1). +∞ if nothing resists the spring; −1 without any torque.
[[nodiscard]] double ecss_margin(const TorqueTerms& terms, const EcssFactors& factors);
/// (2) without T_a. Special values as in ecss_margin.
[[nodiscard]] double nasa_static_margin(const TorqueTerms& terms, const NasaFactors& factors);
/// (2) in full.
[[nodiscard]] double nasa_dynamic_margin(const TorqueTerms& terms, const NasaFactors& factors);
/// (3). Special values as in ecss_margin.
[[nodiscard]] double phase_margin(const TorqueTerms& terms, const PhaseFactors& factors);

/// The standards' margins; NASA's also with one spring lost.
enum class MarginKind { ecss, nasa, nasa_one_spring_out, gevs, aiaa };
inline constexpr std::array<std::string_view, 5> margin_kind_names{
    "ecss", "nasa", "nasa_one_spring_out", "gevs", "aiaa"};
/// The names in tables and messages, by MarginKind.
inline constexpr std::array<std::string_view, 5> margin_kind_texts{
    "ECSS", "NASA", "NASA, one spring out", "GEVS", "AIAA"};
/// By MarginKind.
using Margins = std::array<double, margin_kind_names.size()>;

/// The formula of a margin with its factors, "T / (1.35 ΣT_fixed + 2.5 ΣT_variable) − 1".
[[nodiscard]] std::string formula_of(MarginKind kind, const StaticMarginSpec& spec);

/// The available torque and the torque that a standard asks for, N·m: the margin is their quotient, less 1.
struct TorqueQuotient {
  double available = 0, required = 0; ///< both linear in the terms
};
/// By MarginKind. @param largest_spring T_s of (4), N·m
[[nodiscard]] std::array<TorqueQuotient, margin_kind_names.size()>
torque_quotients(const TorqueTerms& terms, double largest_spring, const StaticMarginSpec& spec);

/// The margins by all standards. With one spring out also for a drive without springs: see `applies` in drive.hpp.
/// @param largest_spring T_s of (4), N·m
[[nodiscard]] Margins margins_of(const TorqueTerms& terms, double largest_spring,
                                 const StaticMarginSpec& spec);

} // namespace wingspread
