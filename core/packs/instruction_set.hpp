/// The instruction sets of engines, and how well their lanes were used.
#pragma once

#include <vector>

namespace wingspread {

/// Chooses an engine, and with it the number of lanes in one thread; scalar: no engine.
enum class InstructionSet { scalar, neon, avx2, avx512 };
[[nodiscard]] const char* to_string(InstructionSet set);
/// The sets that both this processor and this build have, narrowest first; at least scalar.
[[nodiscard]] const std::vector<InstructionSet>& instruction_sets();
/// Number of lanes: 1, 2, 4 or 8.
[[nodiscard]] int lanes_of(InstructionSet set);

/// How well the lanes of engines were used, in trial steps.
struct Occupancy {
  long tries = 0;  ///< made by engines, all lanes counted
  long busy = 0;   ///< made by engines in lanes with a run
  long scalar = 0; ///< made outside engines
  long looks = 0;  ///< trial steps by engines after which a lane needed its run
  Occupancy& operator+=(const Occupancy& other);
};

// Whether both this processor and this build have the instruction set.
[[nodiscard]] bool has_neon();
[[nodiscard]] bool has_avx2();
[[nodiscard]] bool has_avx512();

} // namespace wingspread
