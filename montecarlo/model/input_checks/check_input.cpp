#include "montecarlo/model/input_checks/check_input.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/model/input_checks/bending_check.hpp"
#include "montecarlo/model/input_checks/clearance_check.hpp"
#include "montecarlo/model/input_checks/damper_check.hpp"
#include "montecarlo/model/input_checks/dispersion_checks.hpp"
#include "montecarlo/model/input_checks/extent_checks.hpp"
#include "montecarlo/model/input_checks/life_checks.hpp"
#include "montecarlo/model/input_checks/motor_checks.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"
#include "montecarlo/model/input_checks/shape_checks.hpp"
#include "montecarlo/model/input_checks/size_checks.hpp"
#include "montecarlo/model/input_checks/torque_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

void check_numbers(const Scene& scene, InputWarnings& warnings) {
  check_sizes(scene, warnings);
  check_torques(scene, warnings);
  check_extents(scene, warnings);
  check_shape(scene, warnings);
  check_bending(scene, warnings);
}

/// Deploys the nominal wing.
Outcome check_motion(const Scene& scene, const Integration& integration, InputWarnings& warnings) {
  Outcome nominal = check_clearance(scene, integration, warnings);
  check_dampers(scene, integration, nominal, warnings);
  check_life(scene, integration, nominal, warnings);
  check_motors(scene, integration, nominal, warnings);
  check_arrival(scene, nominal, warnings);
  return nominal;
}

/// The scene as written, so that warnings name the numbers of its file. It has none for a draw that acts through
/// tables: that draw is at its median.
Scene written_scene(Campaign campaign) {
  std::erase_if(campaign.dispersions, [](const Dispersion& each) { return each.through.empty(); });
  return nominal_scene(campaign);
}

/// Warns of the first number of each case that no wing has and that the nominal wing does not have either.
void check_cases(const Campaign& campaign, const InputWarnings& nominal, InputWarnings& warnings) {
  const auto is_nominal = [&](const InputWarning& warning) {
    return std::ranges::find(nominal.list(), warning.pointer, &InputWarning::pointer) !=
           nominal.list().end();
  };
  for (std::size_t k = 0; k < campaign.cases.size(); ++k) {
    InputWarnings own(nominal.place());
    check_numbers(nominal_scene(campaign_of_case(campaign, campaign.cases[k])), own);
    for (const InputWarning& warning : own.list())
      if (!is_nominal(warning))
        warnings.add(fmt::format("/cases/{}", k),
                     fmt::format("in case {}: at {} {}", campaign.cases[k].name, warning.pointer,
                                 warning.found),
                     warning.usual);
  }
}

/// ScenePlace::written of a scene.
std::map<std::string, std::size_t> written_in(const Json& scene) {
  std::map<std::string, std::size_t> written;
  if (scene.is_object() && scene.contains("mirror"))
    for (const char* key : {"bodies", "hinges", "synchronisations"})
      written[key] = scene.value(key, Json::array()).size();
  return written;
}

/// The nominal deployment with the peaks, if a requirement limits one; without, as it is, where that takes too long.
Outcome with_peaks(const Campaign& campaign, Outcome nominal) {
  const auto limits_peak = [](const Requirement& each) {
    return peak_kind(each.output) != PeakKind::none;
  };
  if (std::ranges::none_of(campaign.requirements, limits_peak)) return nominal;
  Outcome whole =
      deployment_alone(nominal_scene(campaign), campaign.integration, {}, /*peaks=*/true);
  return whole.status == Status::failed ? nominal : whole;
}

} // namespace

ScenePlace scene_place(const std::filesystem::path& file) {
  if (file.empty()) return {};
  const Json document = parse_json_file(file);
  const auto scene = document.find("scene");
  if (scene == document.end()) return {file.string(), "", written_in(document)};
  if (!scene->is_string()) return {file.string(), "/scene", written_in(*scene)};
  const auto own = file.parent_path() / scene->get<std::string>();
  return {own.string(), "", written_in(parse_json_file(own))};
}

std::vector<InputWarning> check_input(const Scene& scene, const Integration& integration,
                                      const std::filesystem::path& file) {
  InputWarnings warnings(scene_place(file));
  check_numbers(scene, warnings);
  (void)check_motion(scene, integration, warnings);
  return warnings.list();
}

std::vector<InputWarning> check_input(const Campaign& campaign, const std::filesystem::path& file,
                                      const DrawScenes& draw) {
  InputWarnings scene(scene_place(file)), rest({file.string()}), drawn({file.string()}),
      judged({file.string(), "/requirements"});
  check_numbers(written_scene(campaign), scene);
  const Outcome nominal = check_motion(nominal_scene(campaign), campaign.integration, scene);
  check_cases(campaign, scene, rest);
  check_dispersions(campaign, rest,
                    draw ? check_draws(campaign, draw, drawn) : std::set<std::string>{});
  check_spread(campaign, rest);
  check_correlations(campaign, rest);
  check_outputs(campaign, rest);
  check_requirements(campaign, with_peaks(campaign, nominal), judged);
  std::vector<InputWarning> all = scene.list();
  for (const InputWarnings* more : {&rest, &drawn, &judged})
    all.insert(all.end(), more->list().begin(), more->list().end());
  return all;
}

std::vector<InputWarning> check_requirements_file(const Campaign& campaign,
                                                  const std::filesystem::path& file) {
  std::string place;
  for (const std::string& key : keys_of_requirements(parse_json_file(file))) place += "/" + key;
  InputWarnings warnings({file.string(), place});
  const Outcome nominal = deployment_alone(nominal_scene(campaign), campaign.integration);
  check_requirements(campaign, with_peaks(campaign, nominal), warnings);
  return warnings.list();
}

} // namespace wingspread
