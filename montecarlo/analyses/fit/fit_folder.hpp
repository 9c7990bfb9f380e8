/// The folder of a fit.
#pragma once

#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/foundation/platform/folder_lock.hpp"

#include <filesystem>
#include <optional>

namespace wingspread {

/// A folder with posterior.csv, campaign.json, traces.csv and fit.json; until the chains are finished, with a
/// checkpoint.
class FitFolder {
public:
  /// Opens or creates the folder, as lock_study_folder and is_finished_study (study_folder.hpp).
  FitFolder(std::filesystem::path folder, const Json& about, bool resume);

  /// Whether an earlier session finished the study.
  [[nodiscard]] bool is_finished() const { return !log_; }
  /// @pre the study is not finished
  [[nodiscard]] BatchLog& log() { return *log_; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

  /// Writes the results; adds the prediction: runs of the campaign before and after the fit. Removes the checkpoint if
  /// the chains are finished.
  void write(FitResult& result, const Campaign& campaign, const FitSpec& spec, ThreadPool pool,
             const std::atomic<bool>& stop);

private:
  std::filesystem::path folder_;
  Json about_;
  std::optional<FolderLock> lock_;
  std::optional<BatchLog> log_;
};

/// Outputs with the priors and with the posterior, over the first runs of both campaigns.
[[nodiscard]] FitPrediction predict(const Campaign& before, const Campaign& after, ThreadPool pool,
                                    const std::atomic<bool>& stop);

} // namespace wingspread
