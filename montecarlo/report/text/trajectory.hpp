/// trajectory.csv: every accepted step of one run, and both sides of an engagement; or a regular grid of times.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/files.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace wingspread {

/// The columns: `t`, `HINGE.angle`, `HINGE.rate` and `HINGE.moment` for each hinge, `kinetic`, `potential` and
/// `total`; of a base that moves `base.angle` and `base.rate`, of a free one `base.position.0` and
/// `base.position.1` too.
[[nodiscard]] std::vector<std::string> trajectory_columns(const Scene& scene);
/// A row, into what takes its numbers one by one in the order of the columns. @param base of the scene
template <class Take> void take_sample(const Sample& sample, BaseMotion base, const Take& take) {
  take(sample.t);
  for (std::size_t i = 0; i < sample.angles.size(); ++i)
    for (const double value : {sample.angles[i], sample.rates[i], sample.moments[i]}) take(value);
  for (const double value : {sample.kinetic, sample.potential, sample.kinetic + sample.potential})
    take(value);
  if (base == BaseMotion::fixed) return;
  for (const double value : {sample.base_angle, sample.base_rate}) take(value);
  if (base != BaseMotion::free) return;
  for (const double value : {sample.base_position[0], sample.base_position[1]}) take(value);
}

/// Writes them with 17 significant digits, as the run goes on.
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
