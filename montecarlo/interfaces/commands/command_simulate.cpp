#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/report/text/check_report.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/report/text/replay_report.hpp"
#include "montecarlo/report/text/trajectory.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

struct SimulateOptions {
  std::filesystem::path scene, out;
  api::Settings settings;
  bool json = false, strict = false, check = false;
  std::optional<double> dt;
};

struct ReplayOptions {
  std::filesystem::path folder, out, scene;
  std::string of_case;
  long run = 0;
  bool json = false;
  std::optional<double> dt;
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
  print_message("error: the run failed numerically: {}\n", outcome.reason);
  return exit_code::failed_runs;
}

/// The interval between rows of the trajectory, s; 0: a row at every step.
template <class Options> double interval_of(const Options& options, double t_end) {
  if (!options.dt) return 0;
  if (options.out.empty())
    throw SpecError({{"", "--dt", "--dt without --out", "the trajectory's file in --out"}});
  check_interval(*options.dt, t_end);
  return *options.dt;
}

/// @param text of the file that --scene asks for
/// @throws SpecError if that file is --out's, or exists with another text: it may be somebody's scene
void refuse_lost_scene(const ReplayOptions& options, const std::string& text) {
  const std::filesystem::path& file = options.scene;
  const auto refuse = [&](const char* what, const char* expected) {
    throw SpecError({{"", "--scene", '"' + file.string() + "\", " + what, expected}});
  };
  const auto whole = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  if (!options.out.empty() && whole(options.out) == whole(file))
    refuse("the file of --out", "another file");
  if (std::filesystem::is_regular_file(file) && read_text(file) != text)
    refuse("an existing file", "a new file: this one would be lost");
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
  const Integration& integration = stored.campaign.integration;
  const double interval = interval_of(options, integration.t_end);
  const std::string scene =
      options.scene.empty() ? "" : json_text(write_scene(request.applied_scene()));
  if (!options.scene.empty()) refuse_lost_scene(options, scene);
  const Replayed replayed =
      write_trajectory(options.out, stored.campaign.scene, [&](const Observer& observer) {
        return request.replay(observer, interval);
      });
  if (!options.scene.empty()) write_file(options.scene, scene);
  fmt::print("{}", options.json ? json_text(replay_json(replayed)) : replay_text(replayed));
  if (!options.scene.empty() && !options.json)
    fmt::print("Its scene: {}\n  wingspread simulate {}{}\n", options.scene.string(),
               shell_word(options.scene.string()), options_of(integration, replayed.outcome));
  for (const std::string& difference : replayed.differences)
    print_message("error: {}\n", difference);
  const int code = status_code(replayed.outcome);
  return replayed.differences.empty() ? code : exit_code::failed_runs;
}

void add_dt_option(CLI::App& command, std::optional<double>& dt) {
  limited(with_unit(command.add_option(
                        "--dt", dt, "Interval between rows of the trajectory; default: every step"),
                    "s"),
          "s, > 0")
      ->type_name("S");
}

void add_simulate_options(CLI::App& command, SimulateOptions& options) {
  api::Settings& settings = options.settings;
  command.add_option("scene", options.scene, "A scene, or a campaign for its nominal scene")
      ->required();
  add_set_option(command, settings.set);
  add_case_option(command, settings.of_case, without_case);
  command.add_flag("--json", options.json, "Print the outcome as JSON");
  command.add_flag("--check", options.check,
                   "Repeat by another method at rtol/100; say how many digits agree");
  command.add_option("--out", options.out,
                     "Write the trajectory to this CSV file; an existing file is replaced");
  add_strict_option(command, options.strict);
  add_dt_option(command, options.dt);
  command.add_option("--method", settings.method, "Integration method; see wingspread methods");
  with_unit(command.add_option("--step", settings.step,
                               "Step size of a method with a fixed step, s, > 0"),
            "s");
  command.add_option("--rtol", settings.rtol,
                     "Relative tolerance of a step, at least 1e-15 and < 1");
  command.add_option("--atol", settings.atol, "Absolute tolerance of a step, rad and rad/s, > 0");
  with_unit(command.add_option("--t-end", settings.t_end, "End of the simulation, s, > 0"), "s");
  within(command.add_option("--max-steps", settings.max_steps,
                            "The run fails after so many trial steps"),
         1, std::numeric_limits<std::int64_t>::max())
      ->type_name("N");
  command
      .add_option("--latch", settings.latch, "Latch model: event, or smoothed:EPS with EPS in rad")
      ->type_name("event|smoothed:EPS")
      ->check(refuse_latch);
  command.footer(
      R"(Settings that are not given are the campaign's, or for a scene the defaults of a campaign. The
nominal scene of a campaign has every dispersion at the median of its law, tables included: where a
median changes a value, `check` prints both, "1 as written, nominal 2.718".

--check warns of every output that moves by more than 1 %: the tolerance does not decide its value.

Example:
  wingspread simulate three_panel.json --t-end 20 --check
  wingspread simulate three_panel.json --json --out trajectory.csv --dt 0.01)");
}

void add_replay_options(CLI::App& command, ReplayOptions& options) {
  command.add_option("folder", options.folder, "The results folder")->required();
  within(command.add_option("--run", options.run, "The run's number in runs.csv"), 0,
         std::numeric_limits<long>::max())
      ->required()
      ->type_name("K");
  add_case_option(command, options.of_case);
  command.add_flag("--json", options.json, "Print the outcome as JSON");
  command.add_option("--out", options.out,
                     "Write the trajectory to this CSV file; an existing file is replaced");
  add_dt_option(command, options.dt);
  command
      .add_option("--scene", options.scene,
                  "Write the scene with the run's draws to this JSON file, a new one")
      ->type_name("FILE");
  command.footer(
      R"(The run stops where the campaign's run did and is compared with its row of runs.csv, bit for bit. If
they differ (another machine, or a changed file), each column that differs is named and the exit
code is 3.

--scene writes the wing of this run as a scene: every mass, point, angle and torque after the case
and the draws. `simulate` on that file latches at the same times, with the options that are printed
where the campaign's integration is not the default.

Example:
  wingspread replay results/first --run 17 --out trajectory.csv --dt 0.01
  wingspread replay results/first/cold --run 17 --scene run_17.json)");
}

struct SampleOptions {
  std::filesystem::path campaign, out;
  std::string of_case;
  SamplingOptions sampling;
  bool applied = false;
};

/// The columns of the CSV after `run`, and a function that fills them for one run.
struct Columns {
  std::vector<std::string> names;
  std::function<void(long run, std::vector<double>& values)> fill;
};

Columns draws_of(const RunPlan& plan) {
  return {plan.names().draws,
          [&plan](long run, std::vector<double>& values) { plan.draw(run, values); }};
}

/// The parameters that the draws change, as each run has them.
Columns parameters_of(const RunPlan& plan) {
  const Campaign& campaign = plan.campaign();
  const auto parameters = dispersed_parameters(campaign.dispersions);
  auto fill = [&plan, &campaign, parameters, scene = campaign.scene,
               draws = std::vector<double>(plan.names().draws.size())](
                  long run, std::vector<double>& values) mutable {
    plan.draw(run, draws);
    apply(campaign, draws, campaign.scene, scene);
    const Scene& applied = scene;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = parameters[i].in(applied);
  };
  return {paths_of(campaign.scene, parameters), std::move(fill)};
}

/// Writes the CSV to the sink, in blocks.
void write_rows(long runs, const Columns& columns,
                const std::function<void(std::string_view)>& sink) {
  constexpr std::size_t block_bytes = 1 << 16;
  std::string block = "run";
  for (const std::string& name : columns.names) append_csv_cells(block, name);
  block += '\n';
  std::vector<double> values(columns.names.size());
  for (long k = 0; k < runs; ++k) {
    append_csv_cell(block, k);
    columns.fill(k, values);
    for (const double value : values) append_csv_cells(block, value);
    block += '\n';
    if (block.size() < block_bytes) continue;
    sink(block);
    block.clear();
  }
  sink(block);
}

int sample(const SampleOptions& options) {
  refuse_overwriting(options.out, {options.campaign});
  Campaign campaign = read_campaign_file(options.campaign);
  if (!options.of_case.empty()) campaign = chosen_case(campaign, options.of_case);
  override_sampling(campaign, options.sampling.runs, options.sampling.seed);
  const RunPlan plan(campaign);
  const long runs = campaign.sampling.runs;
  const Columns columns = options.applied ? parameters_of(plan) : draws_of(plan);
  if (options.out.empty()) {
    write_rows(runs, columns, [](std::string_view block) { fmt::print("{}", block); });
    return exit_code::done;
  }
  WholeFile out(options.out);
  write_rows(runs, columns, [&](std::string_view block) { out.write(block); });
  out.finish();
  return exit_code::done;
}

void add_sample_options(CLI::App& command, SampleOptions& options) {
  command.add_option("campaign", options.campaign, "The campaign, a JSON file")->required();
  add_sampling_options(command, options.sampling);
  add_case_option(command, options.of_case, without_case);
  command.add_flag("--applied", options.applied,
                   "Print the parameters that the draws change, as each run has them");
  command.add_option("--out", options.out,
                     "Write to this file, which is replaced; default: standard output");
  command.footer(
      R"(These are the draws that `run` uses, to the last bit. With --applied there is a column for each
parameter of the scene that a draw changes, named by its path, in SI units: the scene's value, set,
scaled and added to by all draws of the run, tables included.

Example:
  wingspread sample campaign.json --runs 100 > draws.csv
  wingspread sample campaign.json --case cold --applied > parameters.csv)");
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

void add_sample(CLI::App& app, Action& action) {
  add_command<SampleOptions>(app, action, "sample", "Print a campaign's draws as CSV",
                             add_sample_options, sample);
}

} // namespace wingspread
