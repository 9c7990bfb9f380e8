#include "montecarlo/model/input_checks/damper_check.hpp"

#include "montecarlo/model/input_checks/clearance_check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

constexpr double most_times = 10; // heuristic: rate limiters make a deployment a few times as long

/// The scene without dampers but that of one hinge (−1: none).
Scene with_one_damper(Scene scene, int kept) {
  for (int h = 0; h < std::ssize(scene.hinges); ++h)
    if (h != kept) scene.hinges[static_cast<std::size_t>(h)].damper.reset();
  return scene;
}

/// The time with a damper: that of the nominal deployment, and for one damper of several the time up to which it was
/// followed alone, which is a lower bound.
std::string damped_text(const Outcome& nominal, bool is_alone, double followed) {
  const bool is_known = nominal.status == Status::deployed;
  const std::string whole =
      is_known ? fmt::format("a nominal deployment of {:.4g} s", nominal.t_end) : "";
  if (is_known && is_alone) return whole;
  return fmt::format("{}{}more than {:.4g} s by this damper alone (a lower bound)", whole,
                     is_known ? ", " : "a deployment of ", followed);
}

} // namespace

void check_dampers(const Scene& scene, const Integration& integration, const Outcome& nominal,
                   InputWarnings& warnings) {
  const auto is_damped = [](const Hinge& hinge) { return hinge.damper.has_value(); };
  const bool ends = nominal.status == Status::deployed || nominal.status == Status::timed_out;
  if (!ends || std::ranges::none_of(scene.hinges, is_damped)) return;
  Integration how = integration;
  if (nominal.status == Status::deployed) how.t_end = nominal.t_end / most_times;
  const Outcome free = deployment_alone(with_one_damper(scene, -1), how);
  if (free.status != Status::deployed) return;
  how.t_end = most_times * free.t_end;
  const bool is_alone = std::ranges::count_if(scene.hinges, is_damped) == 1;
  for (int h = 0; h < std::ssize(scene.hinges); ++h) {
    const Hinge& hinge = scene.hinges[static_cast<std::size_t>(h)];
    if (!hinge.damper ||
        deployment_alone(with_one_damper(scene, h), how).status != Status::timed_out)
      continue;
    warnings.add(
        fmt::format("/hinges/{}/damper", h),
        fmt::format("{}, {:.4g} s without dampers", damped_text(nominal, is_alone, how.t_end),
                    free.t_end),
        fmt::format(
            "up to {} times as long (write other units as \"3 N*mm*s/rad\", \"0.1 N*m*s/deg\")",
            most_times));
  }
}

} // namespace wingspread
