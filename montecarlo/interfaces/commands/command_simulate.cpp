#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/report/text/check_report.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/report/text/replay_report.hpp"
#include "montecarlo/report/text/trajectory.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <fmt/format.h>

#include <limits>

namespace wingspread {
namespace {

struct SimulateOptions {
  std::filesystem::path scene, out;
  api::Settings settings;
  bool json = false, strict = false, check = false;
  std::optional<double> dt;
};

struct ReplayOptions {
  std::filesystem::path folder, out;
  std::string of_case;
  long run = 0;
  bool json = false;
};

/// Calls `run` with an observer that writes the trajectory; without a path, with an empty observer.
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

/// The interval between rows of the trajectory, s; 0: a row at every step.
double interval_of(const SimulateOptions& options, double t_end) {
  constexpr double most_rows = 1e8; // some 10 GB of them
  if (!options.dt) return 0;
  if (options.out.empty())
    throw SpecError({{"", "--dt", "--dt without --out", "the trajectory's file in --out"}});
  check_interval(*options.dt);
  if (t_end / *options.dt > most_rows)
    throw SpecError({{"", "--dt", fmt::format("{:g}", *options.dt),
                      fmt::format("at least {:g}, which gives {:g} rows up to {:g} s",
                                  t_end / most_rows, most_rows, t_end)}});
  return *options.dt;
}

int simulate(const SimulateOptions& options) {
  refuse_overwriting(options.out, {options.scene});
  const Task task = task_of(read_file(options.scene), options.settings);
  print_warnings(check_input(task.scene, task.integration, options.scene), options.strict);
  Goal goal;
  goal.to_t_end = true;
  goal.sample_interval = interval_of(options, task.integration.t_end);
  const Outcome outcome = write_trajectory(options.out, task.scene, [&](const Observer& observer) {
    return Deployment().run(task.scene, task.integration, goal, observer);
  });
  goal.sample_interval = 0;
  if (options.json) {
    Json json = outcome_json(task.scene, outcome);
    if (options.check) json["check"] = check_json(check_of(task, goal, outcome));
    fmt::print("{}", json_text(json));
  } else {
    fmt::print("{}", outcome_text(task.scene, outcome));
    if (options.check) fmt::print("{}", check_text(check_of(task, goal, outcome)));
  }
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

void add_simulate_options(CLI::App& command, SimulateOptions& options) {
  api::Settings& settings = options.settings;
  command.add_option("scene", options.scene, "A scene, or a campaign for its nominal scene")
      ->required();
  add_set_option(command, settings.set);
  add_case_option(command, settings.of_case);
  command.add_flag("--json", options.json, "Print the outcome as JSON");
  command.add_flag("--check", options.check,
                   "Repeat by another method at rtol/100; say how many digits agree");
  command.add_option("--out", options.out, "Write the trajectory to this CSV file");
  add_strict_option(command, options.strict);
  command
      .add_option("--dt", options.dt,
                  "Interval between rows of the trajectory, s; default: every step")
      ->type_name("S");
  command.add_option("--method", settings.method, "Integration method; see wingspread methods");
  command.add_option("--step", settings.step, "Step size of a method with a fixed step, s");
  command.add_option("--rtol", settings.rtol, "Relative tolerance of a step, at least 1e-15");
  command.add_option("--atol", settings.atol, "Absolute tolerance of a step, rad and rad/s");
  command.add_option("--t-end", settings.t_end, "End of the simulation, s");
  command
      .add_option("--latch", settings.latch, "Latch model: event, or smoothed:EPS with EPS in rad")
      ->type_name("event|smoothed:EPS")
      ->check(refuse_latch);
  command.footer(
      R"(Settings that are not given are the campaign's, or for a scene the defaults of a campaign.

--check warns of every output that moves by more than 1 %: the tolerance does not decide its value.

Example:
  wingspread simulate three_panel.json --t-end 20 --check
  wingspread simulate three_panel.json --json --out trajectory.csv --dt 0.01)");
}

void add_replay_options(CLI::App& command, ReplayOptions& options) {
  command.add_option("folder", options.folder, "The results folder")->required();
  command.add_option("--run", options.run, "The run's number in runs.csv, from 0")
      ->required()
      ->check(CLI::Range(0L, std::numeric_limits<long>::max()).description(""))
      ->type_name("K");
  add_case_option(command, options.of_case);
  command.add_flag("--json", options.json, "Print the outcome as JSON");
  command.add_option("--out", options.out, "Write the trajectory to this CSV file");
  command.footer(
      R"(The run stops where the campaign's run did and is compared with its row of runs.csv, bit for bit. If
they differ (another machine, or a changed file), each column that differs is named and the exit
code is 3.

Example:
  wingspread replay results/first --run 17 --out trajectory.csv)");
}

} // namespace

void add_simulate(CLI::App& app, Action& action) {
  add_command<SimulateOptions>(app, action, "simulate", "Simulate one deployment to its t_end",
                               add_simulate_options, simulate);
}

void add_replay(CLI::App& app, Action& action) {
  add_command<ReplayOptions>(app, action, "replay", "Reproduce one run of a campaign in full",
                             add_replay_options, replay);
}

} // namespace wingspread
