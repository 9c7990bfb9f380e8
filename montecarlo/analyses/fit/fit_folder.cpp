#include "montecarlo/analyses/fit/fit_folder.hpp"

#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"

#include <algorithm>

namespace wingspread {
namespace {

constexpr std::array<double, 3> predicted_quantiles{0.05, 0.5, 0.95};

/// An output of the first runs.
struct OutputOfRuns {
  std::vector<double> values{}; ///< sorted, without missing ones
  long cut = 0;                 ///< runs whose peak t_end cut
};

/// The output columns of the first runs.
std::vector<OutputOfRuns> sorted_outputs(const Campaign& campaign, ThreadPool pool,
                                         const std::atomic<bool>& stop) {
  const RunPlan plan(campaign);
  const std::vector<std::string>& names = plan.names().outputs;
  std::vector<OutputOfRuns> outputs(names.size());
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows)
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (std::isfinite(row.outputs[i])) outputs[i].values.push_back(row.outputs[i]);
        if (is_cut(peak_kind(names[i]), row.peaks_final.value_or(PeaksFinal::unknown)))
          ++outputs[i].cut;
      }
  };
  if (evaluator_of(pool, stop)->make(plan, {0, predicted_runs}, {keep}) < predicted_runs)
    throw Stopped{};
  for (OutputOfRuns& output : outputs) std::ranges::sort(output.values);
  return outputs;
}

} // namespace

FitFolder::FitFolder(std::filesystem::path folder, const Json& about, bool resume)
    : folder_(std::move(folder)), about_(about) {
  lock_study_folder(folder_, fit_json_file, resume, lock_);
  if (!is_finished_study(folder_, fit_json_file, about))
    log_.emplace(folder_ / checkpoint_file, about);
}

void FitFolder::write(FitResult& result, const Campaign& campaign, const FitSpec& spec,
                      ThreadPool pool, const std::atomic<bool>& stop) {
  write_file(folder_ / traces_csv_file, traces_csv(result, spec));
  if (!result.posterior.columns.empty()) {
    const auto path = folder_ / campaign_file;
    write_file(folder_ / posterior_file, posterior_csv(result));
    write_file(path, json_text(predicting_campaign(campaign, result.posterior.columns)));
    result.beside_cases = !campaign.cases.empty();
    result.prediction = predicted_outputs(campaign, read_campaign_file(path), pool, stop);
  }
  write_file(folder_ / fit_json_file, json_text(fit_json(result, spec, about_)));
  if (!result.finished) return log_->sync();
  log_.reset();
  remove_checkpoint(folder_);
}

std::vector<PredictedOutput> predicted_outputs(const Campaign& before, const Campaign& after,
                                               ThreadPool pool, const std::atomic<bool>& stop) {
  const std::vector<std::string> names = RunPlan(before).names().outputs;
  const auto first = sorted_outputs(before, pool, stop), second = sorted_outputs(after, pool, stop);
  std::vector<PredictedOutput> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (first[i].values.empty() || second[i].values.empty()) continue;
    PredictedOutput& output = all.emplace_back(PredictedOutput{names[i]});
    output.cut = first[i].cut + second[i].cut;
    for (std::size_t k = 0; k < predicted_quantiles.size(); ++k) {
      output.before[k] = quantile(first[i].values, predicted_quantiles[k]);
      output.after[k] = quantile(second[i].values, predicted_quantiles[k]);
    }
  }
  return all;
}

} // namespace wingspread
