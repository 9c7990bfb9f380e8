/// What the static motorization margins come to: as JSON, as CSV, and as text for a terminal.
#pragma once

#include "montecarlo/analyses/margin/motorization_study.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// The static margins of a case's wing with the springs at a scale.
struct ScaledMotorization {
  double scale;
  Campaign campaign; ///< the case's, with its present springs
  MotorizationStudy study;
};

/// The least margins over the travel, with the draws that have the worst.
[[nodiscard]] Json motorization_json(const Campaign& campaign,
                                     const std::vector<ScaledMotorization>& scales);

/// A row for each scale, case, hinge and place of the travel: terms, margins, their quantiles over the
/// draws and the worst draw.
[[nodiscard]] std::string motorization_csv(const Campaign& campaign,
                                           const std::vector<ScaledMotorization>& scales);

/// The least margins over the travel, a line for each hinge and kind.
[[nodiscard]] std::string motorization_text(const Campaign& campaign,
                                            const std::vector<ScaledMotorization>& scales);

} // namespace wingspread
