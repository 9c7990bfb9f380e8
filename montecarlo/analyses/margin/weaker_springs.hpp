/// Static margins of weaker springs. Successful runs alone do not justify weaker springs: a wing may deploy by momentum
/// although its springs could not move it from rest everywhere.
///
/// If the campaign requires static margins, these bound the window like every requirement. If not, weaker springs are
/// ruled out if they lower a static margin of the nominal wing to below 0. The margins are those of ECSS, NASA, GEVS
/// and AIAA, with the campaign's factors.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/static_margins/drive.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// A static margin that is lower at a scale than with the present springs.
struct Shortfall {
  double scale = 1;
  std::string drive; ///< "root", "root+mid", "root (cold)"
  MarginKind kind = MarginKind::ecss;
  double margin = 0;  ///< least over the travel of the nominal wing, at the scale
  double present = 0; ///< the same with the present springs
};

/// All static margins that are lower at a scale than with the present springs, drive by drive. Makes no runs.
/// @param campaigns one per case
[[nodiscard]] std::vector<Shortfall> lowered_margins(std::span<const Campaign> campaigns,
                                                     const std::vector<SceneParameter>& parameters,
                                                     double scale);

/// The lowest static margin that rules the scale out: below 0, and lower than with the present springs. Nothing if
/// there is none, or if the scale is at least 1.
[[nodiscard]] std::optional<Shortfall> shortfall_at(std::span<const Campaign> campaigns,
                                                    const std::vector<SceneParameter>& parameters,
                                                    double scale);

/// For each standard the lowest static margin below 0 of the nominal wing at a scale, over all cases and drives.
/// @param campaigns one per case
[[nodiscard]] std::vector<Shortfall> short_margins(std::span<const Campaign> campaigns,
                                                   const std::vector<SceneParameter>& parameters,
                                                   double scale);

/// "ECSS margin of root −0.46, now −0.28".
[[nodiscard]] std::string to_string(const Shortfall& shortfall);

} // namespace wingspread
