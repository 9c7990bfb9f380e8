#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/margin/margin_study.hpp"
#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/results/checkpoint/checkpointed_evaluator.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace wingspread {
namespace {

struct MarginOptions {
  std::filesystem::path campaign, out, requirements;
  SamplingOptions sampling;
  MachineOptions machine;
  std::string shard;
  std::vector<std::string> scale;
  std::vector<double> range;
  std::vector<std::filesystem::path> from;
  bool resume = false, json = false;
};

/// Writes the campaign with the recommended springs, if there is a recommendation. It has not been analysed before.
void write_recommended(const Campaign& campaign, const MarginResult& result,
                       const std::filesystem::path& folder) {
  const MarginSearch* search = recommending(campaign, result);
  if (!search) return;
  Campaign recommended = scaled(campaign, search->scaled, *search->recommended);
  note_extension(recommended, {});
  write_file(folder / recommended_file, json_text(recommended.resolved));
}

/// Prints warnings, and names the searches without a confirmed scale. @return the exit status
int print_verdict(const MarginResult& result) {
  for (const std::string& line : margin_warnings(result)) print_message("warning: {}\n", line);
  for (const MarginSearch& search : result.searches)
    if (!is_confirmed(search))
      print_message(
          "not met: {}: {}\n", search.name,
          search.recommended
              ? fmt::format("runs of seed {} do not confirm the recommended scale: choose a scale "
                            "further from the edge, or start again with another seed and more "
                            "runs (adding runs until it passes inflates the risk)",
                            result.confirmation_seed)
              : why_withheld(search));
  const int code =
      report_failed(result.failed, result.runs, ", and count against every requirement");
  return code != exit_code::done || is_met(result) ? code : exit_code::not_met;
}

/// Writes the files of a finished study. @return the text of margin.json
std::string write_files(const Campaign& campaign, const MarginResult& result,
                        const MarginReport& report, const std::filesystem::path& out) {
  std::string json = json_text(margin_json(report, stamp_json(stamp_of(campaign, {}))));
  write_file(out / margin_csv_file, margin_csv(campaign, result));
  write_file(out / motorization_csv_file, static_margins_csv(report.static_margins));
  write_recommended(campaign, result, out);
  write_file(out / margin_json_file, json); // last, because it marks the folder as complete
  return json;
}

/// Returns the exit status of a study that an earlier session finished.
int judge_finished_margin(const Json& study) {
  for (const Json& line : study.value("warnings", Json::array()))
    print_message("warning: {}\n", line.get<std::string>());
  const int code = report_failed(study.value("runs_failed", 0L), study.value("runs", 0L),
                                 ", and count against every requirement");
  return code != exit_code::done || study.value("met", false) ? code : exit_code::not_met;
}

/// Saves an interrupted study: its finished scales in margin.csv, all its runs in the checkpoint.
int keep_unfinished(const Campaign& campaign, const MarginResult& result, Checkpoint& log,
                    const std::filesystem::path& out) {
  write_file(out / margin_csv_file, margin_csv(campaign, result));
  log.sync();
  print_message("interrupted: {} runs are kept; the same command with --resume continues (finished "
                "scales are in {})\n",
                log.rows(), (out / margin_csv_file).string());
  return exit_code::interrupted;
}

Json about_study(const Campaign& campaign, const std::optional<Shard>& shard) {
  return {{stamp_key, stamp_json(stamp_of(campaign, shard))}};
}

/// The command that makes a shard of this study.
ShardMaker maker_of(const MarginOptions& options) {
  ShardMaker maker{"wingspread margin " + shell_word(options.campaign.string()), ""};
  if (options.sampling.runs) maker.more += fmt::format(" --runs {}", *options.sampling.runs);
  if (options.sampling.seed) maker.more += fmt::format(" --seed {}", *options.sampling.seed);
  if (!options.requirements.empty())
    maker.more += " --requirements " + shell_word(options.requirements.string());
  for (const std::string& path : options.scale) maker.more += " --scale " + shell_word(path);
  if (!options.range.empty())
    maker.more += fmt::format(" --range {}", fmt::join(options.range, " "));
  return maker;
}

/// Makes a shard of the runs at the first scales (no result decides these scales). @return the exit status
int make_margin_shard(const Campaign& campaign, const MarginOptions& options, const Shard& shard) {
  if (!options.from.empty())
    throw SpecError({{"", "--from", "--from together with --shard", "only one of them"}});
  const Json about = about_study(campaign, shard);
  StudyFolder folder(options.out, about, shard_file, options.resume);
  const Interrupt interrupt;
  const auto maker = evaluator_of(pool_of(options.machine), interrupt.flag());
  CheckpointedEvaluator evaluator(*maker, folder.log(), interrupt.flag());
  Progress progress(stderr);
  try {
    const long runs =
        run_first_scales(campaign, shard, evaluator, [&](const StudyProgress& so_far) {
          progress.show(counts_of(so_far, folder.log().read()));
        });
    warn_if_damaged(folder.log(), options.out);
    folder.log().sync();
    Json study = about;
    study["runs"] = runs;
    write_file(options.out / shard_file, json_text(study));
  } catch (const Stopped&) {
    folder.log().sync();
    print_message("interrupted: {} runs are kept; the same command with --resume continues\n",
                  folder.log().rows());
    return exit_code::interrupted;
  }
  fmt::print("{}\n", (options.out / shard_file).string());
  print_message("note: {} of the first scales is complete; --from with the folders of all shards "
                "continues\n",
                describe(shard));
  return exit_code::done;
}

/// Prints the input checks' warnings, of the requirements that the study judges.
void warn_of_input(Campaign campaign, const MarginOptions& options) {
  const std::filesystem::path& other = options.requirements;
  if (other.empty()) return print_warnings(check_campaign(campaign, options.campaign), false);
  campaign.requirements.clear();
  print_warnings(check_campaign(campaign, options.campaign), false);
  campaign.requirements = read_requirements_file(other, campaign);
  if (campaign.requirements.empty())
    throw SpecError(
        {{other.string(), "", "no requirement", "at least one: they limit the window"}});
  print_warnings(check_requirements_file(campaign, other), false);
}

/// @throws MissingRuns when a shard in --from is missing or not finished
int run_margin_study(const MarginOptions& options) {
  refuse_repeated(options.from);
  Campaign campaign = read_campaign_file(options.campaign);
  override_sampling(campaign, options.sampling.runs, options.sampling.seed);
  warn_of_input(campaign, options);
  if (!options.requirements.empty()) override_requirements(campaign, options.requirements);
  override_margin(campaign, options.scale, options.range);
  if (const auto shard = parse_shard(options.shard))
    return make_margin_shard(campaign, options, *shard);
  const Json about = about_study(campaign, std::nullopt);
  StudyFolder folder(options.out, about, margin_json_file, options.resume);
  if (folder.is_finished())
    return judge_finished_margin(show_finished(options.out / margin_json_file, options.json));
  const Interrupt interrupt;
  const auto maker = evaluator_of(pool_of(options.machine), interrupt.flag());
  CheckpointedEvaluator logged(*maker, folder.log(), interrupt.flag());
  ShardCheckpoints evaluator(options.from, about, campaign.sampling.runs, maker_of(options), logged,
                             interrupt.flag());
  Progress progress(stderr);
  MarginResult result;
  try {
    const auto show = [&](const StudyProgress& so_far) {
      progress.show(counts_of(so_far, folder.log().read() + evaluator.read()));
    };
    find_margin(campaign, evaluator, show, result);
  } catch (const Stopped&) {
    return keep_unfinished(campaign, result, folder.log(), options.out);
  }
  warn_if_damaged(folder.log(), options.out);
  const MarginReport report = margin_report(campaign, result);
  const std::string json = write_files(campaign, result, report, options.out);
  folder.finish();
  fmt::print("{}", options.json ? json : margin_text(report));
  return print_verdict(result);
}

int margin(const MarginOptions& options) {
  try {
    return run_margin_study(options);
  } catch (const MissingRuns& missing) {
    return print_missing(missing, "");
  } catch (const SpecError& error) {
    throw in_file(error, options.campaign);
  }
}

void add_margin_options(CLI::App& command, MarginOptions& options) {
  command.add_option("campaign", options.campaign, "The campaign, a JSON file")->required();
  command.add_option("--out", options.out, "The folder for the results: new or empty")->required();
  command
      .add_option("--scale", options.scale, "Scale these parameters, e.g. 'hinges.*.spring.scale'")
      ->type_name("PATH");
  command
      .add_option("--range", options.range, "Search from this scale to that one, > 0, e.g. 0.8 1.5")
      ->expected(2)
      ->type_name("SCALE");
  add_requirements_option(command, options.requirements);
  add_sampling_options(command, options.sampling);
  add_machine_options(command, options.machine);
  command.add_flag("--resume", options.resume, "Continue an interrupted study");
  add_shard_option(command, options.shard,
                   "Make only part I of N of the runs at the first scales, e.g. 2/5");
  command.add_option("--from", options.from, "Continue from the folders of all shards")
      ->type_name("DIR");
  command.add_flag("--json", options.json, "Print JSON, not text");
  command.footer(
      R"(Scales the parameters that the campaign's "margin" or --scale names, makes the same draws at every
scale and judges the campaign's requirements there. The window is the range of scales at which all
of them are met. Each edge is located to 1 % ("tolerance"); the report names the requirement that
sets it, and how many runs break it on either side.

An end of the range is not an edge: if no requirement fails there, the range is widened until one
does, up to "widest". Without both edges there is no recommendation.

The recommended scale maximises the margin of the worst requirement: the share of runs that may
break it over the share that does. Where a range of scales is equally good, the report says which:
the present springs are kept if they are in it, else the geometric mean of its ends is recommended.
The report says what this costs against the present springs. The recommendation is confirmed by runs
with a seed of their own. Weaker springs are not recommended if static margins of the nominal wing
would become negative; a warning names those that are negative at the recommended scale. If no
scale works, the report names the requirements that rule it out. A peak that t_end cut breaks a
requirement, as in `wingspread run`; a warning names the scale with most of them.

All runs are made, also with "until"; the verdicts are those of `wingspread run`, which share the
risk among all interim analyses. A run stops once its requirements are decided: if none is about a
peak, a run that fails numerically after its last latch counts as deployed here, and as failed in
`wingspread run`. Each verdict holds with its requirement's confidence; the report gives
the joint confidence of all verdicts and both edges.

  "margin": { "scale": ["hinges.*.spring.torque_stowed", "hinges.*.spring.torque_latched"],
              "range": [0.5, 2] }

  mode                joint: all springs together (default); each: one hinge after the other
  widest              how far the range may be widened; default: an eighth and eight times
  points, tolerance   scales of the first grid, default 13; accuracy of an edge, default 0.01
  cases               ["nominal"], ["nominal", "one_spring_out"]: one hinge loses one of its
  springs_per_hinge   equal springs, each hinge in turn; default 2. Motors keep their torques
  motorization        factors of the static margins, by ECSS, NASA, GEVS and AIAA

The folder gets margin.json, margin.csv (results at every scale), motorization.csv (static margins
at every angle of the travel) and recommended.json, the campaign with the recommended springs. Until
the study is finished the folder also has looks.log, a checkpoint of all runs so far: after an
interruption, a crash or a kill the same command with --resume gives the same bytes.

The first scales (the grid, and 1) depend on nothing and are most of the work; their results decide
which scales come next. The first scales can be made in shards on separate machines, each with its
part of the runs at every scale. --from then continues from all shards and gives the same bytes as
one process. Exit code 0: there is a window and a confirmed recommendation; 1: there is none.

The last four commands below are for a campaign with a "margin".

Example:
  wingspread margin campaign.json --scale 'hinges.*.spring.scale' --range 0.5 2 --out results/m1
  wingspread run results/m1/recommended.json --out results/resized
  wingspread margin campaign.json --scale 'hinges.*.damper.scale' --range 0.8 1.5 --out results/m2
  wingspread margin campaign.json --out results/margin
  wingspread margin campaign.json --shard 1/2 --out results/part1
  wingspread margin campaign.json --shard 2/2 --out results/part2
  wingspread margin campaign.json --from results/part1 results/part2 --out results/margin)");
}

} // namespace

void add_margin(CLI::App& app, Action& action) {
  add_command<MarginOptions>(app, action, "margin",
                             "Find how strong the springs may be to meet all requirements",
                             add_margin_options, margin);
}

} // namespace wingspread
