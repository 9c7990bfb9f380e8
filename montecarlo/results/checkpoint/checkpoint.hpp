/// The checkpoint of a study (`margin`, `rare`): a file with every row that the study has received, so that an
/// interrupted study can continue.
///
/// A study asks for runs in a sequence of analyses, and each analysis depends on the rows before. The study is
/// deterministic: if it receives the recorded rows again, in the same order, it asks for the same analyses. A
/// checkpoint takes 40 to 150 bytes per run and is read in constant memory.
///
/// An "analysis" is here all runs that a study asks for at once (for `margin` a case at a scale). The key `checkpoints`
/// of summary.json is something else: the interim analyses of a campaign with `until`.
///
///   record 1     JSON: which study the checkpoint belongs to
///   'L' · text   an analysis begins (analysis_id.hpp)
///   'R' …        its rows (row_records.hpp)
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/checkpoint/record_file.hpp"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace wingspread {

/// Compares the identity of a study with the one recorded in a file.
/// @param there the recorded identity; an array in it is compared by its length
/// @throws SpecError with each value of `ours` that differs
void refuse_other_study(const std::filesystem::path& file, const Json& there, const Json& ours);

/// The identity of the study that a checkpoint belongs to. @throws SpecError if the first record is damaged
[[nodiscard]] Json about_of_log(const std::filesystem::path& file);

/// Reads the recorded analyses of a study, and then appends new ones.
class Checkpoint {
public:
  /// Opens the file if it exists; else the first analysis creates it.
  /// @param about identity of the study, a JSON object; a recorded identity must be equal
  /// @throws SpecError if the file belongs to another study, with each value that differs, or is no checkpoint
  Checkpoint(std::filesystem::path file, Json about);

  /// Begins the next analysis, and delivers its recorded rows.
  /// @param stop once true, no more rows are delivered
  /// @return number of rows delivered
  /// @throws SpecError if the checkpoint continues with another analysis, or this machine computes other draws or
  ///   another last row
  long enter(const RunPlan& plan, RunRange range, const BatchSink& sink,
             const std::atomic<bool>& stop);

  /// Whether the next recorded analysis is this one.
  [[nodiscard]] bool has_next(const RunPlan& plan, RunRange range) const;

  /// Appends rows of the current analysis. Writes to the device every five seconds.
  /// @pre enter() has delivered all recorded rows of the analysis
  /// @throws as refuse_path (machine_error.hpp) if the file cannot be written
  void add(const Batch& batch);

  /// Writes everything to the device.
  void sync();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Rows read from the file so far.
  [[nodiscard]] long read() const { return read_; }
  /// Rows read or added so far.
  [[nodiscard]] long rows() const { return rows_; }
  /// Whether damaged records followed the valid ones. They are ignored, and cut off before new records are appended.
  [[nodiscard]] bool was_damaged() const { return damaged_; }

private:
  using Clock = std::chrono::steady_clock;

  void read_ahead();
  void begin(const std::string& id);
  [[nodiscard]] bool has(char mark) const;
  [[nodiscard]] SpecError other_analysis(const std::string& id) const;

  std::filesystem::path file_;
  Json about_;
  std::optional<RecordReader> in_; ///< while unused records are left
  std::optional<RecordWriter> out_;
  std::optional<RecordsEnd> end_; ///< of the valid records, where to append; set once all are read
  Clock::time_point synced_ = Clock::now();
  long analyses_ = 0, rows_ = 0, read_ = 0;
  bool damaged_ = false;
};

} // namespace wingspread
