#include "montecarlo/model/input_checks/way_notices.hpp"

#include "montecarlo/model/input_checks/shape_notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wingspread {
namespace {

constexpr double longest_step = 0.05;                 // rad, of a hinge between two looks
constexpr double overtravel = std::numbers::pi / 180; // that a stop has, rad
// Of a run that is only to be looked at; with many bodies, fewer.
constexpr long most_steps = 50'000, most_evaluations = 2'000'000, most_pairs = 50'000'000;

/// Looks at a run as it goes on, until two bodies meet.
class Watch {
public:
  explicit Watch(const Scene& scene)
      : scene_(scene), arms_(scene),
        looks_left_(most_pairs /
                    std::max<long>(1, std::ssize(scene.bodies) * std::ssize(scene.bodies))) {}

  void see(const Sample& sample) {
    if (met_ || looks_left_ <= 0) return;
    double furthest = 0;
    for (std::size_t h = 0; h < last_.size(); ++h)
      furthest = std::max(furthest, std::abs(sample.angles[h] - last_[h]));
    const auto looks = static_cast<int>(std::min(1 + furthest / longest_step, 1e4));
    looks_left_ -= looks;
    for (int k = 1; k <= looks && !met_; ++k) look(sample, static_cast<double>(k) / looks);
    last_ = sample.angles;
    then_ = sample.t;
  }

  void tell(Notices& notices) const {
    if (!met_ || when_ == 0) return; // stowed so: that is told by itself
    const auto carries = [&](const Hinge& hinge) {
      return hinge.child == met_->first || hinge.child == met_->second;
    };
    const auto found = std::ranges::find_if(scene_.hinges, carries);
    notices.add(
        fmt::format("/hinges/{}", found - scene_.hinges.begin()),
        fmt::format("{} and {} pass through each other at {:.4g} s of the nominal deployment",
                    scene_.bodies[met_->first].name, scene_.bodies[met_->second].name, when_),
        "a way clear of other bodies (hinge points, stowed angles, senses of rotation)");
  }

private:
  /// Between the last sample and this one.
  void look(const Sample& sample, double share) {
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
  long looks_left_;
  std::vector<double> last_;
  double then_ = 0, when_ = 0; ///< s
  std::optional<std::pair<int, int>> met_;
};

} // namespace

Outcome notice_way(const Scene& scene, const Integration& integration, Notices& notices) {
  Integration how = integration;
  const long bodies = std::max<long>(1, std::ssize(scene.bodies));
  how.max_steps = std::min({how.max_steps, most_steps, most_evaluations / bodies});
  Goal goal;
  goal.peak_moment = goal.peak_force = goal.audit = false;
  Watch watch(scene);
  Outcome outcome =
      Deployment().run(scene, how, goal, [&](const Sample& sample) { watch.see(sample); });
  watch.tell(notices);
  return outcome;
}

} // namespace wingspread
