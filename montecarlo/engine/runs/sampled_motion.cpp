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

} // namespace

double grid_interval(std::span<const double> times) {
  const double span = times.back() - times.front();
  const double spacing = span / static_cast<double>(std::max<std::size_t>(times.size() - 1, 1));
  return std::min(std::clamp(spacing, finest, coarsest), times.back() / least_intervals);
}

SampledMotion::SampledMotion(const Scene& scene, std::vector<std::size_t> columns)
    : base_(scene.base.motion), columns_(std::move(columns)) {
  const std::vector<std::string> names = trajectory_columns(scene);
  for (const std::size_t column : columns_) is_angle_.push_back(names[column].ends_with(".angle"));
}

bool SampledMotion::run(Deployment& deployment, const Scene& scene, Integration integration,
                        double t_end, double interval) {
  integration.t_end = t_end;
  interval_ = interval;
  numbers_.clear();
  samples_ = 0;
  Goal goal;
  goal.peak_moment = goal.peak_force = goal.overtravel = goal.audit = goal.end_state = false;
  goal.to_t_end = true;
  goal.sample_interval = interval;
  const Outcome outcome = deployment.run(scene, integration, goal, [this](const Sample& sample) {
    row_.clear();
    take_sample(sample, base_, [this](double value) { row_.push_back(value); });
    for (const std::size_t column : columns_) {
      numbers_.push_back(row_[column]);
      numbers_.push_back(row_[column + 1 < row_.size() ? column + 1 : column]);
    }
    ++samples_;
  });
  return outcome.status != Status::invalid && outcome.status != Status::failed && samples_ > 1;
}

double SampledMotion::at(std::size_t which, double t) const {
  const double place = std::clamp(t / interval_, 0.0, static_cast<double>(samples_ - 1));
  const auto k = std::min(static_cast<std::size_t>(place), samples_ - 2);
  const double s = place - static_cast<double>(k);
  const std::size_t width = 2 * columns_.size();
  const double* const before = &numbers_[k * width + 2 * which];
  const double* const after = before + width;
  if (is_angle_[which]) return hermite(s, interval_, before[0], before[1], after[0], after[1]);
  return before[0] + s * (after[0] - before[0]);
}

} // namespace wingspread
