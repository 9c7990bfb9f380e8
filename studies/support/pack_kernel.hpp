/// The time of one acceleration evaluation per lane. The definition is compiled for each instruction set.
#pragma once

namespace wingspread::study {

/// Times of one evaluation of the recursion, ns per lane, for a chain of 3 or 10 bodies with linear hinge moments and data
/// in cache. Each is the least over many rounds, which take about a tenth of a second together.
struct KernelTimes {
  double independent; ///< evaluations
  double dependent;   ///< each evaluation needs the previous one, as stages of a step do
  double two_in_turn; ///< dependent evaluations of two packs, made alternately
};

[[nodiscard]] KernelTimes avx2_evaluation(int bodies);
[[nodiscard]] KernelTimes avx512_evaluation(int bodies);

} // namespace wingspread::study
