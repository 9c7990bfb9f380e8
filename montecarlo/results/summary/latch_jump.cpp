#include "montecarlo/results/summary/latch_jump.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace wingspread {

std::vector<LatchJump> latch_jumps(const Scene& scene, const Outcome& outcome) {
  std::vector<LatchJump> found;
  if (outcome.status == Status::failed || outcome.peak_moment.empty()) return found;
  for (std::size_t i = 0; i < scene.hinges.size(); ++i)
    for (const LatchEvent& latch : outcome.latches) {
      if (latch.hinge != static_cast<int>(i)) continue;
      const double moment = scene.hinges[i].latch->damping * std::abs(latch.rates[i]);
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

} // namespace wingspread
