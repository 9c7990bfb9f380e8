/// The columns of a trajectory: their names, and their numbers in a sample of a run.
#pragma once

#include "core/outcome.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The columns: `t`, `HINGE.angle`, `HINGE.rate` and `HINGE.moment` for each hinge, `kinetic`, `potential` and
/// `total`; for a moving base `base.angle` and `base.rate`, for a free one also `base.position.0` and
/// `base.position.1`.
[[nodiscard]] std::vector<std::string> trajectory_columns(const Scene& scene);
/// The SI unit of a column; `t` is not among them.
[[nodiscard]] std::string_view unit_of_column(const std::string& name);
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

} // namespace wingspread
