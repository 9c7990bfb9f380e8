// Measures whether work should go into more runs or into a tighter tolerance. The error of a campaign's mean has two parts,
//
//     sampling      σ / √N                         by N runs, σ the output's standard deviation
//     integration   | mean of e |                  by a tolerance, e the error of a run; | mean of e | ≤ RMS of e
//
// and N runs at a tolerance cost N times a run's evaluations. Measures four things for three campaigns: σ; the spread of
// block means against σ/√N; e against a reference at rtol 1e-12 by another method; evaluations and time.
//
//   build/release/studies/error_budget                 20,000 runs of each campaign for σ, 200 for errors; minutes
//   build/release/studies/error_budget --quick         400 and 16

#include "core/deployment.hpp"
#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "studies/support/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <numeric>
#include <vector>

using namespace wingspread;

namespace {

constexpr const char* campaigns[] = {"work_precision", "seed", "yoke_wing"};
constexpr double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11};
constexpr double reference_rtol = 1e-12;

struct Sizes {
  long sample, repeated, counted; ///< runs for σ, for errors, for evaluations
};

struct Tables {
  study::Table errors{"campaign", "rtol",  "runs", "in doubt",   "evaluations", "cpu [us]",
                      "output",   "sigma", "rms",  "mean error", "largest"};
  study::Table sampling{"campaign", "output", "runs", "blocks", "spread", "sigma"};
};

Integration at_tolerance(Integration how, const char* method, double rtol) {
  how.method = method, how.rtol = rtol, how.atol = rtol / 100;
  return how;
}

std::vector<long> first_runs(long count) {
  std::vector<long> runs(static_cast<std::size_t>(count));
  std::iota(runs.begin(), runs.end(), 0L);
  return runs;
}

double evaluations_of(const Campaign& campaign, long runs) {
  const RunPlan plan(campaign);
  Runner runner(plan);
  double evaluations = 0;
  for (long k = 0; k < runs; ++k)
    evaluations += static_cast<double>(runner.replay(k, {}).outcome.work.rhs_evaluations);
  return evaluations / static_cast<double>(runs);
}

std::vector<double> values_of(const std::vector<ResultRow>& rows, std::size_t output) {
  std::vector<double> values;
  for (const ResultRow& row : rows)
    if (!std::isnan(row.outputs[output])) values.push_back(row.outputs[output]);
  return values;
}

/// Adds rows with the spread of the means of blocks of N runs about the mean of all runs, and with σ/√N.
void add_sampling(const std::string& name, const std::string& output,
                  const std::vector<double>& values, Tables& tables) {
  const Moments all = moments(values);
  for (const std::size_t runs : {100U, 300U, 1000U}) {
    const std::size_t blocks = values.size() / runs;
    if (blocks < 4) continue;
    double squares = 0;
    for (std::size_t block = 0; block < blocks; ++block)
      squares +=
          std::pow(moments(std::span(values).subspan(block * runs, runs)).mean - all.mean, 2);
    tables.sampling.add({name, output, static_cast<double>(runs), static_cast<double>(blocks),
                         std::sqrt(squares / static_cast<double>(blocks - 1)), all.std});
  }
}

/// Errors e of one output, over runs with the reference's status and latch order.
struct Errors {
  double mean = 0, rms = 0, largest = 0;
};

Errors errors_of(const std::vector<ResultRow>& rows, const std::vector<ResultRow>& reference,
                 const Accuracy& found, std::size_t output) {
  double sum = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (const double e = rows[i].outputs[output] - reference[i].outputs[output];
        !std::isnan(e) && std::ranges::find(found.in_doubt, rows[i].run) == found.in_doubt.end())
      sum += e;
  const OutputAccuracy& its = found.outputs[output];
  return {sum / static_cast<double>(std::max(1L, its.runs)), its.rms, its.largest};
}

void study_tolerance(Campaign campaign, const std::string& name, double rtol,
                     const std::vector<ResultRow>& reference, const std::vector<double>& sigma,
                     const Sizes& sizes, Tables& tables) {
  campaign.integration = at_tolerance(campaign.integration, "auto", rtol);
  const ResultNames names = RunPlan(campaign).names();
  const std::clock_t began = std::clock(); // of the processor: others share the machine
  const std::vector<ResultRow> rows =
      repeat_runs(campaign, campaign.integration, first_runs(sizes.repeated), {.threads = 1});
  const double microseconds = 1e6 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC /
                              static_cast<double>(sizes.repeated);
  const Accuracy found = compare_rows(names, rows, reference, campaign.integration);
  const double evaluations = evaluations_of(campaign, sizes.counted);
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    if (!(sigma[i] > 0)) continue;
    const auto [mean, rms, largest] = errors_of(rows, reference, found, i);
    tables.errors.add({name, rtol, static_cast<double>(sizes.repeated),
                       static_cast<double>(found.in_doubt.size()), evaluations, microseconds,
                       names.outputs[i], sigma[i], rms, mean, largest});
  }
  fmt::print("{:16} {:8.0e} {:10.0f} evaluations {:8.0f} us, {} of {} in doubt\n", name, rtol,
             evaluations, microseconds, found.in_doubt.size(), sizes.repeated);
}

void study_campaign(const std::string& name, const Sizes& sizes, Tables& tables) {
  Campaign campaign = read_campaign_file(fmt::format("studies/campaigns/{}.json", name));
  campaign.cases.clear();
  campaign.outputs = {OutputFamily::latch_time, OutputFamily::latch_rate, OutputFamily::peak_moment,
                      OutputFamily::peak_force};
  campaign.sampling.runs = sizes.sample;
  const ResultNames names = RunPlan(campaign).names();
  const std::vector<ResultRow> sample = repeat_runs(
      campaign, at_tolerance(campaign.integration, "auto", 1e-6), first_runs(sizes.sample), {});
  std::vector<double> sigma;
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    const std::vector<double> values = values_of(sample, i);
    sigma.push_back(moments(values).std);
    add_sampling(name, names.outputs[i], values, tables);
  }
  const std::vector<ResultRow> reference =
      repeat_runs(campaign, at_tolerance(campaign.integration, "dopri5", reference_rtol),
                  first_runs(sizes.repeated), {});
  for (const double rtol : tolerances)
    study_tolerance(campaign, name, rtol, reference, sigma, sizes, tables);
}

void study_all(const study::StudyOptions& options) {
  const Sizes sizes = options.quick ? Sizes{400, 16, 4} : Sizes{20'000, 200, 40};
  Tables tables;
  for (const char* name : campaigns) study_campaign(name, sizes, tables);
  tables.errors.write(options.folder / "error_budget.csv");
  tables.sampling.write(options.folder / "sampling.csv");
}

} // namespace

int main(int count, char** arguments) {
  return study::run_study(count, arguments, "error_budget",
                          "Numerical and statistical error together: where work is best spent",
                          study_all);
}
