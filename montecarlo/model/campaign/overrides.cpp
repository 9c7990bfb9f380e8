#include "montecarlo/model/campaign/overrides.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/margin_spec.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace wingspread {
namespace {

/// "/t_end" → "--t-end"; also for deeper pointers ("/t_end/0").
std::string option_of(std::string_view pointer) {
  const std::string_view key = pointer.substr(std::min<std::size_t>(1, pointer.size()));
  std::string option = "--" + std::string(key.substr(0, key.find('/')));
  std::ranges::replace(option, '_', '-');
  return option;
}

/// The last '=': a name in the path may have one, a value has none.
std::size_t equals_in(const std::string& change) {
  return std::min(change.rfind('='), change.size());
}

std::string path_in(const std::string& change) { return change.substr(0, equals_in(change)); }

/// Refuses changes that a dispersion would overwrite.
void refuse_lost(const Campaign& campaign, const std::vector<std::string>& changes) {
  const auto writers = set_by_draws(campaign.dispersions);
  std::vector<Problem> problems;
  for (const std::string& change : changes)
    for (const ParameterMatch& match : resolve(campaign.scene, path_in(change)).matches)
      if (const auto found = writers.find(match.parameter); found != writers.end())
        problems.push_back({"", "--set " + path_in(change),
                            fmt::format("a change of {}, which \"{}\" sets in every run",
                                        path_of(campaign.scene, match.parameter), found->second),
                            "a parameter that no dispersion sets"});
  if (!problems.empty()) throw SpecError(std::move(problems));
}

} // namespace

void override_settings(const Json& given, const std::function<void(const JsonCursor&)>& read) {
  std::vector<Problem> problems;
  read(JsonCursor(given, "", problems));
  for (Problem& problem : problems) problem.pointer = option_of(problem.pointer);
  if (!problems.empty()) throw SpecError(std::move(problems));
}

Scene changed_scene(Scene scene, const std::vector<std::string>& changes) {
  std::vector<Problem> problems;
  std::vector<CaseChange> read;
  std::map<std::string, std::string> written; // the values as given, by path
  for (const std::string& change : changes) {
    const std::size_t equals = equals_in(change);
    const std::string path = path_in(change);
    const std::string text = change.substr(std::min(equals + 1, change.size()));
    const auto number = parse_number<double>(text);
    const Json value = number ? Json(*number) : Json(text);
    std::vector<Problem> its;
    if (equals == change.size())
      its.push_back({"", "", fmt::format("\"{}\"", change), "PATH=VALUE"});
    else
      read_change(JsonCursor(value, "", its), path, Apply::set, scene, read);
    for (std::size_t k = written.size(); k < read.size(); ++k)
      written.emplace(path_of(scene, read[k].target), text);
    for (Problem& problem : its)
      problems.push_back({"", "--set " + path, problem.found, problem.expected});
  }
  if (problems.empty()) make_changes(read, scene);
  for (const Fault& fault : unphysical(scene)) {
    const std::string& found = written.contains(fault.path) ? written[fault.path] : fault.found;
    problems.push_back({"", "--set", fmt::format("{} of {}", fault.path, found), fault.expected});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
  return scene;
}

void change_scene(Campaign& campaign, const std::vector<std::string>& changes) {
  if (changes.empty()) return;
  refuse_lost(campaign, changes);
  campaign = with_scene(campaign, changed_scene(campaign.scene, changes));
}

namespace {

/// Whether one of the paths is of a spring's torque.
bool scales_spring(const Scene& scene, const std::vector<std::string>& paths) {
  return std::ranges::any_of(paths, [&](const std::string& path) {
    const ParameterMatches found = resolve(scene, path);
    return std::ranges::any_of(found.matches, [&](const ParameterMatch& match) {
      return sizes_a_spring(match.parameter, scene);
    });
  });
}

} // namespace

void override_margin(Campaign& campaign, const std::vector<std::string>& scale,
                     const std::vector<double>& range) {
  if (scale.empty() && range.empty()) return;
  Json given = campaign.margin ? campaign.resolved.at("margin") : Json::object();
  if (range.empty() && !given.contains("range"))
    throw SpecError(
        {{"", "--range", "nothing",
          "two numbers, the scales to search from and to: --range A B, e.g. --range 0.5 2"}});
  if (!scale.empty()) given["scale"] = scale;
  if (!scale.empty() && !scales_spring(campaign.scene, scale))
    given.erase("cases"); // of the campaign's own springs: one that is lost
  if (!range.empty()) {
    given["range"] = range;
    given.erase("widest"); // it encloses the campaign's own range
  }
  override_settings(given, [&](const JsonCursor& at) {
    campaign.margin = read_margin(at, &campaign.scene, campaign.motorization);
  });
  campaign.resolved["margin"] =
      write_margin(*campaign.margin, campaign.motorization, campaign.scene);
  campaign.resolved.erase("motorization"); // the margin's own now
}

} // namespace wingspread
