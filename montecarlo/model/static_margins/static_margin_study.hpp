/// Static margins at every angle of the travel, of the nominal wing and of a campaign's draws.
/// Formulas: static_margin.hpp; which hinges count together: drive.hpp.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/model/static_margins/drive.hpp"

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// A campaign's draws as scenes. The caller provides them, so that this folder does not depend on campaigns or runs.
struct DrawnScenes {
  using Use = std::function<void(long run, const Scene& scene)>;
  long runs = 0; ///< of the campaign, ≥ 1
  /// Calls `use` for each physical draw, by run. Returns the number of unphysical draws. Called several times.
  std::function<long(const Use& use)> visit;
  std::function<Json(long run)> values; ///< the draws of one run, by the dispersions' names
};

/// One margin over the draws.
struct MarginSpread {
  std::vector<double> quantiles; ///< at the campaign's probabilities; NaN without draws
  double least = 0;              ///< of the worst draw; NaN without draws or if it does not apply
  long worst_run = -1;           ///< the run with the least margin; the lowest of several
  double share_short = 0;        ///< share of the draws with a margin < 0
};
using MarginSpreads = std::array<MarginSpread, margin_kind_names.size()>; ///< by MarginKind

/// One place of the travel.
struct TravelPoint {
  double x = 0;        ///< share of the leading hinge's travel: 0 stowed … 1 latched
  double angle = 0;    ///< of the nominal leading hinge, rad
  TorqueTerms nominal; ///< N·m
  Margins margins{};   ///< of the nominal wing; NaN where one does not apply
  MarginSpreads spread;
};

/// The margins of a hinge, or of hinges that loops keep together.
struct DriveMargins {
  std::string hinge; ///< "root", "root+mid"
  /// Evenly spaced places and the nominal turning points; ascending in x.
  std::vector<TravelPoint> travel;
  Margins worst{};       ///< the nominal wing's least margins over the travel; NaN: does not apply
  Margins worst_angle{}; ///< where they are: angle of the leading hinge, rad
  /// Of each draw's least margin over its own travel, in closed form (least_quotient.hpp).
  MarginSpreads worst_spread;
  std::array<Json, margin_kind_names.size()>
      worst_draw; ///< the values drawn for worst_spread's runs
};

struct StaticMarginStudy {
  std::vector<DriveMargins> drives; ///< in the scene's order
  long draws = 0;                   ///< physical draws
  long invalid = 0;                 ///< unphysical draws; they have no margins
};

/// Computes the margins of all hinges with a spring, a motor or a latch, without time integration.
/// Cost: visits the draws twice for each drive; more often if the margins of all places would take more than 256 MiB.
/// Memory: the margins held at once, or 40 bytes per draw.
/// @param nominal       the wing without dispersion
/// @param probabilities of the quantiles
[[nodiscard]] StaticMarginStudy study_static_margins(const Scene& nominal,
                                                     const StaticMarginSpec& spec,
                                                     const DrawnScenes& draws,
                                                     std::span<const double> probabilities);

} // namespace wingspread
