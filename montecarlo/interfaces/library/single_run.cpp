#include "montecarlo/interfaces/library/single_run.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace wingspread {
namespace {

constexpr std::string_view smoothed_prefix = "smoothed:";

/// The ε of "smoothed:EPS"; nothing for any other text.
std::optional<double> parse_smoothed(std::string_view text) {
  if (!text.starts_with(smoothed_prefix)) return std::nullopt;
  text.remove_prefix(smoothed_prefix.size());
  return parse_number<double>(text);
}

void apply_settings(const api::Settings& settings, Integration& integration) {
  Json given = Json::object();
  if (settings.method) given["method"] = *settings.method;
  if (settings.step) given["step"] = *settings.step;
  if (settings.rtol) given["rtol"] = *settings.rtol;
  if (settings.atol) given["atol"] = *settings.atol;
  if (settings.t_end) given["t_end"] = *settings.t_end;
  if (settings.latch == "event")
    given["latch"] = "event";
  else if (settings.latch)
    given["latch"] = {{"smoothed", *parse_smoothed(*settings.latch)}};
  override_settings(given, [&](const JsonCursor& at) { read_integration(at, integration); });
}

} // namespace

std::variant<Scene, Campaign> read_input(const api::Input& input) {
  return input.file.empty() ? read_scene_or_campaign(input.text, input.directory)
                            : read_file(input.file);
}

Campaign read_campaign_input(const api::Input& input) {
  return input.file.empty() ? read_campaign(input.text, input.directory)
                            : read_campaign_file(input.file);
}

std::string refuse_latch(const std::string& text) {
  if (text == "event" || parse_smoothed(text)) return "";
  return fmt::format("found {}, expected event, or smoothed:EPS with EPS in rad, e.g. "
                     "smoothed:1e-4",
                     text);
}

Task task_of(std::variant<Scene, Campaign> input, const api::Settings& settings) {
  if (settings.latch && !refuse_latch(*settings.latch).empty())
    throw SpecError({{"", "--latch", *settings.latch,
                      "event, or smoothed:EPS with EPS in rad, e.g. smoothed:1e-4"}});
  Task task;
  if (Campaign* campaign = std::get_if<Campaign>(&input)) {
    change_scene(*campaign, settings.set);
    if (!settings.of_case.empty()) *campaign = chosen_case(*campaign, settings.of_case);
    task = {nominal_scene(*campaign), std::move(campaign->integration)};
  } else {
    if (!settings.of_case.empty()) (void)chosen_case(Campaign(), settings.of_case);
    task.scene = changed_scene(std::get<Scene>(std::move(input)), settings.set);
  }
  apply_settings(settings, task.integration);
  return task;
}

std::optional<RunCheck> check_of(const Task& task, const Goal& goal, const Outcome& outcome) {
  if (outcome.status == Status::failed || outcome.status == Status::invalid) return std::nullopt;
  return check_run(task.scene, task.integration, goal, outcome);
}

void check_interval(double interval) {
  if (!(interval > 0) || !std::isfinite(interval))
    throw SpecError({{"", "--dt", fmt::format("{}", interval), "a number, s, > 0"}});
}

} // namespace wingspread
