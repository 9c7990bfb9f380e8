/// Hinges that turn through their stowed angle, where nothing stops them: panels of a stack would have gone through
/// each other.
#pragma once

#include "montecarlo/engine/runs/results.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Up to this much is taken for give in the hinge.
inline constexpr double most_overtravel = 0.017453292519943295; // 1 deg, rad

struct Overtravel {
  std::string hinge;
  long runs = 0;      ///< in which it turns further than that
  double largest = 0; ///< of all runs, rad
};

/// The hinges without a stop that turn further than that in any run, in the scene's order.
/// Cost O(N) for each such hinge.
[[nodiscard]] std::vector<Overtravel> overtravels(const Scene& scene, const Results& results);
[[nodiscard]] std::vector<Overtravel> overtravels(const Scene& scene, const Outcome& outcome);

/// "h2 turns up to 40 deg beyond its stowed angle; it has no stop".
[[nodiscard]] std::string warning(const Overtravel& overtravel);
/// "in 3000 of 3000 runs h2 turns …".
[[nodiscard]] std::string warning(const Overtravel& overtravel, long of_runs);

} // namespace wingspread
