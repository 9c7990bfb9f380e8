/// The integration error of a campaign: runs drawn at random are repeated at a tighter tolerance by another method and
/// compared. Since the sample is random, its errors bound the share of all runs with a larger error (share_at_most).
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
  double rms = 0;     ///< RMS error, in the output's unit; NaN without runs
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
  std::vector<long> moved; ///< other runs in which an output moved (see moved())
  std::vector<std::string>
      moved_outputs{}; ///< the outputs that moved in them, in the columns' order
  long unreached = 0;  ///< runs that the reference could not finish; not among `runs`
  std::vector<OutputAccuracy> outputs; ///< in the columns' order
  double seconds = 0;                  ///< time taken; not part of the results
};

/// The share of a value by which it must change to have moved.
inline constexpr double moved_share = 0.01;

/// Whether an output differs between two integrations by more than 1 % of the larger magnitude and by more than
/// `unresolved`.
[[nodiscard]] bool moved(double value, double reference, double unresolved);

/// Largest difference of an output that the absolute tolerance allows: atol for angles and rates, else 0.
[[nodiscard]] double unresolved(const std::string& output, const Integration& integration);

/// Upper bound of the share of all runs that have some property, if `found` of the repeated runs have it (Clopper and
/// Pearson, one-sided). Runs in doubt and runs that the reference could not finish count as having it, because nothing
/// is known of their errors.
[[nodiscard]] double share_at_most(const Accuracy& accuracy, std::size_t found, double confidence);

/// The reference integrations, the preferred one first. Their rtol is 100 times tighter, kept between 1e-13 (1e-12
/// for an implicit method) and 1e-8, and never above the campaign's. First comes dopri5, which `auto` takes
/// at loose tolerances only; then seulex, for latches too stiff for dopri5. A campaign that itself uses dopri5 or
/// seulex is compared with dop853 or `auto` in its place.
[[nodiscard]] std::vector<Integration> references_of(const Integration& integration);

/// The step limit of a reference for a run that took so many steps.
[[nodiscard]] long steps_of_reference(long steps);

/// Compares rows with their reference.
/// @param names  column names of both
/// @param rows, reference the same runs in the same order; failed reference runs are `unreached`
/// @param integration of the rows
/// @return the accuracy; methods, tolerances and seconds are not set
[[nodiscard]] Accuracy compare_rows(const ResultNames& names, std::span<const ResultRow> rows,
                                    std::span<const ResultRow> reference,
                                    const Integration& integration);

/// Repeats runs of a campaign with another integration.
/// @param runs increasing
/// @param pool does not change the rows
[[nodiscard]] std::vector<ResultRow> repeat_runs(const Campaign& campaign,
                                                 const Integration& integration,
                                                 std::span<const long> runs,
                                                 const ThreadPool& pool);

/// Compares rows with the first reference that can finish the first of the runs within 100 times the steps of the
/// campaign's method (at least 20,000 steps). If none can: with the one that finishes the most of the first 16 runs.
/// @param rows of the campaign, at its own integration; at least one, in the order of runs
/// @return if no reference finishes any of these 16: `runs` is 0, and they are `unreached`
[[nodiscard]] Accuracy compare_with_reference(const Campaign& campaign,
                                              std::span<const ResultRow> rows,
                                              const ThreadPool& pool);

/// The number of runs to repeat: the campaign's accuracy_runs, if given. Else a tenth of up to 100 runs; of more runs
/// 1 %, but at least 10 and at most 100. The cost is in README.md. If none of 100 repeated runs has an error beyond x, at
/// most 3 % of all runs have one (95 % confidence); with 10 repeated runs at most 26 %.
[[nodiscard]] std::size_t count_repeated(const Campaign& campaign, std::size_t runs);

/// The accuracy of these results. Nothing if the campaign wants none, or has no run to repeat. Cost: a repeated run
/// takes several times as long as the run itself; README.md has the measured share of a campaign's time.
/// @pre the results were computed with the campaign's own integration
[[nodiscard]] std::optional<Accuracy>
measure_accuracy(const Campaign& campaign, const Results& results, const ThreadPool& pool);

} // namespace wingspread
