/// Whether weaker springs may be advised: deployments that succeed by their momentum do not show that the
/// springs have torque to spare at rest.
///
/// Where a campaign requires static margins, they bound the window like everything else that it requires.
/// Where it requires none, springs weaker than the present ones are not advised if the nominal wing then
/// falls short of a standard (ECSS, NASA, GEVS or AIAA, with the campaign's factors) by more than it does now.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/static_margins/drive.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// A static margin that weaker springs make lower.
struct Shortfall {
  double scale = 1;
  std::string drive; ///< "root", "root+mid", "root (cold)"
  MarginKind kind = MarginKind::ecss;
  double margin = 0;  ///< the nominal wing's least over the travel, at the scale
  double present = 0; ///< and with the present springs
};

/// All static margins that are lower at a scale than with the present springs, drive by drive. Cost: no runs.
/// @param campaigns one for each case
[[nodiscard]] std::vector<Shortfall> lowered_margins(std::span<const Campaign> campaigns,
                                                     const std::vector<SceneParameter>& parameters,
                                                     double scale);

/// What speaks against the scale: the lowest of those that are below 0; nothing where there is none.
[[nodiscard]] std::optional<Shortfall> shortfall_at(std::span<const Campaign> campaigns,
                                                    const std::vector<SceneParameter>& parameters,
                                                    double scale);

/// "ECSS margin of root −0.46, now −0.28".
[[nodiscard]] std::string to_string(const Shortfall& shortfall);

} // namespace wingspread
