#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/examine.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/report/text/replay_report.hpp"
#include "montecarlo/report/text/trajectory.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <limits>
#include <memory>

namespace wingspread {
namespace {

struct SimulateOptions {
  std::filesystem::path scene, out;
  api::Settings settings;
  bool json = false, strict = false;
  std::optional<double> dt;
};

struct ReplayOptions {
  std::filesystem::path folder, out;
  std::string of_case;
  long run = 0;
  bool json = false;
};

/// Calls `run` with an observer that writes the trajectory, or with none when no file is named.
template <class Run>
auto write_trajectory(const std::filesystem::path& path, const Scene& scene, const Run& run) {
  if (path.empty()) return run(Observer{});
  TrajectoryWriter writer(path, scene);
  auto result = run(writer.observer());
  writer.finish();
  return result;
}

int status_code(const Outcome& outcome) {
  if (outcome.status != Status::failed) return exit_code::done;
  fmt::print(stderr, "error: the run failed numerically: {}\n", outcome.reason);
  return exit_code::failed_runs;
}

/// Of the trajectory's times; 0: every step.
double interval_of(const SimulateOptions& options, double t_end) {
  constexpr double most_rows = 1e8; // some 10 GB of them
  if (!options.dt) return 0;
  if (options.out.empty())
    throw SpecError({{"", "--dt", "no --out", "the trajectory's file, whose times it spaces"}});
  check_interval(*options.dt);
  if (t_end / *options.dt > most_rows)
    throw SpecError({{"", "--dt", fmt::format("{:g}", *options.dt),
                      fmt::format("at least {:g}: that is {:g} rows to {:g} s", t_end / most_rows,
                                  most_rows, t_end)}});
  return *options.dt;
}

int simulate(const SimulateOptions& options) {
  refuse_overwriting(options.out, {options.scene});
  const Task task = task_of(read_file(options.scene), options.settings);
  heed(examine(task.scene, task.integration, options.scene), options.strict);
  Goal goal;
  goal.to_t_end = true;
  goal.sample_interval = interval_of(options, task.integration.t_end);
  const Outcome outcome = write_trajectory(options.out, task.scene, [&](const Observer& observer) {
    return Deployment().run(task.scene, task.integration, goal, observer);
  });
  fmt::print("{}", options.json ? json_text(outcome_json(task.scene, outcome))
                                : outcome_text(task.scene, outcome));
  return status_code(outcome);
}

int replay(const ReplayOptions& options) {
  refuse_overwriting(options.out, {options.folder});
  const StoredCampaign stored =
      read_stored_campaign(folder_of_case(options.folder, options.of_case));
  const ReplayRequest request(stored, options.run);
  const Scene& scene = stored.campaign.scene;
  const Replayed replayed = write_trajectory(
      options.out, scene, [&](const Observer& observer) { return request.replay(observer); });
  fmt::print("{}",
             options.json ? json_text(replay_json(replayed, scene)) : replay_text(replayed, scene));
  for (const std::string& difference : replayed.differences)
    fmt::print(stderr, "error: {}\n", difference);
  const int code = status_code(replayed.outcome);
  return replayed.differences.empty() ? code : exit_code::failed_runs;
}

} // namespace

void add_simulate(CLI::App& app, Action& action) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand("simulate", "Integrate one deployment to its t_end");
  command->add_option("scene", options->scene, "A scene, or a campaign for its nominal scene")
      ->required();
  add_set_option(*command, options->settings.set);
  add_case_option(*command, options->settings.of_case);
  command->add_flag("--json", options->json, "Print the outcome as JSON");
  command->add_option("--out", options->out, "Write the trajectory to this CSV file");
  add_strict_option(*command, options->strict);
  command->add_option("--dt", options->dt, "Rows at these intervals, s; else at every step")
      ->type_name("S");
  command->add_option("--method", options->settings.method, "See wingspread methods");
  command->add_option("--step", options->settings.step, "The step of a method with a fixed one, s");
  command->add_option("--rtol", options->settings.rtol,
                      "Relative tolerance of a step, at least 1e-15");
  command->add_option("--atol", options->settings.atol,
                      "Absolute tolerance of a step, rad and rad/s");
  command->add_option("--t-end", options->settings.t_end, "Where to stop, s");
  command->add_option("--latch", options->settings.latch, "event, or smoothed:EPS with EPS in rad")
      ->type_name("event|smoothed:EPS")
      ->check(refuse_latch);
  command->footer(
      R"(Settings that are not given are the campaign's, or for a scene the defaults of a campaign.

Example:
  wingspread simulate three_panel.json --t-end 20
  wingspread simulate three_panel.json --json --out trajectory.csv --dt 0.01)");
  command->callback([options, &action] { action = [options] { return simulate(*options); }; });
}

void add_replay(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ReplayOptions>();
  CLI::App* command =
      app.add_subcommand("replay", "Make one run of a campaign again, and look at it");
  command->add_option("folder", options->folder, "The results folder")->required();
  command->add_option("--run", options->run, "Which run, as numbered in runs.csv from 0")
      ->required()
      ->check(CLI::Range(0L, std::numeric_limits<long>::max()).description(""))
      ->type_name("K");
  add_case_option(*command, options->of_case);
  command->add_flag("--json", options->json, "Print the outcome as JSON");
  command->add_option("--out", options->out, "Write the trajectory to this CSV file");
  command->footer(
      R"(The run stops where the campaign's did, and is compared with its row of runs.csv, bit for bit. If
they differ (another machine, or a changed file), each column that does is named, and the exit code
is 3.

Example:
  wingspread replay results/first --run 17 --out trajectory.csv)");
  command->callback([options, &action] { action = [options] { return replay(*options); }; });
}

} // namespace wingspread
