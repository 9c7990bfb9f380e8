#include "montecarlo/results/summary/latch_jump.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  std::vector<std::string> peaks;
  for (const LatchJump& jump : jumps)
    peaks.push_back(
        fmt::format("{}.peak_moment ({:.4g} of {:.4g} N·m)", jump.hinge, jump.moment, jump.peak));
  return fmt::format("where a latch engages, its moment jumps to damping times rate, which decides "
                     "{}; a latch with "
                     "\"dissipation\" in place of \"damping\" has no jump",
                     fmt::join(peaks, ", "));
}

} // namespace wingspread
