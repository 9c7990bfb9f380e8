/// Overtravel: hinges without a stop that turn beyond their stowed angle, where panels of a stack would pass through
/// each other.
#pragma once

#include "montecarlo/engine/runs/results.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Tolerated angle. Heuristic: play and flexibility of a hinge stay below 1 deg; a smaller limit warns of harmless
/// runs, a larger one hides contact.
inline constexpr double most_overtravel = 0.017453292519943295; // 1 deg, rad

struct Overtravel {
  std::string hinge;
  long runs = 0;      ///< runs in which the hinge turns further than most_overtravel
  double largest = 0; ///< largest overtravel of all runs, rad
};

/// Explains the name in tables: in other fields it is the rotation beyond the latched angle.
inline constexpr const char* overtravel_note = "overtravel: backwards, beyond the stowed angle";

/// The hinges without a stop that exceed most_overtravel in any run, in the scene's order. Cost O(N) per hinge.
[[nodiscard]] std::vector<Overtravel> overtravels(const Scene& scene, const Results& results);
[[nodiscard]] std::vector<Overtravel> overtravels(const Scene& scene, const Outcome& outcome);

/// "h2 turns up to 40 deg beyond its stowed angle; it has no stop".
[[nodiscard]] std::string warning(const Overtravel& overtravel);
/// "in 3000 of 3000 runs h2 turns …".
[[nodiscard]] std::string warning(const Overtravel& overtravel, long of_runs);

} // namespace wingspread
