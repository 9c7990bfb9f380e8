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

/// Why a run is worked on outside its lane. `start`: it begins. `method`: no lane can make its steps. `limit`: t_end, a
/// knot of a table, a hold's release, a proof attempt, or a step after which `auto` reconsiders the method. `event`: a
/// latch may engage or let go, a hinge come to rest, an angle be passed at which a law changes or for which a hold
/// waits, or a kink that matters lie inside the step. `release`: a stuck hinge may slide. `base`: a free base may turn
/// further inside the step than at its ends, a hinge turn back, or an event lie at the step's end. `moment`, `force`: a
/// peak may lie inside the step.
enum class Cause { start, method, limit, event, release, base, moment, force };
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

// Whether both this processor and this build have the instruction set.
[[nodiscard]] bool has_neon();
[[nodiscard]] bool has_avx2();
[[nodiscard]] bool has_avx512();

} // namespace wingspread
