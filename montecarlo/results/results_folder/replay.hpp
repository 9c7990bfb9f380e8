/// Repeats a run of a results folder.
#pragma once

#include "montecarlo/results/results_folder/results_folder.hpp"

#include <optional>

namespace wingspread {

struct Replayed {
  Outcome outcome;
  ResultRow row;
  Scene scene; ///< as the run's draws left it
  ResultNames names;
  /// The file of recorded rows: runs.csv or, in a folder made with --no-rows, broken_runs.csv.
  std::string file;
  bool recorded = false; ///< whether the file has the run
  /// A line for each column whose recorded value differs from this run in any bit.
  std::vector<std::string> differences;
};

/// The run's row in rows_file(), if the file has it. Cost: time logarithmic in the file's length.
/// @throws SpecError if a row read on the way is broken
[[nodiscard]] std::optional<ResultRow> find_stored_row(const StoredCampaign& stored, long run);

/// A checked request for run k of a folder.
class ReplayRequest {
public:
  /// @pre the campaign outlives the request
  /// @throws SpecError if the campaign has no such run, or runs.csv is broken
  ReplayRequest(const StoredCampaign& stored, long run);

  /// The scene as the run's draws leave it.
  [[nodiscard]] Scene applied_scene() const;
  /// @param observer receives the trajectory
  /// @param interval between its samples, s; 0: every step
  [[nodiscard]] Replayed replay(const Observer& observer, double interval = 0) const;

private:
  const StoredCampaign* stored_;
  long run_;
  std::optional<ResultRow> recorded_;
};

/// A line for each column in which two rows differ in any bit.
[[nodiscard]] std::vector<std::string>
differences(const ResultNames& names, const ResultRow& recorded, const ResultRow& computed);

/// Computes a recorded row again before more rows are appended, and refuses to continue if it differs. It may differ
/// on another machine, with another math library or after a change of the program; the next rows then might too.
/// @param file that has the row
/// @throws SpecError with each column that differs in any bit
void refuse_other_row(const RunPlan& plan, const ResultRow& recorded,
                      const std::filesystem::path& file);
/// refuse_other_row() for the last row.
void refuse_other_rows(const RunPlan& plan, const Results& results,
                       const std::filesystem::path& file);

} // namespace wingspread
