/// Reads an Input, and applies Settings to it.
#pragma once

#include "montecarlo/engine/accuracy/run_check.hpp"
#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace wingspread {

/// Reads a scene or a campaign. @throws SpecError with all problems
[[nodiscard]] std::variant<Scene, Campaign> read_input(const api::Input& input);
/// Reads a campaign. @throws SpecError with all problems, also for a scene
[[nodiscard]] Campaign read_campaign_input(const api::Input& input);

/// One deployment to simulate.
struct Task {
  Scene scene;
  Integration integration;
};

/// The task for an input and settings. Settings that are not given come from the campaign, or for a scene from the
/// defaults of a campaign.
/// @throws SpecError that names the options of `wingspread simulate`
[[nodiscard]] Task task_of(std::variant<Scene, Campaign> input, const api::Settings& settings);

/// The check of a task's outcome; nothing if the run failed, or no reference can finish it.
[[nodiscard]] std::optional<RunCheck> check_of(const Task& task, const Goal& goal,
                                               const Outcome& outcome);

/// Returns an error text, or an empty text if the argument is "event" or "smoothed:EPS".
[[nodiscard]] std::string refuse_latch(const std::string& text);

/// @throws SpecError unless the interval of a trajectory, s, is a number > 0 that gives at most 10⁸ rows up to t_end
void check_interval(double interval, double t_end);

/// The problem of a number of threads that is not allowed; 0: OMP_NUM_THREADS, or all processors.
[[nodiscard]] std::optional<Problem> problem_of_threads(int threads);
/// @throws SpecError with that problem
void check_threads(int threads);

/// The warnings of the input checks, as `wingspread simulate` prints them.
/// @param file of the input; empty: a text
[[nodiscard]] std::vector<std::string> notices_of(const Task& task,
                                                  const std::filesystem::path& file);

} // namespace wingspread
