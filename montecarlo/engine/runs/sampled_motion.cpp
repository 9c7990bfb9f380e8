#include "montecarlo/engine/runs/sampled_motion.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

constexpr double finest = 0.01, coarsest = 0.02; // s
constexpr double least_intervals = 100;

/// Cubic Hermite interpolation between two samples. @param s in [0, 1]
double hermite(double s, double h, double y0, double v0, double y1, double v1) {
  const double r = 1 - s;
  return y0 * r * r * (1 + 2 * s) + y1 * s * s * (3 - 2 * s) + h * s * r * (v0 * r - v1 * s);
}

/// The slope of the same polynomial.
double hermite_slope(double s, double h, double y0, double v0, double y1, double v1) {
  return 6 * s * (1 - s) * (y1 - y0) / h + v0 * (1 - s) * (1 - 3 * s) + v1 * s * (3 * s - 2);
}

std::vector<ColumnKind> kinds_of(const Scene& scene, const SampledColumns& columns) {
  const std::vector<std::string> names = trajectory_columns(scene);
  std::vector<ColumnKind> kinds;
  for (const std::size_t column : columns.columns)
    kinds.push_back(names[column].ends_with(".angle")  ? ColumnKind::angle
                    : names[column].ends_with(".rate") ? ColumnKind::rate
                                                       : ColumnKind::other);
  return kinds;
}

/// Whether a column is moments or energies, which cost more than the motion.
bool is_load(const std::string& name) {
  return name.ends_with(".moment") || name == "kinetic" || name == "potential" || name == "total";
}

} // namespace

double grid_interval(std::span<const double> times) {
  const double span = times.back() - times.front();
  const double spacing = span / static_cast<double>(std::max<std::size_t>(times.size() - 1, 1));
  return std::min(std::clamp(spacing, finest, coarsest), times.back() / least_intervals);
}

Goal goal_of(const Scene& scene, const SampledColumns& columns) {
  const std::vector<std::string> names = trajectory_columns(scene);
  Goal goal;
  goal.peak_moment = goal.peak_force = goal.overtravel = goal.hold_moment = goal.motor_energy =
      goal.audit = goal.end_state = goal.final_angle = false;
  goal.to_t_end = true;
  goal.sample_interval = columns.interval;
  goal.sample_motion_only = std::ranges::none_of(
      columns.columns, [&](std::size_t column) { return is_load(names[column]); });
  return goal;
}

SampleTaker::SampleTaker(const Scene& scene, const SampledColumns& columns)
    : base_(scene.base.motion), columns_(columns.columns), partners_(columns.columns) {
  const std::vector<ColumnKind> kinds = kinds_of(scene, columns);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (kinds[k] == ColumnKind::angle) ++partners_[k];
    if (kinds[k] == ColumnKind::rate) --partners_[k];
  }
}

void SampleTaker::take(const Sample& sample, std::vector<double>& numbers) {
  row_.clear();
  take_sample(sample, base_, [this](double value) { row_.push_back(value); });
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    numbers.push_back(row_[columns_[k]]);
    numbers.push_back(row_[partners_[k]]);
  }
}

SampledMotion::SampledMotion(const Scene& scene, const SampledColumns& columns)
    : interval_(columns.interval), kinds_(kinds_of(scene, columns)) {}

bool SampledMotion::is_whole(std::span<const double> numbers) const {
  return numbers.size() >= 4 * kinds_.size(); // two samples
}

double SampledMotion::at(std::span<const double> numbers, std::size_t which, double t) const {
  const std::size_t width = 2 * kinds_.size(), samples = numbers.size() / width;
  const double place = std::clamp(t / interval_, 0.0, static_cast<double>(samples - 1));
  const auto k = std::min(static_cast<std::size_t>(place), samples - 2);
  const double s = place - static_cast<double>(k);
  const double* const before = &numbers[k * width + 2 * which];
  const double* const after = before + width;
  switch (kinds_[which]) {
  case ColumnKind::angle:
    return hermite(s, interval_, before[0], before[1], after[0], after[1]);
  case ColumnKind::rate:
    return hermite_slope(s, interval_, before[1], before[0], after[1], after[0]);
  case ColumnKind::other:
    break;
  }
  return before[0] + s * (after[0] - before[0]);
}

} // namespace wingspread
