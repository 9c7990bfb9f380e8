#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/commands/command_options.hpp"
#include "montecarlo/commands/commands.hpp"
#include "montecarlo/commands/results_display.hpp"
#include "montecarlo/folder/merge.hpp"
#include "montecarlo/formats/number_text.hpp"
#include "montecarlo/machine/folder_lock.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace wingspread {
namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
  Display display;
};

struct AnalyzeOptions {
  std::filesystem::path folder;
  std::vector<double> quantiles;
  std::optional<double> confidence;
  std::string bins;
  std::filesystem::path requirements;
  Display display;
};

int merge(const MergeOptions& options) {
  const Summary summary = merge_folders(options.folders, options.out);
  return show_results(read_stored_campaign(options.out), summary, options.display);
}

/// A whole number as such, so that it is read as one; anything else as text, to be refused.
Json bins_given(const std::string& text) {
  const auto number = parse_number<std::int64_t>(text);
  return number ? Json(*number) : Json(text);
}

int analyze(const AnalyzeOptions& options) {
  (void)read_any_campaign(options.folder); // there is one to be locked
  const FolderLock lock(options.folder);
  StoredCampaign stored = read_any_campaign(options.folder);
  StatisticsSpec spec = stored.campaign.statistics;
  Json given = Json::object();
  if (!options.quantiles.empty()) given["quantiles"] = options.quantiles;
  if (options.confidence) given["confidence"] = *options.confidence;
  if (!options.bins.empty()) given["bins"] = bins_given(options.bins);
  override_settings(given, [&](const JsonCursor& at) { read_statistics(at, spec); });
  if (!options.requirements.empty())
    stored.campaign.requirements = read_requirements_file(options.requirements, stored.campaign);
  const Summary summary = write_statistics(stored, read_stored_results(stored).results, spec);
  return show_results(stored, summary, options.display);
}

} // namespace

void add_merge(CLI::App& app, Action& action) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "Put the shards of a campaign together");
  command->add_option("folders", options->folders, "The shards' results folders, in any order")
      ->required();
  command->add_option("--out", options->out, "The results folder to write: new, or empty")
      ->required();
  add_display_options(*command, options->display);
  command->footer(std::string("The result is what running the campaign in one go gives, byte for "
                              "byte.\n") +
                  display_help + R"(
Example:
  wingspread merge results/part1 results/part2 --out results/whole)");
  command->callback([options, &action] { action = [options] { return merge(*options); }; });
}

void add_analyze(CLI::App& app, Action& action) {
  const auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command =
      app.add_subcommand("analyze", "Work out the statistics again, from a folder's runs.csv");
  command->add_option("folder", options->folder, "The results folder")->required();
  command->add_option("--quantiles", options->quantiles, "Others than the campaign's, e.g. 0.1,0.9")
      ->delimiter(',');
  command->add_option("--confidence", options->confidence, "Of all bounds, e.g. 0.99");
  command->add_option("--bins", options->bins, "Of the histograms: a number, or auto");
  command->add_option("--requirements", options->requirements,
                      "In place of the campaign's: a JSON file, an array of requirements");
  add_display_options(*command, options->display);
  command->footer(std::string("Rewrites summary.json, histograms.json and histograms.csv.\n") +
                  display_help +
                  R"(Exit code 1 says that a requirement is not shown to be met.

For the runs of another tool, put a campaign.json beside its runs.csv, with as many runs in its
"sampling"; the columns run, status, latch_order, the draws and the outputs may stand in any order.

Example:
  wingspread analyze results/first --quantiles 0.001,0.5,0.999 --histograms)");
  command->callback([options, &action] { action = [options] { return analyze(*options); }; });
}

} // namespace wingspread
