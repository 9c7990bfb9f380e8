#include "montecarlo/analyses/rare/rare_report.hpp"
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
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace wingspread {
namespace {

constexpr long most_samples = 10'000'000, most_repeats = 1000;

struct RareCommandOptions {
  std::filesystem::path campaign, out;
  std::string output, of_case;
  std::optional<double> above, below;
  std::optional<std::uint64_t> seed;
  std::optional<double> confidence;
  RareOptions rare;
  CrewOptions crew;
  bool resume = false, json = false;
};

/// @throws SpecError unless there is an output with one finite limit, or neither
RareEvent event_of(const RareCommandOptions& options) {
  const int limits = int(options.above.has_value()) + int(options.below.has_value());
  const double limit = options.above.value_or(options.below.value_or(0));
  if (limits != (options.output.empty() ? 0 : 1) || !std::isfinite(limit))
    throw SpecError({{"", "--output",
                      fmt::format("{} with {} limits",
                                  options.output.empty() ? "none" : options.output, limits),
                      "an output with --above or --below and a finite limit, or none of them for "
                      "the wing not to deploy"}});
  return {options.output, limit, options.above.has_value()};
}

std::string refuse_odd_samples(const std::string& text) {
  return text.ends_with('0') ? "" : fmt::format("found {}, expected a multiple of 10", text);
}

int warn_of_failures(const RareResult& result) {
  const long invalid = result.statuses[static_cast<std::size_t>(Status::invalid)];
  const long failed = result.statuses[static_cast<std::size_t>(Status::failed)];
  if (invalid > 0)
    fmt::print(stderr, "warning: {} of {} runs had an unphysical draw, and count as the event\n",
               invalid, result.estimate.evaluations);
  return report_failed(failed, result.estimate.evaluations, ", and count as the event");
}

void warn_if_doubtful(const RareResult& result) {
  if (std::ranges::any_of(result.estimates, &SubsetEstimate::stuck))
    fmt::print(stderr, "warning: some levels had runs that are all as far from the event as each "
                       "other, so the way to it was not found\n");
  if (result.estimate.from_spread > 2 * result.estimate.from_chains)
    fmt::print(stderr, "warning: the repeats differ by more than their chains account for: take "
                       "more --samples\n");
}

/// Whose study it is.
Json about_study(const RareOptions& options, const Campaign& campaign) {
  return {{stamp_key, stamp_json(stamp_of(campaign, {}))},
          {"event", describe(options.event)},
          {"confidence", options.confidence},
          {"samples", options.samples},
          {"repeats", options.repeats}};
}

/// Its folder, where there is one.
std::unique_ptr<StudyFolder> open_folder(const RareCommandOptions& given,
                                         const RareOptions& options, const Campaign& campaign) {
  if (given.resume && given.out.empty())
    throw SpecError({{"", "--resume", "no --out", "the folder to go on with"}});
  if (given.out.empty()) return nullptr;
  return std::make_unique<StudyFolder>(given.out, about_study(options, campaign), rare_json_file,
                                       given.resume);
}

/// What there is to say of a study that was finished before.
int conclude_finished_rare(const Json& study) {
  return report_failed(study["statuses"].value("failed", 0L), study.value("runs", 0L),
                       ", and count as the event");
}

int keep_unfinished(StudyFolder* folder) {
  if (folder) folder->log().sync();
  fmt::print(stderr, "interrupted: {}\n",
             folder ? fmt::format("{} runs are kept; the same command with --resume goes on",
                                  folder->log().rows())
                    : "nothing is kept without --out");
  return exit_code::interrupted;
}

/// What the options make of the campaign's own.
double confidence_of(const RareCommandOptions& given, StatisticsSpec spec) {
  Json settings = Json::object();
  if (given.confidence) settings["confidence"] = *given.confidence;
  override_settings(settings, [&](const JsonCursor& at) { read_statistics(at, spec); });
  return spec.confidence;
}

/// Says what it came to, and finishes its folder.
int conclude(const RareResult& result, const RareOptions& options, const Campaign& campaign,
             const RareCommandOptions& given, StudyFolder* folder) {
  const Json about = stamp_json(stamp_of(campaign, {}));
  const std::string json = json_text(rare_json(result, options, campaign, about));
  if (folder) {
    warn_if_damaged(folder->log(), given.out);
    write_file(given.out / rare_json_file, json);
    folder->finish();
  }
  fmt::print("{}", given.json ? json : rare_text(result, options, campaign));
  warn_if_doubtful(result);
  return warn_of_failures(result);
}

int rare(const RareCommandOptions& given) {
  RareOptions options = given.rare;
  options.event = event_of(given);
  Campaign campaign = chosen_case(read_campaign_file(given.campaign), given.of_case);
  override_sampling(campaign, std::nullopt, given.seed);
  options.confidence = confidence_of(given, campaign.statistics);
  const auto folder = open_folder(given, options, campaign);
  if (folder && folder->is_finished())
    return conclude_finished_rare(show_finished(given.out / rare_json_file, given.json));
  const Interrupt interrupt;
  const auto maker = evaluator_of(crew_of(given.crew), interrupt.flag());
  std::optional<CheckpointedEvaluator> logged;
  if (folder) logged.emplace(*maker, folder->log(), interrupt.flag());
  Evaluator& evaluator = logged ? *logged : *maker;
  Progress progress(stderr);
  try {
    const auto show = [&](const StudyProgress& so_far) {
      progress.show(tally_of(so_far, folder ? folder->log().read() : 0));
    };
    const RareResult result = estimate_rare_event(campaign, options, evaluator, show);
    return conclude(result, options, campaign, given, folder.get());
  } catch (const Stopped&) {
    return keep_unfinished(folder.get());
  }
}

} // namespace

void add_rare(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RareCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "rare", "Probabilities too small to count: not deployed, or an output beyond a limit");
  command->add_option("campaign", options->campaign, "The campaign, a JSON file")->required();
  command
      ->add_option("--output", options->output,
                   "The output with a limit; not to be deployed if left out")
      ->type_name("NAME");
  command->add_option("--above", options->above, "The event: a value above this")->type_name("X");
  command->add_option("--below", options->below, "The event: a value below this")->type_name("X");
  command
      ->add_option("--samples", options->rare.samples,
                   "Runs of a level, a multiple of 10; 2000 if left out")
      ->check(CLI::Range(100L, most_samples).description(""))
      ->check(refuse_odd_samples)
      ->type_name("N");
  command->add_option("--repeats", options->rare.repeats, "Independent ones; 5 if left out")
      ->check(CLI::Range(1L, most_repeats).description(""))
      ->type_name("R");
  command->add_option("--out", options->out,
                      "A folder for rare.json, which `report` draws: new, or empty");
  command->add_flag("--resume", options->resume,
                    "Go on where an earlier one with the same --out stopped");
  add_seed_option(*command, options->seed);
  add_case_option(*command, options->of_case);
  command->add_option("--confidence", options->confidence, "Of the bounds, e.g. 0.99");
  add_crew_options(*command, options->crew);
  command->add_flag("--json", options->json, "Print JSON in place of text");
  command->footer(
      R"(Subset simulation: runs that came nearest to the event are the start of chains that go nearer
still, level by level, each a tenth as likely as the one before. It takes some ten thousand runs for
one in a million. The variation is the estimate's standard deviation as a share of it; the repeats
are independent, and show it too. On average it is too large by 0.4 of a repeat's squared variation,
which more --samples reduce and more --repeats do not. Draws are independent ones, whatever the
campaign's design. Where no way led to the event, what is printed is the estimated probability of
the last level: more than the event's, but no proof of it.

A run that has no such output (it stalled before, or failed) counts as the event.

With --out all runs so far are in the folder's looks.log until it is finished: after an
interruption, a crash or a kill the same command with --resume goes on to the same bytes.

Example:
  wingspread rare campaign.json
  wingspread rare campaign.json --output root.peak_moment --above 400 --samples 4000 --out rare)");
  command->callback([options, &action] { action = [options] { return rare(*options); }; });
}

} // namespace wingspread
