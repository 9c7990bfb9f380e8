/// The instruction sets that packs of runs can use, and how well they were used.
#pragma once

#include <vector>

namespace wingspread {

/// How many runs are integrated at once in one thread.
enum class InstructionSet { scalar, neon, avx2, avx512 };
[[nodiscard]] const char* to_string(InstructionSet set);
/// Those that this processor and this build have, narrowest first.
[[nodiscard]] const std::vector<InstructionSet>& instruction_sets();
/// Runs at once: 1, 2, 4 or 8.
[[nodiscard]] int lanes_of(InstructionSet set);

/// How full the lanes of packs were.
struct Occupancy {
  long tries = 0;  ///< steps that the engine made, all lanes counted
  long busy = 0;   ///< those in lanes with a run
  long scalar = 0; ///< steps made outside the engine
  long looks = 0;  ///< tries after which the run itself was asked
  Occupancy& operator+=(const Occupancy& other);
};

/// Whether this processor, and this build, have the instruction set.
[[nodiscard]] bool has_neon();
[[nodiscard]] bool has_avx2();
[[nodiscard]] bool has_avx512();

} // namespace wingspread
