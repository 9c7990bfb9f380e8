/// trajectory.csv: every accepted step of one run, and both sides of an engagement; or a regular grid of times.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/formats/files.hpp"

#include <filesystem>
#include <string>

namespace wingspread {

/// Writes `t`, `HINGE.angle`, `HINGE.rate` and `HINGE.moment` for each hinge, `kinetic`,
/// `potential` and `total`; of a base that moves `base.angle` and `base.rate`, of a free one `base.position.0` and
/// `base.position.1` too; with 17 significant digits, as the run goes on.
class TrajectoryWriter {
public:
  /// Begins the file. @throws as refuse_path (machine_error.hpp) does when the file cannot be written
  TrajectoryWriter(std::filesystem::path path, const Scene& scene);

  /// What to hand to the run. @pre the writer outlives it
  [[nodiscard]] Observer observer();

  /// @throws as refuse_path does unless all of it is in the file
  void finish();

private:
  void write(const Sample& sample);

  WholeFile out_;
  BaseMotion base_;
  std::string block_; ///< lines that are still to be written
};

} // namespace wingspread
