/// Times one acceleration evaluation a lane; the definition is compiled for each instruction set.
#pragma once

namespace wingspread::study {

/// ns a lane of one evaluation of the recursion for a chain of 3 or 10 bodies with linear hinge
/// moments, data in cache; the least over rounds of about a tenth of a second in all.
struct KernelTimes {
  double independent; ///< evaluations
  double dependent;   ///< each needs the last, as the stages of a step do
  double two_in_turn; ///< those of two packs in turn, each of which needs its own last
};

[[nodiscard]] KernelTimes avx2_evaluation(int bodies);
[[nodiscard]] KernelTimes avx512_evaluation(int bodies);

} // namespace wingspread::study
