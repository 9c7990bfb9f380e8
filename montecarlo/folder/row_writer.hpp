/// Rows that come batch by batch: kept for the statistics, and appended to their file.
#pragma once

#include "montecarlo/runs/evaluator.hpp"
#include "montecarlo/runs/results.hpp"

#include <filesystem>
#include <fstream>

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
  /// @throws SpecError when it cannot be written
  void open(const ResultNames& names);

  /// Adds the next rows, to memory and to the file. @throws SpecError when they cannot be written
  void add(const Batch& batch);

  [[nodiscard]] const Results& results() const { return results_; }

private:
  std::filesystem::path file_;
  Results results_;
  std::ofstream out_;
};

/// @throws SpecError unless the runs follow each other from `first` on without a gap
/// @param file that they are from
void refuse_gaps(const Results& results, long first, const std::filesystem::path& file);

} // namespace wingspread
