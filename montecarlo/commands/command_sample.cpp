#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/commands/command_options.hpp"
#include "montecarlo/commands/commands.hpp"
#include "montecarlo/formats/csv.hpp"
#include "montecarlo/formats/files.hpp"
#include "montecarlo/runs/run_plan.hpp"

#include <CLI/CLI.hpp>

#include <fstream>
#include <iostream>
#include <memory>

namespace wingspread {
namespace {

struct SampleOptions {
  std::filesystem::path campaign, out;
  SamplingOptions sampling;
};

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

} // namespace

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

} // namespace wingspread
