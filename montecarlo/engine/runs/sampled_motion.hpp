/// Columns of a run's trajectory on a regular grid of times, and between the grid's times.
#pragma once

#include "montecarlo/engine/runs/trajectory_columns.hpp"

#include <span>
#include <vector>

namespace wingspread {

/// The columns that every run of a plan keeps, at multiples of an interval from 0 to t_end. No such run ends early.
struct SampledColumns {
  std::vector<std::size_t>
      columns; ///< indices into trajectory_columns(); a rate stands next to its angle
  double interval = 0, t_end = 0; ///< s, > 0
  bool operator==(const SampledColumns&) const = default;
};

/// The grid for a trace, s: 10 to 20 ms, at least 100 intervals. Finer costs time, see test_runs.hpp for the error.
[[nodiscard]] double grid_interval(std::span<const double> times);

/// The goal of a run for these columns: its motion to t_end, without peaks.
[[nodiscard]] Goal goal_of(const Scene& scene, const SampledColumns& columns);

/// The kind of a column. It decides how the column is interpolated.
enum class ColumnKind { angle, rate, other };

/// Collects a run's samples in a list of numbers. A sample adds two numbers for each column: its value, and for an
/// angle its rate, for a rate its angle.
class SampleTaker {
public:
  SampleTaker(const Scene& scene, const SampledColumns& columns);
  /// Appends one sample.
  void take(const Sample& sample, std::vector<double>& numbers);

private:
  BaseMotion base_;
  std::vector<std::size_t> columns_, partners_;
  std::vector<double> row_; ///< scratch
};

/// The motion of a run from its samples.
class SampledMotion {
public:
  SampledMotion(const Scene& scene, const SampledColumns& columns);

  /// Whether the numbers are the samples of a run that did not fail.
  [[nodiscard]] bool is_whole(std::span<const double> numbers) const;
  /// The value of SampledColumns::columns[which] at time t; before and after the run the value at its ends. Between
  /// samples, angles and rates are those of the cubic with the angles and rates of both; other columns are linear.
  /// @pre is_whole(numbers)
  [[nodiscard]] double at(std::span<const double> numbers, std::size_t which, double t) const;

private:
  double interval_;
  std::vector<ColumnKind> kinds_; ///< by column
};

} // namespace wingspread
