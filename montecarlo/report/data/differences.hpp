/// Differences between two sets: COMPARISON of page/DATA.md.
///
/// Means of paired sets (both have the same draws): the mean of the differences run by run, over runs with the output
/// in both sets. The interval is Student's; for a replicated design it is that of the replicates' means.
/// Means of other sets: the difference of the means with Welch's interval; replicated designs have no interval.
/// Shares: the difference of two shares. Each has Clopper and Pearson's bounds at 1 − α/2, so that the bounds of the
/// difference hold at 1 − α (Bonferroni). For paired sets the two are the shares of runs with the status in one set
/// only; for other sets they are the sets' shares.
/// The bounds have the higher confidence of the two sets': what interim analyses share, they share here too.
/// Source: B. L. Welch, Biometrika 34 (1947) 28–35.
#pragma once

#include "montecarlo/report/data/page_source.hpp"

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {

struct Difference {
  double value; ///< second minus first; NaN if unknown
  Bounds bounds;
  long runs = 0; ///< number of runs with a value in both sets
};

/// The rows of two tables that have equal run numbers, ascending.
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

/// Second minus first, over n runs. @param first_alone, second_alone runs with the status in one set only
[[nodiscard]] Difference paired_share_difference(long first_alone, long second_alone, long n,
                                                 double confidence);
[[nodiscard]] Difference unpaired_share_difference(long first, long first_of, long second,
                                                   long second_of, double confidence);

/// Whether runs of equal number are made from the same random numbers in both sets: equal draws where the laws are equal.
[[nodiscard]] bool have_same_draws(const PageSource& first, const PageSource& second);

/// The sets that the page compares, and those without a partner.
struct Pairs {
  std::vector<std::pair<std::size_t, std::size_t>> both; ///< indices of sets
  std::vector<std::string> missing;                      ///< "B · hot: A has no case hot"
};
/// Pairs each folder with the first folder and with the one before: case by case of the same name. Then the cases of a
/// folder with its first case and with the one before. Two folders with one set each are a pair, whatever their cases.
[[nodiscard]] Pairs pairs_of(std::span<const std::unique_ptr<PageSource>> sets);

/// The second set minus the first. @param places indices of both among the page's sets
[[nodiscard]] Json comparison_json(const PageSource& first, const PageSource& second,
                                   std::pair<std::size_t, std::size_t> places);

} // namespace wingspread
