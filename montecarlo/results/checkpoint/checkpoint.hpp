/// The checkpoint of a study (`margin`, `rare`): every row it was given, so that an interrupted study can continue.
///
/// A study asks for runs analysis by analysis, and its next question depends on the rows so far. It is deterministic:
/// given the same rows in the same order, it continues where it was. A checkpoint takes 40 to 150 bytes per run and
/// is read in constant memory.
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

/// @param there identity that a file records; an array stands for its length
/// @throws SpecError with each of our values that differs
void refuse_other_study(const std::filesystem::path& file, const Json& there, const Json& ours);

/// The study a checkpoint belongs to. @throws SpecError if its first record is damaged
[[nodiscard]] Json about_of_log(const std::filesystem::path& file);

/// Reads the recorded analyses of a study, and then appends new ones.
class Checkpoint {
public:
  /// Opens the file if it exists; else the first analysis creates it.
  /// @param about which study it is: an object; equal to the recorded one
  /// @throws SpecError if it belongs to another study, with each value that differs, or is no checkpoint
  Checkpoint(std::filesystem::path file, Json about);

  /// Begins the next analysis, and delivers its recorded rows.
  /// @param stop once true, no more rows are delivered
  /// @return rows delivered
  /// @throws SpecError if the checkpoint continues with another analysis, or its draws differ on this machine
  long enter(const RunPlan& plan, RunRange range, const BatchSink& sink,
             const std::atomic<bool>& stop);

  /// Whether the next recorded analysis is this one.
  [[nodiscard]] bool has_next(const RunPlan& plan, RunRange range) const;

  /// Appends rows of the analysis. Writes to the device every five seconds.
  /// @pre all its recorded rows were delivered
  /// @throws as refuse_path (machine_error.hpp) if the file cannot be written
  void add(const Batch& batch);

  /// Writes everything to the device.
  void sync();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Rows read so far; rows in the file.
  [[nodiscard]] long read() const { return read_; }
  [[nodiscard]] long rows() const { return rows_; }
  /// Whether records after those read were damaged and cut off.
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
  std::optional<RecordsEnd> end_; ///< of the records read: where to append
  Clock::time_point synced_ = Clock::now();
  long analyses_ = 0, rows_ = 0, read_ = 0;
  bool damaged_ = false;
};

} // namespace wingspread
