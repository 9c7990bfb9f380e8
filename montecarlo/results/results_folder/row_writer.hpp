/// Rows that come batch by batch: kept for the statistics, and appended to their file.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/formats/files.hpp"

#include <chrono>
#include <filesystem>
#include <optional>

namespace wingspread {

/// The rows of a folder that is being made. Whatever is left of the file, after a signal or a
/// crash, can be gone on with.
class RowWriter {
public:
  RowWriter(std::filesystem::path file, const ResultNames& names);

  /// Takes what was read of the file, and cuts off what is behind its last complete row.
  /// @throws SpecError unless the runs follow each other from `first` on without a gap
  void go_on_behind(ResultsFile&& read, long first);

  /// Opens the file; a new one gets its header. To be called once, before the first batch.
  /// @throws as refuse_path (machine_error.hpp) does when it cannot be written, here and below
  void open(const ResultNames& names);

  /// Adds the next rows, to the file and to memory; where memory has no more room for them (its temporary
  /// files do not), to the file alone from then on. Every ten seconds it sees to it that they are on the device.
  void add(const Batch& batch);

  /// Sees to it that all rows are on the device, and closes the file. Once, and as the last.
  void finish();

  /// How many rows there are in the file.
  [[nodiscard]] long count() const { return count_; }
  /// @throws MachineError when there was no room for them
  [[nodiscard]] const Results& results() const;

private:
  using Clock = std::chrono::steady_clock;

  void keep(const Batch& batch);

  std::filesystem::path file_;
  Results results_;
  std::optional<OutputFile> out_;
  Clock::time_point synced_ = Clock::now();
  long count_ = 0;
  std::optional<MachineError> no_room_;
};

/// @throws SpecError unless the runs follow each other from `first` on without a gap
/// @param file that they are from
void refuse_gaps(const Results& results, long first, const std::filesystem::path& file);

} // namespace wingspread
