#include "montecarlo/interfaces/library/single_run.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
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
  if (settings.max_steps) given["max_steps"] = *settings.max_steps;
  if (settings.latch == "event")
    given["latch"] = "event";
  else if (settings.latch)
    given["latch"] = {{"smoothed", *parse_smoothed(*settings.latch)}};
  override_settings(given, [&](const JsonCursor& at) { read_integration(at, integration); });
}

/// Refuses a nominal wing that dispersions at their medians make unphysical; a scene alone is checked as it is read.
void refuse_unphysical(const Scene& nominal) {
  std::vector<Problem> problems;
  for (const Fault& fault : unphysical(nominal))
    problems.push_back({"", fault.path,
                        fault.found + " in the nominal wing, every dispersion at its median",
                        fault.expected});
  if (!problems.empty()) throw SpecError(std::move(problems));
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
    refuse_unphysical(task.scene);
  } else {
    if (!settings.of_case.empty()) (void)chosen_case(Campaign(), settings.of_case);
    task.scene = changed_scene(std::get<Scene>(std::move(input)), settings.set);
  }
  apply_settings(settings, task.integration);
  if (const std::string found = beyond_smoothed_latches(task.scene);
      task.integration.smoothing && !found.empty())
    throw SpecError(
        {{"", settings.latch ? "--latch" : "/integration/latch", found, expected_event_latches}});
  return task;
}

std::optional<RunCheck> check_of(const Task& task, const Goal& goal, const Outcome& outcome) {
  if (outcome.status == Status::failed || outcome.status == Status::invalid) return std::nullopt;
  return check_run(task.scene, task.integration, goal, outcome);
}

void check_interval(double interval, double t_end) {
  constexpr double most_rows = 1e8; // some 10 GB of them
  if (!(interval > 0) || !std::isfinite(interval))
    throw SpecError({{"", "--dt", fmt::format("{}", interval), "a number, s, > 0"}});
  if (t_end / interval > most_rows)
    throw SpecError({{"", "--dt", fmt::format("{:g}", interval),
                      fmt::format("at least {:g}, which gives {:g} rows up to t_end = {} s",
                                  t_end / most_rows, most_rows, t_end)}});
}

std::optional<Problem> problem_of_threads(int threads) {
  if (threads >= 0 && threads <= most_threads) return std::nullopt;
  return Problem{"", "--threads", std::to_string(threads),
                 fmt::format("an integer from 1 to {}, or 0", most_threads)};
}

void check_threads(int threads) {
  if (const auto problem = problem_of_threads(threads)) throw SpecError({*problem});
}

std::vector<std::string> notices_of(const Task& task, const std::filesystem::path& file) {
  std::vector<std::string> notices;
  for (const InputWarning& warning : check_input(task.scene, task.integration, file))
    notices.push_back(to_string(warning));
  return notices;
}

} // namespace wingspread
