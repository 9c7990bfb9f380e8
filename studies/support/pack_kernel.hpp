/// Times one acceleration evaluation a lane; the definition is compiled for each instruction set.
#pragma once

namespace wingspread::study {

/// ns a lane of one evaluation of the recursion for a chain of 3 or 10 bodies with linear hinge
/// moments, data in cache, evaluations independent; the least over rounds of about a tenth of a
/// second in all.
[[nodiscard]] double avx2_evaluation(int bodies);
[[nodiscard]] double avx512_evaluation(int bodies);

} // namespace wingspread::study
