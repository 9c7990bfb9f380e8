/// Repeats a run of a results folder.
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
  bool recorded = false; ///< whether that file has the run
  /// A line for each column whose recorded value differs from this run in any bit.
  std::vector<std::string> differences;
};

/// Run k's row of rows_file(), if it is there. Cost: logarithmic in the file's length, in time and memory.
/// @throws SpecError if a row read on the way is broken
[[nodiscard]] std::optional<ResultRow> find_stored_row(const StoredCampaign& stored, long run);

/// A checked request for run k of a folder.
class ReplayRequest {
public:
  /// @pre the campaign outlives the request
  /// @throws SpecError if the campaign has no such run, or runs.csv is broken
  ReplayRequest(const StoredCampaign& stored, long run);

  /// @param observer receives the trajectory
  [[nodiscard]] Replayed replay(const Observer& observer) const;

private:
  const StoredCampaign* stored_;
  long run_;
  std::optional<ResultRow> recorded_;
};

/// A line for each column in which two rows of one table differ, by as much as a bit.
[[nodiscard]] std::vector<std::string>
/// A line for each column in which two rows differ in any bit.
differences(const ResultNames& names, const ResultRow& recorded, const ResultRow& computed);

/// Repeats a recorded row before more are appended. On another machine, with another math library or after a change
/// of the program it may differ, and so may the next rows.
/// @param file of the row
/// @throws SpecError with each column that differs in any bit
void refuse_other_row(const RunPlan& plan, const ResultRow& recorded,
                      const std::filesystem::path& file);
/// refuse_other_row() for the last row.
void refuse_other_rows(const RunPlan& plan, const Results& results,
                       const std::filesystem::path& file);

} // namespace wingspread
