#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/quantity.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/checkpoint/checkpointed_evaluator.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace wingspread {
namespace {

constexpr long most_samples = 10'000'000, most_repeats = 1000;

struct RareCommandOptions {
  std::filesystem::path campaign, out;
  std::string output, of_case;
  std::string above, below; ///< limits as they are written; empty: not given
  std::optional<std::uint64_t> seed;
  std::optional<double> confidence;
  RareOptions rare;
  MachineOptions machine;
  bool resume = false, json = false, absolute = false;
};

/// The limit in the output's unit. @throws SpecError when it is neither a finite number nor a quantity of the output's
/// kind
double limit_of(const RareCommandOptions& options) {
  const bool above = !options.above.empty();
  const std::string& text = above ? options.above : options.below;
  const std::string unit = parse_output_name(options.output).unit;
  const auto limit = parse_quantity(text, unit);
  if (limit && std::isfinite(*limit)) return *limit;
  throw SpecError({{"", above ? "--above" : "--below", '"' + text + '"',
                    limit ? "a finite number" : expected_quantity({unit})}});
}

/// The event whose probability is asked for.
/// @throws SpecError unless the options name an output with one finite limit, or neither
RareEvent event_of(const RareCommandOptions& options) {
  const int limits = int(!options.above.empty()) + int(!options.below.empty());
  if (limits != (options.output.empty() ? 0 : 1))
    throw SpecError({{"", "--output",
                      fmt::format("{} with {}", options.output.empty() ? "none" : options.output,
                                  limits == 0   ? "no limit"
                                  : limits == 1 ? "one limit"
                                                : "two limits"),
                      "an output with either --above or --below; or none of the "
                      "three, and the event is that the wing does not deploy"}});
  if (options.absolute && limits == 0)
    throw SpecError({{"", "--abs", "--abs without --output", "an output and its limit"}});
  return {options.output, limits == 0 ? 0 : limit_of(options), !options.above.empty(),
          options.absolute};
}

/// @throws SpecError for a limit on a time after t_end: a hinge that has not latched by then has no time
void refuse_late_limit(const RareCommandOptions& options, const Campaign& campaign) {
  const double t_end = campaign.integration.t_end;
  if (options.output.empty() || !is_late_limit(options.output, limit_of(options), t_end)) return;
  throw SpecError(
      {{"", options.above.empty() ? "--below" : "--above", fmt::format("{} s", limit_of(options)),
        fmt::format("at most t_end, {} s: later latches are not seen (raise t_end for a "
                    "later limit)",
                    t_end)}});
}

std::string refuse_odd_samples(const std::string& text) {
  return text.ends_with('0') ? "" : fmt::format("found {}, expected a multiple of 10", text);
}

void warn(const std::vector<std::string>& doubts) {
  for (const std::string& doubt : doubts) print_message("warning: {}\n", doubt);
}

/// The values that identify the study. A folder with other values is refused.
Json about_study(const RareOptions& options, const Campaign& campaign) {
  return {
      {stamp_key, stamp_json(stamp_of(campaign, {}))},
      {"event", describe(options.event)},
      {"beyond", event_json(options.event)}, // the limit in full; the event's text has six digits
      {"confidence", options.confidence},
      {"samples", options.samples},
      {"repeats", options.repeats}};
}

/// Opens the study's folder. @return null without --out
std::unique_ptr<StudyFolder> open_folder(const RareCommandOptions& given,
                                         const RareOptions& options, const Campaign& campaign) {
  if (given.resume && given.out.empty())
    throw SpecError(
        {{"", "--resume", "--resume without --out", "the folder to continue in --out"}});
  if (given.out.empty()) return nullptr;
  return std::make_unique<StudyFolder>(given.out, about_study(options, campaign), rare_json_file,
                                       given.resume);
}

/// Repeats the warnings of a study that an earlier session finished. @return the exit status
int report_finished_rare(const Json& study) {
  warn(study.value("warnings", std::vector<std::string>{}));
  return report_failed(study.value("statuses", Json::object()).value("failed", 0L),
                       study.value("runs", 0L), ", and count as the event");
}

/// Keeps the checkpoint of an interrupted study. @return the exit status
int keep_unfinished(StudyFolder* folder) {
  if (folder) folder->log().sync();
  print_message("interrupted: {}\n",
                folder ? fmt::format("{} runs are kept; the same command with --resume continues",
                                     folder->log().rows())
                       : "nothing is kept without --out");
  return exit_code::interrupted;
}

/// Prints the result and completes the folder. @return the exit status
int write_result(const RareResult& result, const RareOptions& options, const Campaign& campaign,
                 const RareCommandOptions& given, StudyFolder* folder) {
  const Json about = stamp_json(stamp_of(campaign, {}));
  const std::string json = json_text(rare_json(result, options, campaign, about));
  if (folder) {
    warn_if_damaged(folder->log(), given.out);
    write_file(given.out / rare_json_file, json);
    folder->finish();
  }
  fmt::print("{}", given.json ? json : rare_text(result, options, campaign));
  warn(doubts_of(result));
  return report_failed(result.statuses[static_cast<std::size_t>(Status::failed)],
                       result.estimate.evaluations, ", and count as the event");
}

int rare(const RareCommandOptions& given) {
  RareOptions options = given.rare;
  options.event = event_of(given);
  const Campaign whole = read_campaign_file(given.campaign);
  print_warnings(check_campaign(whole, given.campaign), false);
  Campaign campaign = chosen_case(whole, given.of_case);
  override_sampling(campaign, std::nullopt, given.seed);
  refuse_late_limit(given, campaign);
  options.confidence = confidence_of(given.confidence, campaign.statistics);
  const auto folder = open_folder(given, options, campaign);
  if (folder && folder->is_finished())
    return report_finished_rare(show_finished(given.out / rare_json_file, given.json));
  const Interrupt interrupt;
  const auto maker = evaluator_of(pool_of(given.machine), interrupt.flag());
  std::optional<CheckpointedEvaluator> logged;
  if (folder) logged.emplace(*maker, folder->log(), interrupt.flag());
  Evaluator& evaluator = logged ? *logged : *maker;
  Progress progress(stderr);
  try {
    const auto show = [&](const StudyProgress& so_far) {
      progress.show(counts_of(so_far, folder ? folder->log().read() : 0));
    };
    const RareResult result = estimate_rare_event(campaign, options, evaluator, show);
    return write_result(result, options, campaign, given, folder.get());
  } catch (const Stopped&) {
    return keep_unfinished(folder.get());
  }
}

void add_rare_options(CLI::App& command, RareCommandOptions& options) {
  command.add_option("campaign", options.campaign, "The campaign, a JSON file")->required();
  command
      .add_option("--output", options.output,
                  "The output with a limit; default: the event is not deployed")
      ->type_name("NAME");
  command
      .add_option("--above", options.above,
                  "The event: a value above X, in SI units or with its unit: \"350 N*m\"")
      ->type_name("X");
  command
      .add_option("--below", options.below,
                  "The event: a value below X, in SI units or with its unit: \"5 deg/s\"")
      ->type_name("X");
  command.add_flag("--abs", options.absolute, "The limit is on the value's magnitude");
  within(command.add_option("--samples", options.rare.samples,
                            "Runs of a level, a multiple of 10; default: 2000"),
         100, most_samples)
      ->check(refuse_odd_samples)
      ->type_name("N");
  within(command.add_option("--repeats", options.rare.repeats,
                            "Number of independent repeats; default: 5"),
         1, most_repeats)
      ->type_name("R");
  command.add_option("--out", options.out,
                     "A folder for rare.json, which `report` draws: new or empty");
  command.add_flag("--resume", options.resume, "Continue an interrupted study in --out");
  add_seed_option(command, options.seed);
  add_case_option(command, options.of_case);
  add_confidence_option(command, options.confidence);
  add_machine_options(command, options.machine);
  command.add_flag("--json", options.json, "Print JSON, not text");
  command.footer(
      R"(Estimates probabilities that are too small to count runs, by subset simulation: the runs nearest to
the event start Markov chains that come nearer, level by level; each level is a tenth as likely as
the one before. A probability of one in a million takes some ten thousand runs.

The coefficient of variation is the estimate's standard deviation as a share of the estimate; the
independent repeats show it too. The estimate is biased high by 0.5 of one repeat's squared
coefficient of variation: more --samples reduce the bias, more --repeats do not. Draws are
independent, whatever the campaign's design. A value of a discrete dispersion that is too rare to be
drawn (a release that fails, one in 100,000) is simulated by itself, with its exact probability.

If the simulation does not reach the event, it prints the estimated probability of the last level:
an estimated upper bound, not guaranteed.

A run without the output (it stalled before, or failed) counts as the event. So does a run whose
peak t_end cut, as it breaks a requirement in `wingspread run`, unless --below X is given and the
peak has reached X; their number is printed. A longer t_end ("integration" in the campaign) decides
them, or a warning says why none does. A run that did not deploy but has the output counts by its
value, although it breaks every requirement in `wingspread run`.

With --out the folder has looks.log, a checkpoint of all runs, until the study is finished: after an
interruption, a crash or a kill the same command with --resume gives the same bytes.

Example:
  wingspread rare campaign.json
  wingspread rare campaign.json --output root.peak_moment --above 400 --samples 4000 --out rare)");
}

} // namespace

void add_rare(CLI::App& app, Action& action) {
  add_command<RareCommandOptions>(app, action, "rare",
                                  "Estimate small probabilities: not deployed, or a limit exceeded",
                                  add_rare_options, rare);
}

} // namespace wingspread
