/// How accurate a campaign's results are: some of its runs made again at a much tighter tolerance by another
/// method, and how far they differ.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// Of one output, over the runs that were made again and are not in doubt.
struct OutputAccuracy {
  std::string output;
  long runs = 0;      ///< in which it happened
  double largest = 0; ///< error, in the output's unit; NaN without runs
  double rms =
      0; ///< the same; of runs that were chosen for being delicate, so above the campaign's own
};

struct Accuracy {
  long runs = 0; ///< made again
  std::string method;
  double rtol = 0; ///< the campaign's
  std::string reference_method;
  double reference_rtol = 0;
  /// Runs, by their numbers, whose status or latch order the reference has otherwise: what they give is not a
  /// little off, but undecided at this tolerance. They have no error.
  std::vector<long> in_doubt;
  long unreached = 0; ///< runs that the reference could not finish; not among `runs`
  std::vector<OutputAccuracy> outputs; ///< in the columns' order
  double seconds = 0;                  ///< that it took: of no account to the results
};

/// The integrations that runs may be made again by, the first to be preferred: another method, at a tolerance
/// a thousand times tighter, where 1e-13 and 1e-10 let it. dopri5 has steps so short at such tolerances that it
/// passes over nothing, and its coefficients are not those of dop853, which `auto` takes; seulex is for latches
/// that are too stiff for it.
[[nodiscard]] std::vector<Integration> references_of(const Integration& integration);

/// How rows differ from those of a reference.
/// @param names  of both
/// @param rows, reference of the same runs, one by one; those of the reference that failed are `unreached`
/// @return without methods and tolerances
[[nodiscard]] Accuracy compare_rows(const ResultNames& names, std::span<const ResultRow> rows,
                                    std::span<const ResultRow> reference);

/// Rows of a campaign again, each as the campaign would have it by this integration.
/// @param runs their numbers
/// @param pool how; the rows do not depend on it
[[nodiscard]] std::vector<ResultRow> make_again(const Campaign& campaign,
                                                const Integration& integration,
                                                std::span<const long> runs, const ThreadPool& pool);

/// Compares rows with the first reference that can be had: one by which the first run fails, in a hundred
/// times the steps that runs take as they are, is too dear or not able, and the next one is tried.
/// @param rows of the campaign, at its own integration; at least one, in the order of their runs
/// @return `runs` is 0 when none can be had
[[nodiscard]] Accuracy compare_with_reference(const Campaign& campaign,
                                              std::span<const ResultRow> rows,
                                              const ThreadPool& pool);

/// How many of N runs are made again: a tenth of them, one at least, and no more than the campaign says.
[[nodiscard]] std::size_t count_repeated(const Campaign& campaign, std::size_t runs);

/// How accurate these results are. Nothing where the campaign wants none, or no run could be made again.
/// Cost: some five to ten times that of the runs' own. @pre the results are the campaign's own
[[nodiscard]] std::optional<Accuracy>
measure_accuracy(const Campaign& campaign, const Results& results, const ThreadPool& pool);

} // namespace wingspread
