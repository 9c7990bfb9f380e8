/// trajectory.csv: every accepted step of a run and both sides of each engagement, or a regular grid of times.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/files.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace wingspread {

/// The columns: `t`, `HINGE.angle`, `HINGE.rate` and `HINGE.moment` for each hinge, `kinetic`, `potential` and
/// `total`; for a moving base `base.angle` and `base.rate`, for a free one also `base.position.0` and
/// `base.position.1`.
[[nodiscard]] std::vector<std::string> trajectory_columns(const Scene& scene);
/// Passes a row's numbers to `take`, one by one in the order of the columns. @param base the scene's base
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
