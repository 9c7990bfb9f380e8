#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/campaign/describe.hpp"
#include "montecarlo/commands/cli.hpp"
#include "montecarlo/commands/command_options.hpp"
#include "montecarlo/commands/commands.hpp"
#include "montecarlo/commands/method_list.hpp"
#include "montecarlo/folder/version.hpp"
#include "montecarlo/formats/files.hpp"
#include "montecarlo/formats/json.hpp"
#include "montecarlo/runs/run_plan.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <memory>

namespace wingspread {
namespace {

struct SampleOptions {
  std::filesystem::path campaign, out;
  SamplingOptions sampling;
};

int check(const std::filesystem::path& file) {
  const std::variant<Scene, Campaign> read = read_file(file);
  const auto text = std::visit([](const auto& spec) { return describe(spec); }, read);
  fmt::print("{}{}", text, text.ends_with('\n') ? "" : "\n");
  return exit_code::done;
}

/// `run`, then a column for each draw.
void write_draws(const RunPlan& plan, std::ostream& out) {
  std::string line = "run";
  for (const std::string& name : plan.names().draws) append_csv_cells(line, name);
  std::vector<double> draws(plan.names().draws.size());
  for (long k = 0; k < plan.campaign().sampling.runs && out; ++k) {
    out << line << '\n';
    line = std::to_string(k);
    plan.draw(k, draws);
    for (const double draw : draws) append_csv_cells(line, draw);
  }
  out << line << '\n' << std::flush;
}

int sample(const SampleOptions& options) {
  Campaign campaign = read_campaign_file(options.campaign);
  override_sampling(campaign, options.sampling.runs, options.sampling.seed);
  const RunPlan plan(campaign);
  if (options.out.empty()) {
    write_draws(plan, std::cout);
    return exit_code::done;
  }
  std::ofstream out(options.out, std::ios::binary | std::ios::trunc);
  if (out) write_draws(plan, out);
  if (!out) throw unwritable(options.out);
  return exit_code::done;
}

int list_methods(bool json) {
  fmt::print("{}", json ? json_text(methods_json(methods())) : methods_text(methods()));
  return exit_code::done;
}

} // namespace

std::string version_text() { return fmt::format("wingspread {}", version()); }

void add_check(CLI::App& app, Action& action) {
  const auto file = std::make_shared<std::filesystem::path>();
  CLI::App* command =
      app.add_subcommand("check", "Validate a scene or a campaign, and say what it holds");
  command->add_option("file", *file, "The scene or campaign, a JSON file")->required();
  command->footer(
      R"(All problems are reported together, each with its place; the exit code is then 2.

Example:
  wingspread check campaign.json)");
  command->callback([file, &action] { action = [file] { return check(*file); }; });
}

void add_sample(CLI::App& app, Action& action) {
  const auto options = std::make_shared<SampleOptions>();
  CLI::App* command = app.add_subcommand("sample", "The draws of a campaign alone, as CSV");
  command->add_option("campaign", options->campaign, "The campaign, a JSON file")->required();
  add_sampling_options(*command, options->sampling);
  command->add_option("--out", options->out, "Write to this file, not to standard output");
  command->footer(R"(They are the draws that `run` applies, to the last bit.

Example:
  wingspread sample campaign.json --runs 100 > draws.csv)");
  command->callback([options, &action] { action = [options] { return sample(*options); }; });
}

void add_methods(CLI::App& app, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("methods", "The integration methods, and what they can do");
  command->add_flag("--json", *json, "Print them as JSON");
  command->footer("Example:\n  wingspread methods");
  command->callback([json, &action] { action = [json] { return list_methods(*json); }; });
}

void add_version(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("version", "The program's version");
  command->footer("Example:\n  wingspread version");
  command->callback([&action] {
    action = [] {
      fmt::print("{}\n", version_text());
      return exit_code::done;
    };
  });
}

} // namespace wingspread
