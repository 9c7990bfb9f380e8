#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/margin/margin_study.hpp"
#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/checkpoint/checkpointed_evaluator.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace wingspread {
namespace {

struct MarginOptions {
  std::filesystem::path campaign, out;
  SamplingOptions sampling;
  CrewOptions crew;
  std::string shard;
  std::vector<std::filesystem::path> from;
  bool resume = false, json = false;
};

/// The campaign with the recommended springs, ready to be run.
void write_recommended(const Campaign& campaign, const MarginResult& result,
                       const std::filesystem::path& folder) {
  if (const MarginSearch* search = recommending(campaign, result))
    write_file(folder / recommended_file,
               json_text(scaled(campaign, search->scaled, *search->recommended).resolved));
}

/// What there is to say besides the report.
int conclude(const Campaign& campaign, const MarginResult& result) {
  const Base& base = campaign.scene.base;
  if (base.motion == BaseMotion::prescribed)
    fmt::print(stderr, "warning: static motorization margins do not know the loads of a base that "
                       "moves; give them as \"inertia\" in the margin's \"torques\"\n");
  for (const MarginSearch& search : result.searches)
    if (!is_confirmed(search))
      fmt::print(
          stderr, "not met: {}: {}\n", search.name,
          search.recommended
              ? fmt::format("runs of seed {} do not show it at the recommended scale: choose a "
                            "point further from what they break, or begin anew with another "
                            "seed and more runs (going on until one passes would not show it)",
                            result.confirmation_seed)
              : why_withheld(search));
  const int code =
      report_failed(result.failed, result.runs, ", and count against every requirement");
  return code != exit_code::done || is_met(result) ? code : exit_code::not_met;
}

/// Writes the files of a study that is finished. @return margin.json's text
std::string write_files(const Campaign& campaign, const MarginResult& result,
                        const MarginReport& report, const std::filesystem::path& out) {
  std::string json = json_text(margin_json(report, stamp_json(stamp_of(campaign, {}))));
  write_file(out / margin_csv_file, margin_csv(campaign, result));
  write_file(out / motorization_csv_file, motorization_csv(campaign, report.motorization));
  write_recommended(campaign, result, out);
  write_file(out / margin_json_file, json); // the last: with it the folder is complete
  return json;
}

/// What there is to say of a study that was finished before.
int conclude_finished_margin(const Json& study) {
  const int code = report_failed(study.value("runs_failed", 0L), study.value("runs", 0L),
                                 ", and count against every requirement");
  return code != exit_code::done || study.value("met", false) ? code : exit_code::not_met;
}

/// What was finished before it was stopped; the rest is in the log.
int keep_unfinished(const Campaign& campaign, const MarginResult& result, Checkpoint& log,
                    const std::filesystem::path& out) {
  write_file(out / margin_csv_file, margin_csv(campaign, result));
  log.sync();
  fmt::print(stderr,
             "interrupted: {} runs are kept; the same command with --resume goes on (the scales "
             "that were finished are in {})\n",
             log.rows(), (out / margin_csv_file).string());
  return exit_code::interrupted;
}

Json about_study(const Campaign& campaign, const std::optional<Shard>& shard) {
  return {{stamp_key, stamp_json(stamp_of(campaign, shard))}};
}

/// What makes a shard of the study.
ShardMaker maker_of(const MarginOptions& options) {
  ShardMaker maker{"wingspread margin " + shell_word(options.campaign.string()), ""};
  if (options.sampling.runs) maker.more += fmt::format(" --runs {}", *options.sampling.runs);
  if (options.sampling.seed) maker.more += fmt::format(" --seed {}", *options.sampling.seed);
  return maker;
}

/// A part of the runs of the looks that do not depend on others.
int margin_shard(const Campaign& campaign, const MarginOptions& options, const Shard& shard) {
  if (!options.from.empty())
    throw SpecError(
        {{"", "--from", "it with --shard", "one of them: shards are made, then taken"}});
  const Json about = about_study(campaign, shard);
  StudyFolder folder(options.out, about, shard_file, options.resume);
  const Interrupt interrupt;
  const auto maker = evaluator_of(crew_of(options.crew), interrupt.flag());
  CheckpointedEvaluator evaluator(*maker, folder.log(), interrupt.flag());
  Progress progress(stderr);
  try {
    const long runs =
        make_first_looks(campaign, shard, evaluator, [&](const StudyProgress& so_far) {
          progress.show(tally_of(so_far, folder.log().read()));
        });
    warn_if_damaged(folder.log(), options.out);
    folder.log().sync();
    Json study = about;
    study["runs"] = runs;
    write_file(options.out / shard_file, json_text(study));
  } catch (const Stopped&) {
    folder.log().sync();
    fmt::print(stderr, "interrupted: {} runs are kept; the same command with --resume goes on\n",
               folder.log().rows());
    return exit_code::interrupted;
  }
  fmt::print("{}\n", (options.out / shard_file).string());
  fmt::print(stderr,
             "note: {} of the first looks: --from, with the folders of all shards, goes on\n",
             describe(shard));
  return exit_code::done;
}

/// @throws MissingRuns when shards that it is to go on from are missing
int margin_study(const MarginOptions& options) {
  Campaign campaign = read_campaign_file(options.campaign);
  override_sampling(campaign, options.sampling.runs, options.sampling.seed);
  if (const auto shard = parse_shard(options.shard)) return margin_shard(campaign, options, *shard);
  const Json about = about_study(campaign, std::nullopt);
  StudyFolder folder(options.out, about, margin_json_file, options.resume);
  if (folder.is_finished())
    return conclude_finished_margin(show_finished(options.out / margin_json_file, options.json));
  const Interrupt interrupt;
  const auto maker = evaluator_of(crew_of(options.crew), interrupt.flag());
  CheckpointedEvaluator logged(*maker, folder.log(), interrupt.flag());
  ShardCheckpoints evaluator(options.from, about, campaign.sampling.runs, maker_of(options), logged,
                             interrupt.flag());
  Progress progress(stderr);
  MarginResult result;
  try {
    const auto show = [&](const StudyProgress& so_far) {
      progress.show(tally_of(so_far, folder.log().read() + evaluator.read()));
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
  return conclude(campaign, result);
}

int margin(const MarginOptions& options) {
  try {
    return margin_study(options);
  } catch (const MissingRuns& missing) {
    return refuse_missing(missing, "");
  }
}

} // namespace

void add_margin(CLI::App& app, Action& action) {
  const auto options = std::make_shared<MarginOptions>();
  CLI::App* command = app.add_subcommand(
      "margin", "How strong the springs may be: the window in which all requirements are met");
  command->add_option("campaign", options->campaign, "The campaign, a JSON file")->required();
  command->add_option("--out", options->out, "The folder for the results: new, or empty")
      ->required();
  add_sampling_options(*command, options->sampling);
  add_crew_options(*command, options->crew);
  command->add_flag("--resume", options->resume, "Go on where an earlier one stopped");
  command
      ->add_option("--shard", options->shard,
                   "Only part I of N of the runs at the first scales, e.g. 2/5 (see below)")
      ->type_name("I/N")
      ->check(refuse_shard);
  command->add_option("--from", options->from, "The folders of all shards, made before")
      ->type_name("DIR…");
  command->add_flag("--json", options->json, "Print JSON in place of the report");
  command->footer(
      R"(Scales what the campaign's "margin" names, runs the same draws at every scale, judges the
campaign's requirements there, and finds the scales between which all of them are met: each edge
to 1 % ("tolerance"), with the requirement that sets it and how many runs break it on either side.
An end of the range is no edge: where nothing fails there, it is widened until something does, or
to the limits in "widest"; without both edges nothing is recommended. The recommended scale is the
one at which the requirement that is worst off is best off, by the share of runs that break it
over the share that may; what it gives up against the present springs is said, and it is run again
with a seed of its own. Weaker springs are not advised where static margins of the nominal wing
would be negative. Where no scale will do, it says which requirements rule that out. All runs are
made: "until" is of no account here. They go only as far as the requirements need: where none is
about a peak, a run that fails after its last latch has deployed here, and has failed in
wingspread run. Each verdict holds with its requirement's confidence; the report says what all of
them and both edges come to together.

  "margin": { "scale": ["hinges.*.spring.torque_stowed", "hinges.*.spring.torque_latched"],
              "range": [0.5, 2] }

  mode                joint: all together, the default; each: one hinge after the other
  widest              how far the range may be widened, an eighth and eight times if left out
  points, tolerance   scales looked at first, 13; how closely an edge is located, 0.01
  cases               ["nominal"], ["nominal", "one_spring_out"]: each hinge loses one of
  springs_per_hinge   its springs in turn, 2 if left out
  motorization        factors of the static margins, by ECSS, NASA, GEVS and AIAA

The folder gets margin.json, margin.csv (all that was seen at every scale), motorization.csv (the
static margins at every angle of the travel) and recommended.json, the campaign with the
recommended springs. Until it is finished it has looks.log, all runs so far: after an
interruption, a crash or a kill the same command with --resume goes on to the same bytes.

What the first scales (the grid, and 1) come to decides where it looks next; they themselves
depend on nothing, and are most of a study. So they can be made in shards, on machines that know
nothing of each other, each with its part of the runs at every one of them; --from then goes on
from all shards, to the bytes of one process. Exit code 0: there is a window, and in it a scale to
recommend; 1: there is none, or the other seed does not confirm it.

Example:
  wingspread margin campaign.json --out results/margin
  wingspread run results/margin/recommended.json --out results/resized
  wingspread margin campaign.json --shard 1/2 --out results/part1
  wingspread margin campaign.json --shard 2/2 --out results/part2
  wingspread margin campaign.json --from results/part1 results/part2 --out results/margin)");
  command->callback([options, &action] { action = [options] { return margin(*options); }; });
}

} // namespace wingspread
