/// The instruction sets of engines, and how well their lanes were used.
#pragma once

#include <array>
#include <vector>

namespace wingspread {

/// Chooses an engine, and with it the number of lanes in one thread; scalar: no engine.
enum class InstructionSet { scalar, neon, avx2, avx512 };
[[nodiscard]] const char* to_string(InstructionSet set);
/// The sets that both this processor and this build have, narrowest first; at least scalar.
[[nodiscard]] const std::vector<InstructionSet>& instruction_sets();
/// Number of lanes: 1, 2, 4 or 8.
[[nodiscard]] int lanes_of(InstructionSet set);

/// Why a run is worked on outside its lane.
enum class Cause {
  start,  ///< the run begins
  method, ///< no lane can make its steps
  limit, ///< t_end, a knot of a table, a hold's release, a proof attempt, or a check of the method by `auto`
  event, ///< a latch may engage or let go, a hinge may come to rest, an angle or a kink that changes a law may be passed
  release, ///< a stuck hinge may slide
  base, ///< a free base may turn further than at the step's ends, a hinge may turn back, or an event lies at the end
  moment, ///< a peak of a moment may lie inside the step
  force   ///< a peak of a force may lie inside the step
};
inline constexpr std::array cause_names{"start",   "method", "limit",  "event",
                                        "release", "base",   "moment", "force"};

/// How well the lanes of engines were used.
struct Occupancy {
  long trial_steps = 0; ///< trial steps made by engines, all lanes counted
  long busy = 0;        ///< made by engines in lanes with a run
  long scalar = 0;      ///< made outside engines
  long returns = 0;     ///< trial steps by engines after which a lane needed its run
  double in_lanes = 0;  ///< time in engines, s
  std::array<double, cause_names.size()> outside{}; ///< time with one run at a time, by Cause, s
  Occupancy& operator+=(const Occupancy& other);
};

/// Whether both this processor and this build have the instruction set.
[[nodiscard]] bool has_neon();
[[nodiscard]] bool has_avx2();
[[nodiscard]] bool has_avx512();

} // namespace wingspread
