/// trajectory.csv: every accepted step of a run and both sides of each event, or a regular grid of times.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/engine/runs/trajectory_columns.hpp"
#include "montecarlo/foundation/formats/files.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace wingspread {

/// Writes the rows during the run, with 17 significant digits.
class TrajectoryWriter {
public:
  /// Opens the file. @throws as refuse_path (machine_error.hpp) does when the file cannot be written
  TrajectoryWriter(std::filesystem::path path, const Scene& scene);

  /// The observer to pass to the run. @pre the writer outlives it
  [[nodiscard]] Observer observer();

  /// Writes the rest and closes the file. @throws as refuse_path does unless the file is complete
  void finish();

private:
  void write(const Sample& sample);

  WholeFile out_;
  BaseMotion base_;
  std::string block_; ///< lines not yet written
};

} // namespace wingspread
