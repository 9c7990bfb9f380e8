/// Columns of a run's trajectory on a regular grid of times, and between the grid's times.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/engine/runs/trajectory_columns.hpp"

#include <span>
#include <vector>

namespace wingspread {

/// The grid for a trace, s: 10 to 20 ms, at least 100 intervals. Finer costs time, see test_runs.hpp for the error.
[[nodiscard]] double grid_interval(std::span<const double> times);

/// Some columns of one trajectory. Reuses its storage from run to run; one object a thread.
class SampledMotion {
public:
  /// @param columns indices into trajectory_columns(); an angle's rate follows the angle
  SampledMotion(const Scene& scene, std::vector<std::size_t> columns);

  /// Runs the scene to t_end and samples it. @return false if the run is invalid or failed
  [[nodiscard]] bool run(Deployment& deployment, const Scene& scene, Integration integration,
                         double t_end, double interval);

  /// The column number `which` of those given at a time; times before and after the run take the value at its ends.
  [[nodiscard]] double at(std::size_t which, double t) const;

private:
  BaseMotion base_;
  std::vector<std::size_t> columns_;
  std::vector<bool> is_angle_;
  double interval_ = 1;
  std::vector<double> numbers_; ///< sample by sample: each column, and an angle's rate
  std::size_t samples_ = 0;
  std::vector<double> row_; ///< scratch
};

} // namespace wingspread
