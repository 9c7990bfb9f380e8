/// The campaign of a designed wing, line by line.
#pragma once

#include "montecarlo/model/starter/annotated_json.hpp"
#include "montecarlo/model/starter/wing_design.hpp"

#include <vector>

namespace wingspread {

/// Limits of the campaign's requirements, found from the nominal wings of all cases.
struct StarterLimits {
  double t_end = 0;           ///< s
  double deployment_time = 0; ///< s
  std::vector<double> moment; ///< of each wing's root, N·m
  bool placeholders = false;  ///< of a wing that does not deploy
};

/// @param scene_file name of the scene's file, beside the campaign
[[nodiscard]] AnnotatedLines starter_campaign(const WingDesign& design,
                                              const std::string& scene_file,
                                              const StarterLimits& limits);

/// Twice the longest deployment and three times the largest moments of the nominal wing in the campaign's cases,
/// rounded up to two digits. Nothing if a nominal wing does not deploy.
[[nodiscard]] std::optional<StarterLimits> starter_limits(const WingDesign& design);

} // namespace wingspread
