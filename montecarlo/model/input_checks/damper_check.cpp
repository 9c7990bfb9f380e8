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
  for (int h = 0; h < std::ssize(scene.hinges); ++h) {
    const Hinge& hinge = scene.hinges[static_cast<std::size_t>(h)];
    if (!hinge.damper ||
        deployment_alone(with_one_damper(scene, h), how).status != Status::timed_out)
      continue;
    warnings.add(
        fmt::format("/hinges/{}/damper", h),
        fmt::format(
            "a deployment of more than {:.4g} s by this damper alone, {:.4g} s without dampers",
            how.t_end, free.t_end),
        fmt::format(
            "up to {} times as long (write other units as \"3 N*mm*s/rad\", \"0.1 N*m*s/deg\")",
            most_times));
  }
}

} // namespace wingspread
