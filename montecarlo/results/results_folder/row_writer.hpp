/// Appends rows to their file batch by batch, and keeps them for the statistics.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/formats/files.hpp"

#include <chrono>
#include <filesystem>
#include <optional>

namespace wingspread {

/// The rows of a folder while its runs are made. After a signal or a crash the file can be continued.
class RowWriter {
public:
  /// Does not touch the file before continue_after() or open(). @param names of the columns
  RowWriter(std::filesystem::path file, const ResultNames& names);

  /// Takes the rows read from the file, and cuts off bytes after its last complete row.
  /// @throws SpecError unless runs follow each other from `first` without a gap, below the header that open() writes
  void continue_after(ResultsFile&& read, long first);

  /// Opens the file; writes the header of a new one. Call once, before the first batch.
  /// @throws as refuse_path (machine_error.hpp) if it cannot be written, here and below
  void open();

  /// Appends the next rows to the file, and keeps them for results(). If memory and temporary files are full, drops all
  /// kept rows and only writes the file from then on. Writes to the device every ten seconds.
  void add(const Batch& batch);

  /// Writes all rows to the device and closes the file. Call once, after the last add().
  void finish();

  /// Rows in the file.
  [[nodiscard]] long count() const { return count_; }
  /// @throws MachineError if there was no room for the rows
  [[nodiscard]] const Results& results() const;

private:
  using Clock = std::chrono::steady_clock;

  void keep(const Batch& batch);

  std::filesystem::path file_;
  ResultNames names_;
  Results results_;
  std::optional<OutputFile> out_;
  Clock::time_point synced_ = Clock::now();
  long count_ = 0;
  std::optional<MachineError> no_room_;
};

/// @throws SpecError unless runs follow each other from `first` without a gap
/// @param file of the rows, for the message
void refuse_gaps(const Results& results, long first, const std::filesystem::path& file);

} // namespace wingspread
