/// What a campaign's results come to: plain data, from which the files (summary_json.hpp) and the
/// terminal's table (table.hpp) are written.
///
/// Nothing is dropped silently: each output is summarised over the runs in which it happened, with
/// the number in which it did not. The same results give the same summary, bit for bit.
#pragma once

#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"
#include "montecarlo/foundation/statistics/histogram.hpp"
#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/results/summary/overtravel.hpp"
#include "montecarlo/results/summary/reason_pattern.hpp"
#include "montecarlo/results/summary/replication.hpp"
#include "montecarlo/results/summary/stopping.hpp"
#include "montecarlo/results/summary/verdict.hpp"

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

/// Of latch orders the most frequent, up to this many: long chains may latch otherwise in each run.
inline constexpr std::size_t most_latch_orders = 1000;

struct LatchOrderCount {
  std::string order; ///< "root>mid>tip"
  long count = 0;
};

/// How far off a quantile may be that is taken from counts, where rows are not kept.
struct QuantileError {
  long rank;           ///< the value's own rank is at most so far from the quantile's
  double lower, upper; ///< the quantile is within these
};

struct QuantileEstimate {
  double p;
  double value; ///< NaN without values
  Bounds bounds;
  std::optional<QuantileError> error{}; ///< none of rows
};

struct ToleranceLimitEstimate {
  ToleranceLimitSpec spec;
  Bounds limits;
};

struct OutputSummary {
  std::string name;
  Moments moments;       ///< over the runs in which it happened; `moments.count` of them
  double mean_error = 0; ///< standard error of the mean; NaN where nothing tells it
  long missing = 0;      ///< runs in which it did not
  std::vector<QuantileEstimate> quantiles;
  Histogram histogram;
  std::vector<ToleranceLimitEstimate> tolerance_limits{}; ///< over all runs (verdict.hpp)
  std::optional<double>
      nominal{}; ///< of the nominal run; NaN where it did not happen, nothing where there is none
};

/// What became of the wing with nothing dispersed.
struct NominalRun {
  Status status = Status::failed;
  std::string latch_order, reason;
};

/// 1 for a run that deployed, 0 for one that stalled or timed out, NaN for the others: what became
/// of them is not known.
[[nodiscard]] Column deployed_column(const Results& results);

/// Between a draw and an output, or `deployed` (deployed_column(); Pearson's is then the
/// point-biserial correlation).
struct DrawCorrelation {
  std::string draw, output;
  Correlation value;
};

/// Of how many runs the peaks are proven, were cut by t_end, and are not known (it failed, or was invalid).
struct PeaksCount {
  long proven = 0, cut = 0, unknown = 0;
};

struct Summary {
  long runs = 0;
  double confidence = 0; ///< of all bounds, two-sided
  int replicates = 0;    ///< that the bounds come from; 0: they are binomial, for independent draws
  std::vector<StatusShare> statuses;         ///< all five
  std::vector<ReasonCount> reasons;          ///< by status, then the most frequent, then by text
  std::vector<LatchOrderCount> latch_orders; ///< the most frequent first, then by name
  long latch_order_kinds = 0;                ///< how many there are, those not listed among them
  long without_latch = 0;                    ///< runs in which no hinge latched
  std::vector<OutputSummary> outputs;        ///< in the order of the columns
  std::vector<DrawCorrelation> correlations; ///< each draw with each output and with `deployed`
  // What the campaign asks for beyond its statistics; write_statistics (results_folder.hpp) adds it.
  std::vector<Verdict> requirements{};
  std::optional<NominalRun> nominal{};   ///< its outputs stand with theirs
  std::optional<Accuracy> accuracy{};    ///< of the integration; none where nobody measured it
  std::vector<Overtravel> overtravels{}; ///< of hinges without a stop
  std::optional<PeaksCount> peaks{};     ///< none where it was not recorded
  std::vector<GoalFound> until{};        ///< what decides when it stops
  bool stopped = false;                  ///< they did, before all runs were made
  long looks = 1;                        ///< at growing data: each bound's α is shared among them
  bool without_rows = false;             ///< worked out of counts and sums (rowless/)
  std::vector<long> looked_at{}; ///< numbers of runs before the campaign was extended: looks too
};

/// Cost O((D + O) N log N + D O N) for D draws, O outputs, N runs. Memory: 20 to 50 bytes a run for
/// each thread, and no more threads than 1 GiB has room for; what is read of the results is
/// released. Temporary files: 4 bytes a run for each column, and 12 where values are missing.
/// @param threads as of thread_count (team.hpp); the summary does not depend on them
/// @pre replication.of_row is as long as the results unless there are no replicates
[[nodiscard]] Summary summarize(const Results& results, const StatisticsSpec& spec,
                                const Replication& replication = {}, int threads = 0);

} // namespace wingspread
