/// The looks of a study in a file: read as far as they go, and from there on written.
///
///   record 1     JSON: whose log it is
///   'L' · text   a look begins (analysis_id.hpp)
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

/// @param there what a file says of whose it is; an array in place of a number says it by how many it has
/// @throws SpecError with each of our values that differs from it
void refuse_other_study(const std::filesystem::path& file, const Json& there, const Json& ours);

/// What a log says of whose it is. @throws SpecError when it does not
[[nodiscard]] Json about_of_log(const std::filesystem::path& file);

class Checkpoint {
public:
  /// Opens the file, if it is there; it is made with the first look.
  /// @param about whose log it is: an object; it has to be the same to go on
  /// @throws SpecError when it is another's, with each value that differs, or no log
  Checkpoint(std::filesystem::path file, Json about);

  /// Enters the next look, and hands on what there is of its rows.
  /// @param stop once true, no more are handed on
  /// @return how many were
  /// @throws SpecError when the log goes on with another look, or with rows that do not come out the same here
  long enter(const RunPlan& plan, RunRange range, const BatchSink& sink,
             const std::atomic<bool>& stop);

  /// Whether the next look in it is this one.
  [[nodiscard]] bool has_next(const RunPlan& plan, RunRange range) const;

  /// Adds the next rows of the look. Every five seconds it sees to it that they are on the device.
  /// @pre all that there was of it was handed on
  /// @throws as refuse_path (machine_error.hpp) does when they cannot be written
  void add(const Batch& batch);

  /// Sees to it that all is on the device.
  void sync();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// How many rows were read so far, and how many are in it.
  [[nodiscard]] long read() const { return read_; }
  [[nodiscard]] long rows() const { return rows_; }
  /// Whether what followed the rows that were read was damaged, and was cut off.
  [[nodiscard]] bool was_damaged() const { return damaged_; }

private:
  using Clock = std::chrono::steady_clock;

  void read_ahead();
  void begin(const std::string& id);
  [[nodiscard]] bool has(char mark) const;
  [[nodiscard]] SpecError other_look(const std::string& id) const;

  std::filesystem::path file_;
  Json about_;
  std::optional<RecordReader> in_; ///< as long as there is a record that is not used
  std::optional<RecordWriter> out_;
  std::optional<RecordsEnd> end_; ///< of what was read, where it is to be gone on with
  Clock::time_point synced_ = Clock::now();
  long looks_ = 0, rows_ = 0, read_ = 0;
  bool damaged_ = false;
};

} // namespace wingspread
