#include "montecarlo/results/summary/latch_jump.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// Whether one of the hinge's bodies bends.
bool is_on_flexible(const Scene& scene, const Hinge& hinge) {
  const auto bends = [&](int body) {
    return body >= 0 && scene.bodies[static_cast<std::size_t>(body)].flexible.has_value();
  };
  return bends(hinge.parent) || bends(hinge.child);
}

} // namespace

std::vector<LatchJump> latch_jumps(const Scene& scene, const Outcome& outcome) {
  std::vector<LatchJump> found;
  if (outcome.status == Status::failed || outcome.peak_moment.empty()) return found;
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    double moment = 0; // the largest: a latch that let go may engage again
    for (const LatchEvent& latch : outcome.latches)
      if (latch.hinge == static_cast<int>(i))
        moment = std::max(moment, scene.hinges[i].latch->damping * std::abs(latch.rates[i]));
    const double peak = outcome.peak_moment[i].value;
    if (moment > 0.5 * peak) found.push_back({scene.hinges[i].name, moment, peak});
  }
  return found;
}

std::string warning(std::span<const LatchJump> jumps) {
  std::vector<std::string> hinges;
  for (const LatchJump& jump : jumps)
    // A jump opposite to the spring's moment may exceed the peak a little: 100 % at most is shown.
    hinges.push_back(
        fmt::format("{} ({:.0f} %)", jump.hinge, std::min(100.0, 100 * jump.moment / jump.peak)));
  return fmt::format(
      "latch damping makes most of the peak moment of {}: as a latch engages, its "
      "moment jumps to damping times rate; with \"dissipation\" in place of \"damping\" "
      "in the scene it does not",
      fmt::join(hinges, ", "));
}

std::vector<std::string> forces_of_jumps(const Scene& scene, const Outcome& outcome) {
  std::vector<std::string> found;
  if (outcome.status == Status::failed) return found;
  const auto jumps = [&](const LatchEvent& latch) {
    const Hinge& hinge = scene.hinges[static_cast<std::size_t>(latch.hinge)];
    return hinge.latch->damping > 0 && is_on_flexible(scene, hinge);
  };
  for (std::size_t i = 0; i < outcome.peak_force.size(); ++i)
    if (std::ranges::any_of(outcome.latches, [&](const LatchEvent& latch) {
          return latch.time == outcome.peak_force[i].time && jumps(latch);
        }))
      found.push_back(scene.hinges[i].name);
  return found;
}

std::string warning_of_forces(std::span<const std::string> hinges) {
  return fmt::format(
      "{}.peak_force: in proportion to the number of \"joints\", without a limit: as a "
      "latch engages, its damping times rate acts at once on the end segment of a "
      "flexible body, which is lighter the more joints there are; with "
      "\"dissipation\" in place of \"damping\" in the scene the force converges",
      fmt::join(hinges, ".peak_force, "));
}

} // namespace wingspread
