/// The files of `wingspread new`: a scene, a campaign, and a page that explains each line.
#pragma once

#include "montecarlo/model/starter/wing_design.hpp"

#include <string>

namespace wingspread {

inline constexpr const char* starter_scene_file = "scene.json";
inline constexpr const char* starter_campaign_file = "campaign.json";
inline constexpr const char* starter_page_file = "README.md";

struct Starter {
  std::string scene, campaign, page; ///< the texts of the three files
  bool deploys = false;              ///< whether the nominal wing deploys in every case
};

/// The same design gives the same bytes. Runs the nominal wing of each case, for the requirements' limits; a wing that
/// does not deploy gets limits of 60 s and 1 N·m.
/// @param command with which the files can be made again, for the page
/// @throws SpecError as check_design()
[[nodiscard]] Starter make_starter(WingDesign design, const std::string& command);

} // namespace wingspread
