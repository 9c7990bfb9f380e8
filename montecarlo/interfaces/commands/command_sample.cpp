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
#include <utility>
#include <vector>

namespace wingspread {
namespace {

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
  add_case_option(command, options.of_case);
  command.add_flag("--applied", options.applied,
                   "Print the parameters that the draws change, as each run has them");
  command.add_option("--out", options.out, "Write to this file; default: standard output");
  command.footer(
      R"(These are the draws that `run` uses, to the last bit. With --applied there is a column for each
parameter of the scene that a draw changes, named by its path, in SI units: the nominal value, set,
scaled and added to by all draws of the run, tables included.

Example:
  wingspread sample campaign.json --runs 100 > draws.csv
  wingspread sample campaign.json --case cold --applied > parameters.csv)");
}

} // namespace

void add_sample(CLI::App& app, Action& action) {
  add_command<SampleOptions>(app, action, "sample", "Print a campaign's draws as CSV",
                             add_sample_options, sample);
}

} // namespace wingspread
