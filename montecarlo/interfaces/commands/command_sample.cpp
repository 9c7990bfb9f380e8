#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <fmt/format.h>

#include <functional>

namespace wingspread {
namespace {

struct SampleOptions {
  std::filesystem::path campaign, out;
  std::string of_case;
  SamplingOptions sampling;
};

/// Writes CSV to the sink, in blocks: a column `run`, and one for each dispersion.
void write_draws(const RunPlan& plan, const std::function<void(std::string_view)>& sink) {
  constexpr std::size_t block_bytes = 1 << 16;
  std::string block = "run";
  for (const std::string& name : plan.names().draws) append_csv_cells(block, name);
  block += '\n';
  std::vector<double> draws(plan.names().draws.size());
  for (long k = 0; k < plan.campaign().sampling.runs; ++k) {
    append_csv_cell(block, k);
    plan.draw(k, draws);
    for (const double draw : draws) append_csv_cells(block, draw);
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
  if (options.out.empty()) {
    write_draws(plan, [](std::string_view block) { fmt::print("{}", block); });
    return exit_code::done;
  }
  WholeFile out(options.out);
  write_draws(plan, [&](std::string_view block) { out.write(block); });
  out.finish();
  return exit_code::done;
}

void add_sample_options(CLI::App& command, SampleOptions& options) {
  command.add_option("campaign", options.campaign, "The campaign, a JSON file")->required();
  add_sampling_options(command, options.sampling);
  add_case_option(command, options.of_case);
  command.add_option("--out", options.out, "Write to this file; default: standard output");
  command.footer(R"(These are the draws that `run` uses, to the last bit.

Example:
  wingspread sample campaign.json --runs 100 > draws.csv)");
}

} // namespace

void add_sample(CLI::App& app, Action& action) {
  add_command<SampleOptions>(app, action, "sample", "Print a campaign's draws as CSV",
                             add_sample_options, sample);
}

} // namespace wingspread
