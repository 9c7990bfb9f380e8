#include "montecarlo/analyses/fit/fit_folder.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <limits>

namespace wingspread {
namespace {

struct FitCommandOptions {
  std::filesystem::path campaign, tests, out;
  std::optional<std::uint64_t> seed;
  std::optional<long> runs;
  MachineOptions machine;
  bool resume = false, json = false;
};

/// The state of the chains on a terminal.
class ChainProgress {
public:
  explicit ChainProgress(double wanted) : wanted_(wanted), shown_(is_terminal(stderr)) {}
  void show(const EnsembleState& state) const {
    if (shown_)
      print_message(
          "\rsampling: {} runs, effective sample size {:.0f} of {:.0f}, split R-hat {:.4f}   ",
          state.evaluations, state.ess, wanted_, state.r_hat);
  }
  ~ChainProgress() {
    if (shown_) print_message("\n");
  }
  ChainProgress(const ChainProgress&) = delete;
  ChainProgress& operator=(const ChainProgress&) = delete;

private:
  double wanted_;
  bool shown_;
};

/// Warns of parameters at limits of their priors where the printed output does not begin with it.
void warn_of_limits(const Json& fit) {
  for (const auto& [name, parameter] : fit.at("parameters").items())
    if (parameter.contains("at_limit"))
      print_message("warning: {} lies at the limit {:.6g} of its prior: widen its law\n", name,
                    parameter["at_limit"].get<double>());
}

int exit_of(bool finished) { return finished ? exit_code::done : exit_code::not_met; }

int report_unfinished() {
  print_message("not finished: the chains are kept; the same command with --resume and a larger "
                "--runs continues\n");
  return exit_of(false);
}

/// Refuses tests that no run resembles before the folder is made. @return false if interrupted
bool can_predict(const Campaign& campaign, const FitSpec& spec, const FitOptions& options,
                 const std::string& file, const std::atomic<bool>& stop) {
  try {
    refuse_unpredictable(campaign, spec, options, file, stop);
    return true;
  } catch (const Stopped&) {
    print_message("interrupted: nothing is written\n");
    return false;
  }
}

int fit(const FitCommandOptions& given) {
  Campaign campaign = read_campaign_file(given.campaign);
  print_warnings(check_campaign(campaign, given.campaign), false);
  override_sampling(campaign, std::nullopt, given.seed);
  const FitSpec spec = read_fit_file(given.tests, campaign);
  FitOptions options{.pool = pool_of(given.machine)};
  options.most_runs = given.runs.value_or(0);
  const Interrupt interrupt;
  if (!can_predict(campaign, spec, options, given.tests.string(), interrupt.flag()))
    return exit_code::interrupted;
  FitFolder folder(given.out, about_fit(campaign, spec), given.resume);
  if (folder.is_finished()) {
    warn_of_limits(show_finished(given.out / fit_json_file, given.json));
    return exit_of(true);
  }
  try {
    FitResult result;
    {
      const ChainProgress progress(static_cast<double>(spec.samples));
      result = fit_campaign(campaign, spec, options, interrupt.flag(), &folder.log(),
                            [&](const EnsembleState& state) { progress.show(state); });
    }
    folder.write(result, campaign, spec, options.pool, interrupt.flag());
    const std::string written = read_text(given.out / fit_json_file).value_or("");
    fmt::print("{}", given.json ? written : fit_text(result, spec));
    if (given.json) warn_of_limits(Json::parse(written));
    return result.finished ? exit_of(true) : report_unfinished();
  } catch (const Stopped&) {
    if (!folder.is_finished()) folder.log().sync();
    print_message("interrupted: the chains are kept; the same command with --resume continues\n");
    return exit_code::interrupted;
  }
}

void add_fit_options(CLI::App& command, FitCommandOptions& options) {
  command.add_option("campaign", options.campaign, "The campaign, a JSON file")->required();
  command.add_option("tests", options.tests, "The tests and the parameters to fit, a JSON file")
      ->required();
  command.add_option("--out", options.out, "The folder of the results: new or empty")->required();
  command.add_flag("--resume", options.resume,
                   "Continue an interrupted or unfinished fit in --out");
  within(command.add_option("--runs", options.runs,
                            "Most runs of the sampler a test; default: 400 a sample"),
         smallest_run_limit(), std::numeric_limits<long>::max())
      ->type_name("N");
  add_seed_option(command, options.seed);
  add_machine_options(command, options.machine);
  command.add_flag("--json", options.json, "Print fit.json, not text");
  command.footer(
      R"(Fits parameters of the wing to deployment tests. The priors are the laws of the campaign's
dispersions; the tests' file names those to be fitted, each test's changes of the scene, its traces
(CSV files) and its measured values:

  { "tests": [ { "name": "air, 20 C", "case": "ambient", "set": { "environment.air_density": 1.2 },
                 "trace": { "file": "t1.csv", "time": "t_s", "time_offset_std": "0.01 s",
                            "columns": { "root.angle": { "column": "th1", "unit": "deg",
                                                         "std": "0.3 deg", "offset_std": "0.2 deg" } } },
                 "values": [ { "output": "root.latch_time", "value": "4.93 s", "std": "0.02 s" } ] } ],
    "fit": { "parameters": [ "spring", "friction.*" ], "starts": 8, "samples": 10000 } }

Writes posterior.csv (a row a sample), fit.json, traces.csv (measured, fitted, bands) and
campaign.json, which draws whole rows of posterior.csv: `wingspread run DIR/campaign.json` is the
prediction. Prints first whether the model fits at all, then the parameters, what the tests do not
see, and what further tests ("candidates") would tell. Dispersions that are not fitted are held at
their medians. Exit code 1: the chains are not finished. A model that does not fit is told, with 0; so is
a parameter at a limit of its prior ("at_limits" in fit.json). With more than eight parameters the
least --runs grows in proportion.

Example:
  wingspread fit campaign.json tests.json --out fit
  wingspread run fit/campaign.json --out flight)");
}

} // namespace

void add_fit(CLI::App& app, Action& action) {
  add_command<FitCommandOptions>(app, action, "fit",
                                 "Fit parameters to deployment tests; predict the flight",
                                 add_fit_options, fit);
}

} // namespace wingspread
