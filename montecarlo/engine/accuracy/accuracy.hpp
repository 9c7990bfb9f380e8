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
  long runs = 0;      ///< repeated runs in which the output happened
  double largest = 0; ///< largest error, in the output's unit; NaN without runs
  /// RMS error, in the output's unit; NaN without runs. An overestimate for the whole campaign, because delicate runs
  /// are chosen first.
  double rms = 0;
};

struct Accuracy {
  long runs = 0; ///< repeated runs, those in doubt included
  std::string method;
  double rtol = 0; ///< of the campaign, as is `method`
  std::string reference_method;
  double reference_rtol = 0;
  /// Runs whose status, latch order or set of outputs differs in the reference. The campaign's tolerance does not
  /// decide them, so they have no error.
  std::vector<long> in_doubt;
  long unreached = 0; ///< runs that the reference could not finish; not among `runs`
  std::vector<OutputAccuracy> outputs; ///< in the columns' order
  double seconds = 0;                  ///< time taken; not part of the results
};

/// The reference integrations, the preferred one first. Their rtol is 1000 times tighter, kept between 1e-13 (1e-12
/// for an implicit method) and 1e-10. First comes dopri5, whose coefficients differ from those of dop853, which `auto`
/// uses; then seulex, for latches too stiff for dopri5. A campaign that itself uses dopri5 or seulex is compared with
/// dop853 or `auto` in its place.
[[nodiscard]] std::vector<Integration> references_of(const Integration& integration);

/// Compares rows with their reference.
/// @param names  column names of both
/// @param rows, reference the same runs in the same order; failed reference runs are `unreached`
/// @return the accuracy; methods, tolerances and seconds are not set
[[nodiscard]] Accuracy compare_rows(const ResultNames& names, std::span<const ResultRow> rows,
                                    std::span<const ResultRow> reference);

/// Repeats runs of a campaign with another integration.
/// @param runs increasing
/// @param pool does not change the rows
[[nodiscard]] std::vector<ResultRow> make_again(const Campaign& campaign,
                                                const Integration& integration,
                                                std::span<const long> runs, const ThreadPool& pool);

/// Compares rows with the first usable reference. A reference is unusable if it cannot finish the first of the runs
/// within 100 times the steps of the campaign's method (at least 20,000 steps).
/// @param rows of the campaign, at its own integration; at least one, in the order of runs
/// @return `runs` is 0 if no reference is usable
[[nodiscard]] Accuracy compare_with_reference(const Campaign& campaign,
                                              std::span<const ResultRow> rows,
                                              const ThreadPool& pool);

/// How many runs are repeated: a tenth of `runs`, rounded up, and at most what the campaign asks for.
[[nodiscard]] std::size_t count_repeated(const Campaign& campaign, std::size_t runs);

/// The accuracy of these results. Nothing if the campaign wants none, or no run could be repeated. Cost: a repeated run
/// takes five to ten times as long as the run itself.
/// @pre the results were computed with the campaign's own integration
[[nodiscard]] std::optional<Accuracy>
measure_accuracy(const Campaign& campaign, const Results& results, const ThreadPool& pool);

} // namespace wingspread
