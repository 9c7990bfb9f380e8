/// Half-widths of two-sided intervals, in standard errors: the quantile above which (1 − confidence)/2 of the law lies.
#pragma once

namespace wingspread {

/// For the standard normal law. @pre 0 < confidence < 1
[[nodiscard]] double two_sided_normal(double confidence);

/// For Student's law. @pre degrees ≥ 1, 0 < confidence < 1
[[nodiscard]] double two_sided_student(long degrees, double confidence);

} // namespace wingspread
