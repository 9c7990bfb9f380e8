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
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

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

/// What is found in one wing. Warnings of its scene name the scene's file.
struct WingWarnings {
  std::vector<InputWarning> scene, laws, judged;
};

/// A wing of a campaign: that of a case, or of none.
struct CheckedWing {
  Campaign campaign;
  const CaseSpec* spec = nullptr; ///< null: no case
  std::string place{};            ///< pointer of the case
  bool is_made = false;           ///< else it is checked only to compare with
  bool deploys = false;           ///< the nominal wing; false before it is judged
  bool is_judged = false;
  WingWarnings found{};
};

/// The wing in no case, and then the cases.
std::vector<CheckedWing> wings_of(const Campaign& campaign, std::span<const std::string> names) {
  const auto is_named = [&](const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  std::vector<CheckedWing> wings;
  wings.push_back(
      {.campaign = campaign, .is_made = names.empty() ? campaign.cases.empty() : is_named("")});
  wings.front().campaign.cases.clear();
  for (std::size_t k = 0; k < campaign.cases.size(); ++k)
    wings.push_back({.campaign = campaign_of_case(campaign, campaign.cases[k]),
                     .spec = &campaign.cases[k],
                     .place = fmt::format("/cases/{}", k),
                     .is_made = names.empty() || is_named(campaign.cases[k].name)});
  return wings;
}

/// The scene as written, so that warnings name the numbers of its file. It has none for a draw that acts through tables or
/// by a case's law: that draw is at its median.
Scene written_scene(const Campaign& whole, const CheckedWing& wing) {
  Campaign campaign = wing.campaign;
  const auto is_written = [&](const Dispersion& each) {
    const auto draws = [&](const CaseDistribution& own) {
      return is_drawn_by(whole, own.dispersion, each);
    };
    return each.through.empty() &&
           (!wing.spec || std::ranges::none_of(wing.spec->distributions, draws));
  };
  std::erase_if(campaign.dispersions, is_written);
  return nominal_scene(campaign);
}

/// Checks the requirements. @param place of their list
void judge(CheckedWing& wing, const Outcome& nominal, const ScenePlace& place) {
  InputWarnings warnings(place);
  check_requirements(wing.campaign, with_peaks(wing.campaign, nominal), warnings);
  wing.found.judged = warnings.list();
  wing.deploys = nominal.status == Status::deployed, wing.is_judged = true;
}
void judge(CheckedWing& wing, const ScenePlace& place) {
  judge(wing, deployment_alone(nominal_scene(wing.campaign), wing.campaign.integration), place);
}

/// @param negative paths of which drawing has found unphysical values
void check_wing(const Campaign& whole, CheckedWing& wing, const ScenePlace& place,
                const std::filesystem::path& file, const std::set<std::string>& negative) {
  const Campaign& campaign = wing.campaign;
  InputWarnings scene(place), laws({file.string()});
  check_numbers(written_scene(whole, wing), scene);
  const Outcome nominal = check_motion(nominal_scene(campaign), campaign.integration, scene);
  check_dispersions(whole, campaign, laws, negative);
  check_correlated_laws(campaign, laws);
  wing.found.scene = scene.list(), wing.found.laws = laws.list();
  judge(wing, nominal, {file.string(), "/requirements"});
}

/// Drops the warnings of limits that suit a case, made or not: a limit is one for all, and other cases may be far from it.
void drop_suited(std::vector<CheckedWing>& wings, const ScenePlace& place) {
  std::set<std::string> limits, suited;
  for (const CheckedWing& wing : wings)
    for (const InputWarning& each : wing.found.judged)
      if (wing.is_made && (each.pointer.ends_with("/max") || each.pointer.ends_with("/min")))
        limits.insert(each.pointer);
  if (limits.empty()) return;
  for (CheckedWing& wing : wings) {
    if (!wing.spec && !wing.is_made) continue;
    if (!wing.is_judged) judge(wing, place);
    if (!wing.deploys) continue;
    for (const std::string& limit : limits)
      if (std::ranges::find(wing.found.judged, limit, &InputWarning::pointer) ==
          wing.found.judged.end())
        suited.insert(limit);
  }
  for (CheckedWing& wing : wings)
    std::erase_if(wing.found.judged,
                  [&](const InputWarning& each) { return suited.contains(each.pointer); });
}

/// A warning, and the cases that have it.
struct OfCases {
  InputWarning warning;
  std::vector<const CheckedWing*> wings;
};

/// The warning with the names of its cases. @param of_scene whether it moves from the scene's file to the first case
InputWarning with_cases(const OfCases& all, bool of_scene, const std::filesystem::path& file) {
  InputWarning warning = all.warning;
  if (warning.pointer.starts_with("/cases/")) return warning;
  std::vector<std::string> names;
  for (const CheckedWing* wing : all.wings) names.push_back(wing->spec->name);
  if (of_scene) {
    warning.found = fmt::format("at {} {}", warning.pointer, warning.found);
    warning.pointer = all.wings.front()->place, warning.file = file.string();
  }
  warning.found = fmt::format("in case{} {}: {}", names.size() == 1 ? "" : "s",
                              fmt::join(names, ", "), warning.found);
  return warning;
}

/// The warnings of all wings together: those that the wing in no case has too, and one for each place of the others, in
/// the words of the first case.
std::vector<InputWarning> merged(std::span<const CheckedWing> wings,
                                 std::vector<InputWarning> WingWarnings::*part,
                                 const std::filesystem::path& file) {
  const auto has = [](const std::vector<InputWarning>& all, const InputWarning& one) {
    return std::ranges::find(all, one) != all.end();
  };
  const std::vector<InputWarning>& base = wings.front().found.*part;
  std::vector<InputWarning> all;
  for (const InputWarning& each : base)
    if (std::ranges::any_of(wings, [&](const CheckedWing& wing) {
          return wing.is_made && has(wing.found.*part, each);
        }))
      all.push_back(each);
  std::vector<OfCases> others;
  for (const CheckedWing& wing : wings.subspan(1))
    for (const InputWarning& each : wing.found.*part) {
      if (!wing.is_made || has(base, each)) continue;
      const auto same = std::ranges::find_if(others, [&](const OfCases& other) {
        return other.warning.file == each.file && other.warning.pointer == each.pointer;
      });
      if (same != others.end())
        same->wings.push_back(&wing);
      else
        others.push_back({each, {&wing}});
    }
  for (const OfCases& each : others)
    all.push_back(with_cases(each, part == &WingWarnings::scene, file));
  return all;
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

std::vector<std::string> all_wings(const Campaign& campaign) {
  std::vector<std::string> names{""};
  for (const CaseSpec& spec : campaign.cases) names.push_back(spec.name);
  return names;
}

std::vector<InputWarning> check_input(const Campaign& campaign, const std::filesystem::path& file,
                                      const DrawScenes& draw, std::span<const std::string> names) {
  std::vector<CheckedWing> wings = wings_of(campaign, names);
  InputWarnings rest({file.string()}), drawn({file.string()});
  std::vector<Campaign> made;
  std::vector<CaseSpec> cases;
  for (const CheckedWing& wing : wings)
    if (wing.is_made) {
      made.push_back(wing.campaign);
      if (wing.spec) cases.push_back(*wing.spec);
    }
  std::map<std::string, std::set<std::string>> negative;
  if (draw) negative = check_draws(campaign, made, draw, drawn);
  const ScenePlace place = scene_place(file);
  for (CheckedWing& wing : wings)
    if (wing.is_made || !wing.spec)
      check_wing(campaign, wing, place, file, negative[wing.campaign.of_case]);
  drop_suited(wings, {file.string(), "/requirements"});
  check_spread(cases.empty() ? wings.front().campaign : campaign, cases, rest);
  check_correlations(campaign, rest);
  check_outputs(campaign, rest);
  std::vector<InputWarning> all;
  for (const std::vector<InputWarning>& more :
       {merged(wings, &WingWarnings::scene, file), merged(wings, &WingWarnings::laws, file),
        rest.list(), drawn.list(), merged(wings, &WingWarnings::judged, file)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::vector<InputWarning> check_requirements_file(const Campaign& campaign,
                                                  const std::filesystem::path& file) {
  std::string place;
  for (const std::string& key : keys_of_requirements(parse_json_file(file))) place += "/" + key;
  std::vector<CheckedWing> wings = wings_of(campaign, {});
  for (CheckedWing& wing : wings) judge(wing, {file.string(), place});
  drop_suited(wings, {file.string(), place});
  return merged(wings, &WingWarnings::judged, file);
}

} // namespace wingspread
