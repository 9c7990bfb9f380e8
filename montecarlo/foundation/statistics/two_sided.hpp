/// How far a two-sided interval reaches, in standard errors: the point that leaves
/// (1 − confidence)/2 of a law above it.
#pragma once

namespace wingspread {

/// Of the standard normal law. @pre 0 < confidence < 1
[[nodiscard]] double two_sided_normal(double confidence);

/// Of Student's law. @pre degrees ≥ 1, 0 < confidence < 1
[[nodiscard]] double two_sided_student(long degrees, double confidence);

} // namespace wingspread
