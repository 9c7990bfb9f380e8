/// Two sets beside each other: COMPARISON of page/DATA.md.
///
/// Of means. Paired, where both are of the same draws: over the runs in which both have the output, the mean of the
/// differences run by run with Student's interval (of replicates: that of their means). Otherwise the difference of
/// the means with Welch's interval; none for replicates.
/// Of shares. Each by Clopper and Pearson at 1 − α/2, so that the bounds of their difference hold together at 1 − α:
/// paired, of the shares of runs that have the status in one set alone; otherwise of the two shares themselves.
/// Source: B. L. Welch, Biometrika 34 (1947) 28–35.
#pragma once

#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

struct Difference {
  double value; ///< second less first; NaN where it does not exist
  Bounds bounds;
  long runs = 0; ///< that it is of, in both
};

/// Rows of two tables that are of the same run, ascending.
struct SameRuns {
  std::vector<std::size_t> first, second; ///< rows, equally many
};
[[nodiscard]] SameRuns same_runs(const Results& first, const Results& second);

/// @param replication of the first table's rows
[[nodiscard]] Difference paired_difference(const Column& first, const Column& second,
                                           const SameRuns& rows, const Replication& replication,
                                           double confidence);
[[nodiscard]] Difference unpaired_difference(const Moments& first, const Moments& second,
                                             double confidence);

/// Second less first, of n runs each: how many have the status in one alone.
[[nodiscard]] Difference paired_share_difference(long first_alone, long second_alone, long n,
                                                 double confidence);
[[nodiscard]] Difference unpaired_share_difference(long first, long first_of, long second,
                                                   long second_of, double confidence);

/// Whether two sets have the same draws in runs of the same number.
[[nodiscard]] bool have_same_draws(const PageSource& first, const PageSource& second);

/// The second set less the first. @param places of the two among the page's sets
[[nodiscard]] Json comparison_json(const PageSource& first, const PageSource& second,
                                   std::pair<std::size_t, std::size_t> places);

} // namespace wingspread
