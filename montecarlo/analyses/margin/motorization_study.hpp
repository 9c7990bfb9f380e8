/// The static motorization margins of all that drives the wing, at every angle of the travel: of the
/// nominal wing and of the draws of a campaign. Formulas: motorization.hpp; hinges and loops: drive.hpp.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/static_margins/drive.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// A margin over the draws.
struct MarginSpread {
  std::vector<double> quantiles; ///< at the campaign's probabilities; NaN without draws
  double least = 0;              ///< the worst draw's; NaN without draws
  long worst_run = -1;           ///< the run that has it, the first of equals
  double share_short = 0;        ///< of the draws, those with a margin < 0
};

/// A place of the travel.
struct TravelPoint {
  double x = 0;              ///< 0 stowed … 1 latched, of the leading hinge
  double angle = 0;          ///< nominal, rad
  MotorizationTerms nominal; ///< N·m
  Margins margins{};         ///< of the nominal wing
  std::array<MarginSpread, margin_kind_names.size()> spread;
};

/// Of a hinge, or of hinges that loops keep together.
struct DriveMotorization {
  HingeDrive drive;
  /// Evenly over the travel, and the nominal turning points: ascending in x.
  std::vector<TravelPoint> travel;
  std::array<double, margin_kind_names.size()> worst_at{}; ///< x of the nominal wing's least
  Margins worst{};                                         ///< nominal, over the travel
  /// Of every draw's least over its own travel, which is found exactly.
  std::array<MarginSpread, margin_kind_names.size()> worst_spread;
};

struct MotorizationStudy {
  std::vector<DriveMotorization> drives; ///< in the scene's order
  long draws = 0;                        ///< that are physical
  long invalid = 0;                      ///< and that are not: left out, for they have no margins
};

/// @param nominal the wing without dispersion (the campaign's scene, or with other springs)
/// Cost: the campaign's draws twice for each of the drives, more often where margins at all places would take more
/// than 256 MiB; no integration. Memory: that, or 40 bytes a draw.
[[nodiscard]] MotorizationStudy study_motorization(const Campaign& campaign, const Scene& nominal);

} // namespace wingspread
