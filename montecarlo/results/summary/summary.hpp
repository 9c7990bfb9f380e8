/// The statistics of a campaign as plain data, from which the files (summary_json.hpp) and the terminal's table
/// (table.hpp) are written.
///
/// Each output is summarised over the runs in which it happened, and the number of other runs is reported. Its
/// quantiles are over all runs: a run without the output ranks above every value, or below
/// (missing_rank in requirement.hpp). So the quantile p does not exist if fewer than a share p of the runs have the
/// output, mirrored where they rank below. The same results give the same summary, bit for bit.
#pragma once

#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"
#include "montecarlo/foundation/statistics/histogram.hpp"
#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/results/summary/latch_jump.hpp"
#include "montecarlo/results/summary/overtravel.hpp"
#include "montecarlo/results/summary/reason_pattern.hpp"
#include "montecarlo/results/summary/replication.hpp"
#include "montecarlo/results/summary/stopping.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

struct StatusShare {
  Status status;
  long count = 0;
  double rate; ///< count / runs; NaN without runs
  Bounds bounds;
};

/// The share of a status, with Clopper–Pearson bounds for independent runs; no bounds without runs.
[[nodiscard]] StatusShare status_share(Status status, long count, long runs, double confidence);

/// Most latch orders listed, the most frequent ones. Heuristic: long chains may have one per run, and summary.json
/// should stay readable; the rest is only counted.
inline constexpr std::size_t most_latch_orders = 1000;

struct LatchOrderCount {
  std::string order; ///< "root>mid>tip"
  long count = 0;
};

/// The error of a quantile from streaming statistics.
struct QuantileError {
  long rank;           ///< largest error of the estimate's rank
  double lower, upper; ///< the quantile lies within
};

/// A quantile over some population; NaN if it does not exist.
struct QuantileValue {
  double value = undefined;
  Bounds bounds{};
  std::optional<QuantileError> error{}; ///< nothing if computed from rows, or without a value
};

struct QuantileEstimate {
  double p;
  QuantileValue all; ///< over all runs
  /// Over the runs that have a value; nothing if all have one, or none.
  std::optional<QuantileValue> among{};
};

struct ToleranceLimitEstimate {
  ToleranceLimitSpec spec;
  Bounds limits;
  /// Runs that rank beyond every number (verdict.hpp): not deployed, without a value, or with a peak that t_end cut.
  long beyond = 0;
};

struct OutputSummary {
  std::string name;
  Moments moments;       ///< over the runs in which it happened; `moments.count` of them
  double mean_error = 0; ///< standard error of the mean; NaN if unknown
  long missing = 0;      ///< runs in which it did not happen
  std::vector<QuantileEstimate> quantiles; ///< over all runs
  Histogram histogram;
  MissingRank missing_end = MissingRank::above; ///< where those runs rank in all of its quantiles
  std::vector<ToleranceLimitEstimate> tolerance_limits{}; ///< over all runs (verdict.hpp)
  /// Value in the nominal run: NaN if the output did not happen there, nothing if there was no nominal run.
  std::optional<double> nominal{};
};

/// The run without dispersions.
struct NominalRun {
  Status status = Status::failed;
  std::string latch_order, reason;
  PeaksFinal peaks = PeaksFinal::unknown; ///< unknown also where the campaign asks for no peaks
};

/// 1 for a run that deployed, 0 for every other: as in verdicts, invalid and failed runs count as not deployed.
[[nodiscard]] Column deployed_column(const Results& results);

/// Correlation of a draw with an output or with deployed_column() (Pearson's is then the point-biserial correlation).
struct DrawCorrelation {
  std::string draw, output;
  Correlation value;
};

/// Draws of another tool's runs that lie outside the dispersion's law.
struct StrangeDraws {
  std::string name;                            ///< of the dispersion
  long runs = 0;                               ///< with such a draw
  long run = 0;                                ///< the first
  double value = undefined;                    ///< its draw
  double lower = undefined, upper = undefined; ///< the law's values, but for 1e-15 of each tail
};

/// Angles, rad, at which a hinge stopped: its final_angle over the stalled runs in which it did not latch.
struct StoppedHinge {
  std::string hinge;
  long runs = 0;
  double median = undefined, least = undefined, largest = undefined;
};

/// Indices, among the outputs, of the columns from which a StoppedHinge is computed.
struct FinalAngleColumns {
  std::string hinge;
  std::size_t angle;
  std::optional<std::size_t> latch_time; ///< nothing if not recorded: then the hinge counts as open

  /// Whether the run stalled and the hinge had not latched. @param value value(i) of output i in the run
  template <class Value> [[nodiscard]] bool stopped(Status status, const Value& value) const {
    return status == Status::stalled && !std::isnan(value(angle)) &&
           !(latch_time && !std::isnan(value(*latch_time)));
  }
};
/// The columns of each hinge that has a final_angle, in the order of the outputs.
[[nodiscard]] std::vector<FinalAngleColumns>
final_angle_columns(const std::vector<std::string>& outputs);

struct Summary {
  long runs = 0;
  double confidence = 0; ///< of all bounds, two-sided
  int replicates = 0;    ///< behind the bounds; 0: binomial bounds, for independent draws
  std::vector<StatusShare> statuses;         ///< all five
  std::vector<ReasonCount> reasons;          ///< by status, then the most frequent, then by text
  std::vector<LatchOrderCount> latch_orders; ///< the most frequent first, then by name
  long latch_order_kinds = 0;                ///< all kinds, with those not listed
  long without_latch = 0;                    ///< runs in which no hinge latched
  std::vector<OutputSummary> outputs;        ///< in the order of the columns
  std::vector<DrawCorrelation> correlations; ///< each draw with each output and with `deployed`
  /// Added by write_statistics (results_folder.hpp) if the campaign asks for it.
  std::vector<Verdict> requirements{};
  std::optional<NominalRun> nominal{};       ///< its outputs are in `outputs`
  std::optional<Accuracy> accuracy{};        ///< of the integration; nothing if not measured
  std::vector<StoppedHinge> stalled_at{};    ///< in the order of the columns; only with final_angle
  std::vector<Overtravel> overtravels{};     ///< of hinges without a stop
  std::vector<LatchJump> latch_jumps{};      ///< of the nominal run
  std::vector<std::string> jump_forces{};    ///< forces_of_jumps of the nominal run
  std::vector<StrangeDraws> strange_draws{}; ///< only of runs of another tool
  std::optional<PeaksCount> peaks{};         ///< nothing if not recorded
  std::string_view
      never_final{}; ///< why no t_end proves peaks final (explain_cuts); empty: one may
  std::vector<GoalState> until{}; ///< goals of the stopping rule
  bool stopped = false;           ///< all goals were met before all runs were made
  InterimAnalyses interim{};      ///< they share the risk of every bound and verdict
  bool without_rows = false;      ///< computed from streaming statistics
  bool one_run =
      false; ///< nothing is dispersed, and all runs have the same result (judge_campaign.hpp)
  /// There are more kinds of orders than latch_order_kinds: streaming statistics count only so many apart.
  bool more_order_kinds = false;

  /// The confidence of each bound at this analysis: with it the bounds of all interim analyses hold together at
  /// `confidence`.
  [[nodiscard]] double confidence_of_bound() const {
    return interim.confidence_of_bound(confidence);
  }
};

/// Cost O((D + O) N log N + D O N) for D draws, O outputs, N runs. Memory: 20 to 50 bytes per run and thread; as many
/// threads as fit into 1 GiB. Columns are released after reading. Temporary files: 4 bytes per run and column, and 12
/// where values are missing.
/// @param threads      as of thread_count (thread_pool.hpp); does not change the summary
/// @param requirements decide at which end missing values rank
/// @pre replication.of_row is as long as the results, unless there are no replicates
[[nodiscard]] Summary summarize(const Results& results, const StatisticsSpec& spec,
                                const Replication& replication = {}, int threads = 0,
                                std::span<const Requirement> requirements = {});

/// "above every value" or "below every value". For MissingRank::either the former, with the note that the bounds hold
/// for both ends.
[[nodiscard]] std::string_view words_of(MissingRank end);
/// Why an output lacks a quantile over all runs: "976 of 1000 runs have a value; the others rank above every value".
/// Empty if the quantile exists.
[[nodiscard]] std::string why_no_quantile(const OutputSummary& output,
                                          const QuantileEstimate& quantile);
/// Why a quantile over all runs or one of its bounds is missing; empty if none is.
[[nodiscard]] std::string why_missing(const Summary& summary, const OutputSummary& output,
                                      const QuantileEstimate& quantile);
/// Why a share of dependent draws has no bounds; empty if it has them, and for independent draws.
[[nodiscard]] std::string why_no_bound(const Summary& summary, const StatusShare& share);
/// Why a tolerance limit that was asked for is missing; empty if none is.
[[nodiscard]] std::string why_no_limit(const Summary& summary,
                                       const ToleranceLimitEstimate& estimate);

} // namespace wingspread
