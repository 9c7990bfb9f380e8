/// The integration error of a campaign: some runs are repeated at a much tighter tolerance by another method and
/// compared.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// The error of one output, over the repeated runs that are not in doubt.
struct OutputAccuracy {
  std::string output;
  long runs = 0;      ///< in which the output happened
  double largest = 0; ///< largest error, in the output's unit; NaN without runs
  double rms =
      0; ///< the same; of runs that were chosen for being delicate, so above the campaign's own
};

struct Accuracy {
  long runs = 0; ///< runs repeated
  std::string method;
  double rtol = 0; ///< the campaign's
  std::string reference_method;
  double reference_rtol = 0;
  /// Runs whose status or latch order differs in the reference: undecided at this tolerance, so without an error.
  std::vector<long> in_doubt;
  long unreached = 0; ///< runs that the reference could not finish; not among `runs`
  std::vector<OutputAccuracy> outputs; ///< in the columns' order
  double seconds = 0;                  ///< time taken; not part of the results
};

/// The reference integrations, the preferred one first: another method at a tolerance 1000 times tighter, within
/// 1e-13 and 1e-10. dopri5 takes such short steps there that it misses nothing, and its coefficients differ from
/// those of dop853, which `auto` uses. seulex is for latches too stiff for dopri5.
[[nodiscard]] std::vector<Integration> references_of(const Integration& integration);

/// Compares rows with their reference.
/// @param names  of both
/// @param rows, reference the same runs in the same order; failed reference runs are `unreached`
/// @return without methods and tolerances
[[nodiscard]] Accuracy compare_rows(const ResultNames& names, std::span<const ResultRow> rows,
                                    std::span<const ResultRow> reference);

/// Repeats runs of a campaign with another integration.
/// @param runs increasing
/// @param pool does not change the rows
[[nodiscard]] std::vector<ResultRow> make_again(const Campaign& campaign,
                                                const Integration& integration,
                                                std::span<const long> runs, const ThreadPool& pool);

/// Compares rows with the first usable reference. A reference is unusable if the first run fails within 100 times the
/// steps of the campaign's own runs.
/// @param rows of the campaign, at its own integration; at least one, in the order of runs
/// @return `runs` is 0 if no reference is usable
[[nodiscard]] Accuracy compare_with_reference(const Campaign& campaign,
                                              std::span<const ResultRow> rows,
                                              const ThreadPool& pool);

/// How many of N runs are repeated: a tenth, at least one, at most what the campaign asks for.
[[nodiscard]] std::size_t count_repeated(const Campaign& campaign, std::size_t runs);

/// How accurate these results are. Nothing where the campaign wants none, or no run could be made again.
/// Cost: some five to ten times that of the runs' own. @pre the results are the campaign's own
[[nodiscard]] std::optional<Accuracy>
/// The accuracy of these results. Nothing if the campaign wants none, or no run could be repeated. Cost: five to ten
/// times that of the repeated runs.
/// @pre the results are the campaign's own
measure_accuracy(const Campaign& campaign, const Results& results, const ThreadPool& pool);

} // namespace wingspread
