#include "montecarlo/analyses/fit/fit_folder.hpp"

#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"
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

struct FirstRuns {
  std::vector<OutputOfRuns> outputs;
  long deployed = 0;
};

/// Runs of the campaign's laws; a design has all of them, however many runs the campaign has.
FirstRuns first_runs(Campaign campaign, ThreadPool pool, const std::atomic<bool>& stop) {
  campaign.sampling.replicates =
      std::min(campaign.sampling.replicates, std::int64_t{predicted_runs});
  override_sampling(campaign, predicted_runs, std::nullopt);
  const RunPlan plan(campaign);
  const std::vector<std::string>& names = plan.names().outputs;
  FirstRuns first{std::vector<OutputOfRuns>(names.size())};
  auto& outputs = first.outputs;
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) {
      first.deployed += row.status == Status::deployed;
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (std::isfinite(row.outputs[i])) outputs[i].values.push_back(row.outputs[i]);
        if (is_cut(peak_kind(names[i]), row.peaks_final.value_or(PeaksFinal::unknown)))
          ++outputs[i].cut;
      }
    }
  };
  if (evaluator_of(pool, stop)->make(plan, {0, predicted_runs}, {keep}) < predicted_runs)
    throw Stopped{};
  for (OutputOfRuns& output : outputs) std::ranges::sort(output.values);
  return first;
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
    result.prediction = predict(campaign, read_campaign_file(path), pool, stop);
  }
  write_file(folder_ / fit_json_file, json_text(fit_json(result, spec, about_)));
  if (!result.finished) return log_->sync();
  log_.reset();
  remove_checkpoint(folder_);
}

FitPrediction predict(const Campaign& before, const Campaign& after, ThreadPool pool,
                      const std::atomic<bool>& stop) {
  const std::vector<std::string> names = RunPlan(before).names().outputs;
  const FirstRuns first = first_runs(before, pool, stop), second = first_runs(after, pool, stop);
  constexpr auto runs = static_cast<double>(predicted_runs);
  FitPrediction all{
      {static_cast<double>(first.deployed) / runs, static_cast<double>(second.deployed) / runs}};
  all.never_final = why_never_final(before, after);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto quantiles = [&](const OutputOfRuns& output) {
      const long present = std::ssize(output.values);
      const PartialRanks ranks{present, predicted_runs - present,
                               missing_rank(before.requirements, names[i])};
      std::array<double, 3> found{};
      for (std::size_t k = 0; k < found.size(); ++k)
        found[k] = quantile(output.values, ranks, predicted_quantiles[k]);
      return found;
    };
    const OutputOfRuns &one = first.outputs[i], &other = second.outputs[i];
    if (one.values.empty() && other.values.empty()) continue;
    all.outputs.push_back({names[i], quantiles(one), quantiles(other), one.cut + other.cut});
  }
  return all;
}

} // namespace wingspread
