/// A run of a results folder, made again.
#pragma once

#include "montecarlo/results/results_folder/results_folder.hpp"

#include <optional>

namespace wingspread {

struct Replayed {
  Outcome outcome;
  ResultRow row;
  ResultNames names;
  std::string
      file; ///< whose rows it is compared with: runs.csv or, of a folder without rows, broken_runs.csv
  bool recorded = false; ///< whether that has the run
  /// A line for each column in which the recorded row differs from this one by as much as a bit.
  std::vector<std::string> differences;
};

/// Run k's row of rows_file(), if it is there. Cost: of a logarithm of the file's length, in time and memory.
/// @throws SpecError when what is read of it is broken
[[nodiscard]] std::optional<ResultRow> find_stored_row(const StoredCampaign& stored, long run);

/// Asks for run k of a folder.
class ReplayRequest {
public:
  /// @pre the campaign outlives the request
  /// @throws SpecError when the campaign has no such run, or runs.csv is broken
  ReplayRequest(const StoredCampaign& stored, long run);

  /// @param observer sees the trajectory
  [[nodiscard]] Replayed replay(const Observer& observer) const;

private:
  const StoredCampaign* stored_;
  long run_;
  std::optional<ResultRow> recorded_;
};

/// A line for each column in which two rows of one table differ, by as much as a bit.
[[nodiscard]] std::vector<std::string>
differences(const ResultNames& names, const ResultRow& recorded, const ResultRow& computed);

/// Makes a row again, before more are put behind it: on another machine, with another library of mathematics or by a
/// program that was changed it may come out otherwise, and so may the next ones.
/// @param file that the row is from
/// @throws SpecError with each column that differs by as much as a bit
void refuse_other_row(const RunPlan& plan, const ResultRow& recorded,
                      const std::filesystem::path& file);
/// The same of the last of the rows.
void refuse_other_rows(const RunPlan& plan, const Results& results,
                       const std::filesystem::path& file);

} // namespace wingspread
