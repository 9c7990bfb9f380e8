#include "montecarlo/model/input_checks/examine.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/dispersion_notices.hpp"
#include "montecarlo/model/input_checks/shape_notices.hpp"
#include "montecarlo/model/input_checks/size_notices.hpp"
#include "montecarlo/model/input_checks/torque_notices.hpp"
#include "montecarlo/model/input_checks/way_notices.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

/// @return the nominal deployment
Outcome examine_scene(const Scene& scene, const Integration& integration, Notices& notices) {
  notice_sizes(scene, notices);
  notice_torques(scene, notices);
  notice_shape(scene, notices);
  return notice_way(scene, integration, notices);
}

/// Of the torques in each case, the first that the nominal wing does not have.
void examine_cases(const Campaign& campaign, const Notices& nominal, Notices& notices) {
  const auto is_nominal = [&](const Notice& notice) {
    return std::ranges::find(nominal.list(), notice.pointer, &Notice::pointer) !=
           nominal.list().end();
  };
  for (std::size_t k = 0; k < campaign.cases.size(); ++k) {
    Notices own(nominal.place());
    notice_torques(nominal_scene(campaign_of_case(campaign, campaign.cases[k])), own);
    for (const Notice& notice : own.list())
      if (!is_nominal(notice))
        notices.add(fmt::format("/cases/{}", k),
                    fmt::format("in case {}: at {} {}", campaign.cases[k].name, notice.pointer,
                                notice.found),
                    notice.usual);
  }
}

} // namespace

ScenePlace scene_place(const std::filesystem::path& file) {
  if (file.empty()) return {};
  const Json document = parse_json_file(file);
  const auto scene = document.find("scene");
  if (scene == document.end()) return {file.string()};
  if (!scene->is_string()) return {file.string(), "/scene"};
  return {(file.parent_path() / scene->get<std::string>()).string()};
}

std::vector<Notice> examine(const Scene& scene, const Integration& integration,
                            const std::filesystem::path& file) {
  Notices notices(scene_place(file));
  (void)examine_scene(scene, integration, notices);
  return notices.list();
}

std::vector<Notice> examine(const Campaign& campaign, const std::filesystem::path& file) {
  Notices scene(scene_place(file)), rest({file.string()});
  const Outcome nominal = examine_scene(nominal_scene(campaign), campaign.integration, scene);
  examine_cases(campaign, scene, rest);
  notice_dispersions(campaign, rest);
  notice_correlations(campaign, rest);
  notice_requirements(campaign, nominal, rest);
  std::vector<Notice> all = scene.list();
  all.insert(all.end(), rest.list().begin(), rest.list().end());
  return all;
}

} // namespace wingspread
