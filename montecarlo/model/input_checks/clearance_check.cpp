#include "montecarlo/model/input_checks/clearance_check.hpp"

#include "montecarlo/model/input_checks/shape_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wingspread {
namespace {

// Heuristic: arms that cross for less than 0.05 rad of a hinge's travel are missed.
constexpr double longest_step = 0.05;                 // rad, of a hinge between two comparisons
constexpr double overtravel = std::numbers::pi / 180; // rad: a stop's gap is of this order
// Limits of the check's cost; a deployment that exceeds them is checked only up to that point.
constexpr long most_steps = 50'000, most_evaluations = 2'000'000, most_pairs = 50'000'000;

/// Compares the bodies along a run, until two of them overlap.
class ClearanceWatch {
public:
  explicit ClearanceWatch(const Scene& scene)
      : scene_(scene), arms_(scene),
        comparisons_left_(most_pairs /
                          std::max<long>(1, std::ssize(scene.bodies) * std::ssize(scene.bodies))) {}

  void add_sample(const Sample& sample) {
    if (met_ || comparisons_left_ <= 0) return;
    double furthest = 0;
    for (std::size_t h = 0; h < last_.size(); ++h)
      furthest = std::max(furthest, std::abs(sample.angles[h] - last_[h]));
    const auto comparisons = static_cast<int>(std::min(1 + furthest / longest_step, 1e4));
    comparisons_left_ -= comparisons;
    for (int k = 1; k <= comparisons && !met_; ++k)
      compare(sample, static_cast<double>(k) / comparisons);
    last_ = sample.angles;
    then_ = sample.t;
  }

  void warn(InputWarnings& warnings) const {
    if (!met_ || when_ == 0) return; // overlapping when stowed: shape_checks warns
    const auto carries = [&](const Hinge& hinge) {
      return hinge.child == met_->first || hinge.child == met_->second;
    };
    const auto found = std::ranges::find_if(scene_.hinges, carries);
    warnings.add(
        fmt::format("/hinges/{}", found - scene_.hinges.begin()),
        fmt::format("{} and {} pass through each other at {:.4g} s of the nominal deployment",
                    scene_.bodies[met_->first].name, scene_.bodies[met_->second].name, when_),
        "bodies that clear each other (check hinge points, stowed angles, senses of rotation)");
  }

private:
  /// Compares the bodies at a share of the way from the last sample to this one.
  void compare(const Sample& sample, double share) {
    std::vector<double> angles = sample.angles;
    for (std::size_t h = 0; h < last_.size(); ++h)
      angles[h] = std::lerp(last_[h], sample.angles[h], share);
    for (std::size_t h = 0; h < angles.size(); ++h) {
      const Hinge& hinge = scene_.hinges[h];
      const double sense = hinge.latched > hinge.stowed ? 1 : -1;
      if (sense * (angles[h] - hinge.stowed) < -overtravel) return;
    }
    met_ = arms_.first_crossing(place_bodies(scene_, angles));
    when_ = last_.empty() ? sample.t : std::lerp(then_, sample.t, share);
  }

  const Scene& scene_;
  Arms arms_;
  long comparisons_left_;
  std::vector<double> last_;
  double then_ = 0, when_ = 0; ///< s
  std::optional<std::pair<int, int>> met_;
};

} // namespace

Outcome deployment_alone(const Scene& scene, const Integration& integration,
                         const Observer& observer, bool peaks) {
  Integration how = integration;
  const long bodies = std::max<long>(1, std::ssize(scene.bodies));
  how.max_steps = std::min({how.max_steps, most_steps, most_evaluations / bodies});
  Goal goal;
  goal.peak_moment = goal.peak_force = peaks, goal.audit = false;
  return Deployment().run(scene, how, goal, observer);
}

Outcome check_clearance(const Scene& scene, const Integration& integration,
                        InputWarnings& warnings) {
  ClearanceWatch watch(scene);
  Outcome outcome =
      deployment_alone(scene, integration, [&](const Sample& sample) { watch.add_sample(sample); });
  watch.warn(warnings);
  return outcome;
}

} // namespace wingspread
