/// trajectory.csv: every accepted step of one run, and both sides of an engagement.
#pragma once

#include "core/deployment.hpp"

#include <filesystem>
#include <fstream>

namespace wingspread {

/// Writes `t`, `HINGE.angle`, `HINGE.rate` and `HINGE.moment` for each hinge, `kinetic`,
/// `potential` and `total`, with 17 significant digits, as the run goes on.
class TrajectoryWriter {
public:
  /// Writes the header. @throws SpecError when the file cannot be written
  TrajectoryWriter(std::filesystem::path path, const Scene& scene);

  /// What to hand to the run. @pre the writer outlives it
  [[nodiscard]] Observer observer();

  /// @throws SpecError unless all of it is in the file
  void finish();

private:
  void write(const Sample& sample);

  std::filesystem::path path_;
  std::ofstream out_;
};

} // namespace wingspread
