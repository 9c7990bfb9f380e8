#include "montecarlo/results/summary/summary.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "montecarlo/results/summary/reason_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace wingspread {

namespace {

constexpr std::string_view replicates_agree =
    "no bounds: all replicates agree, which says nothing about the error";

Bounds replicate_share_bounds(const std::vector<bool>& hit, double confidence,
                              const Replication& replication) {
  std::vector<long> hits_of(static_cast<std::size_t>(replication.replicates), 0), sizes = hits_of;
  for (std::size_t row = 0; row < hit.size(); ++row) {
    const auto replicate = static_cast<std::size_t>(replication.of_row[row]);
    ++sizes[replicate];
    if (hit[row]) ++hits_of[replicate];
  }
  return replicate_proportion_bounds(hits_of, sizes, confidence);
}

StatusShare share_of_status(const Results& results, Status status, double confidence,
                            const Replication& replication) {
  std::vector<bool> hit;
  for (const Status each : results.status) hit.push_back(each == status);
  StatusShare share =
      status_share(status, std::ranges::count(hit, true), std::ssize(results.status), confidence);
  if (replication.replicates > 0 && !hit.empty())
    share.bounds = replicate_share_bounds(hit, confidence, replication);
  return share;
}

std::vector<ReasonCount> count_reasons(const Results& results) {
  ReasonCounts counts;
  for (std::size_t row = 0; row < results.size(); ++row)
    counts.add(results.status[row], results.reason[row]);
  results.reason.release();
  results.status.release();
  return counts.sorted();
}

std::vector<StoppedHinge> stopped_hinges(const Results& results) {
  std::vector<std::string> names;
  for (const Column& column : results.outputs) names.push_back(column.name);
  std::vector<StoppedHinge> stopped;
  for (const FinalAngleColumns& columns : final_angle_columns(names)) {
    std::vector<double> angles;
    for (std::size_t row = 0; row < results.size(); ++row) {
      const auto value = [&](std::size_t column) { return results.outputs[column].values[row]; };
      if (columns.stopped(results.status[row], value)) angles.push_back(value(columns.angle));
    }
    results.outputs[columns.angle].values.release();
    if (columns.latch_time) results.outputs[*columns.latch_time].values.release();
    if (angles.empty()) continue;
    std::ranges::sort(angles);
    stopped.push_back(
        {columns.hinge, std::ssize(angles), quantile(angles, 0.5), angles.front(), angles.back()});
  }
  results.status.release();
  return stopped;
}

void count_latch_orders(const DictionaryColumn& column, Summary& summary) {
  const TextColumn& orders = column.texts();
  std::vector<long> counts(orders.size(), 0);
  for (const std::uint32_t code : column.codes()) ++counts[code];
  std::vector<std::uint32_t> codes; // of the orders, without that of runs in which no hinge latched
  for (std::uint32_t code = 0; code < orders.size(); ++code)
    if (orders[code].empty())
      summary.without_latch = counts[code];
    else
      codes.push_back(code);
  const auto listed = static_cast<std::ptrdiff_t>(std::min(codes.size(), most_latch_orders));
  std::ranges::partial_sort(codes, codes.begin() + listed, [&](std::uint32_t a, std::uint32_t b) {
    return counts[a] != counts[b] ? counts[a] > counts[b] : orders[a] < orders[b];
  });
  for (const std::uint32_t code : std::span(codes).first(static_cast<std::size_t>(listed)))
    summary.latch_orders.push_back({std::string(orders[code]), counts[code]});
  summary.latch_order_kinds = std::ssize(codes);
  column.release();
}

/// A column in ascending order.
struct SortedColumn {
  std::vector<double> present;
  long missing = 0;
  int replicates = 0;                       ///< 0: draws are independent
  std::vector<ReplicateValue> replicated{}; ///< the present values with their replicates
  std::vector<long> missing_of{};           ///< per replicate

  SortedColumn(const Column& column, const Replication& replication)
      : present(sorted_present(column.values)),
        missing(std::ssize(column.values) - std::ssize(present)),
        replicates(replication.replicates), missing_of(static_cast<std::size_t>(replicates), 0) {
    for (std::size_t row = 0; replicates > 0 && row < column.values.size(); ++row)
      if (const int its = replication.of_row[row]; std::isnan(column.values[row]))
        ++missing_of[static_cast<std::size_t>(its)];
      else
        replicated.push_back({column.values[row], its});
    std::ranges::stable_sort(replicated, {}, &ReplicateValue::value);
    column.values.release();
  }

  [[nodiscard]] QuantileEstimate quantile_at(double p, double confidence, MissingRank end) const {
    const long count = std::ssize(present);
    QuantileEstimate estimate{
        p, value_of(p, confidence, {count, missing, end}, {missing_of, end}), {}};
    if (missing > 0 && count > 0) estimate.among = value_of(p, confidence, {count}, {});
    return estimate;
  }

private:
  [[nodiscard]] QuantileValue value_of(double p, double confidence, const PartialRanks& ranks,
                                       const MissingOfReplicates& missing_ones) const {
    return {quantile(present, ranks, p),
            replicates > 0
                ? replicate_quantile_bounds(replicated, replicates, p, confidence, missing_ones)
                : quantile_bounds(present, ranks, p, confidence)};
  }
};

OutputSummary summarize_output(const Column& column, const StatisticsSpec& spec,
                               const Replication& replication,
                               std::span<const Requirement> requirements) {
  // Sorted values make even the last bits independent of the order of the rows.
  const SortedColumn sorted(column, replication);
  const Moments all = moments(sorted.present);
  const double mean_error =
      sorted.replicates > 0 ? replicate_mean_error(sorted.replicated, sorted.replicates, all.mean)
                            : all.std / std::sqrt(static_cast<double>(all.count));
  const MissingRank end = missing_rank(requirements, column.name);
  std::vector<QuantileEstimate> quantiles;
  for (const double p : spec.quantiles)
    quantiles.push_back(sorted.quantile_at(p, spec.confidence, end));
  return {
      column.name, all, mean_error, sorted.missing, quantiles, histogram(sorted.present, spec.bins),
      end};
}

/// The reasons, and each output.
void summarize_columns(const Results& results, const StatisticsSpec& spec,
                       const Replication& replication, int threads,
                       std::span<const Requirement> requirements, Summary& summary) {
  const std::size_t bytes = (replication.replicates > 0 ? 56 : 16) * results.size();
  summary.outputs.resize(results.outputs.size());
  const std::size_t tasks = 1 + results.outputs.size();
  const int team =
      threads_worth(threads, sorting_operations(results.size()) * static_cast<double>(tasks));
  for_each_task(threads_within_memory(team, bytes), tasks, [&](std::size_t task) {
    if (task == 0)
      summary.reasons = count_reasons(results), summary.stalled_at = stopped_hinges(results);
    else
      summary.outputs[task - 1] =
          summarize_output(results.outputs[task - 1], spec, replication, requirements);
  });
}

std::vector<DrawCorrelation> correlate_draws(const Results& results, int threads) {
  const Column deployed = deployed_column(results);
  std::vector<const Spilled<double>*> draws, outputs;
  for (const Column& draw : results.draws) draws.push_back(&draw.values);
  for (const Column& output : results.outputs) outputs.push_back(&output.values);
  outputs.push_back(&deployed.values);
  const std::vector<Correlation> found =
      pairwise_correlations(rank_columns(draws, threads), rank_columns(outputs, threads), threads);
  std::vector<DrawCorrelation> named;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t output = i % outputs.size();
    named.push_back({results.draws[i / outputs.size()].name,
                     output < results.outputs.size() ? results.outputs[output].name : deployed.name,
                     found[i]});
  }
  return named;
}

} // namespace

std::vector<FinalAngleColumns> final_angle_columns(const std::vector<std::string>& outputs) {
  std::vector<FinalAngleColumns> found;
  for (std::size_t column = 0; column < outputs.size(); ++column) {
    const OutputName name = parse_output_name(outputs[column]);
    if (name.quantity != "final_angle") continue;
    const auto latched = std::ranges::find(outputs, name.hinge + ".latch_time");
    found.push_back({name.hinge, column, {}});
    if (latched != outputs.end())
      found.back().latch_time = static_cast<std::size_t>(latched - outputs.begin());
  }
  return found;
}

StatusShare status_share(Status status, long count, long runs, double confidence) {
  StatusShare share{status, count, static_cast<double>(count) / static_cast<double>(runs), {}};
  if (runs == 0) return share;
  const Interval interval = clopper_pearson(count, runs, confidence);
  share.bounds = {interval.lower, interval.upper};
  return share;
}

std::string_view words_of(MissingRank end) {
  switch (end) {
  case MissingRank::below:
    return "below every value";
  case MissingRank::either:
    return "above every value; bounds hold for both ends (requirements limit both sides)";
  case MissingRank::above:
    break;
  }
  return "above every value";
}

std::string why_no_quantile(const OutputSummary& output, const QuantileEstimate& quantile) {
  const long count = output.moments.count;
  if (!std::isnan(quantile.all.value)) return "";
  if (count == 0) return "no run has a value";
  return fmt::format("{} of {} runs have a value; the others rank {}", count,
                     count + output.missing, words_of(output.missing_end));
}

namespace {

/// Why a quantile lacks a bound, though it exists.
std::string why_no_bound(const Summary& summary, const OutputSummary& output) {
  if (summary.replicates == 1) return std::string(one_replicate);
  const std::string values = output.missing > 0
                                 ? fmt::format("{}, {} of them without a value,",
                                               counted(summary.runs, "run", "runs"), output.missing)
                                 : counted(output.moments.count, "value", "values");
  if (summary.replicates > 1)
    return fmt::format("{} in {} replicates are too few, or agree too well, for every bound at a "
                       "confidence of {:.6g}",
                       values, summary.replicates, summary.confidence_of_bound());
  return fmt::format("{} too few for every bound at a confidence of {:.6g}",
                     output.missing == 0 && output.moments.count == 1 ? values + " is"
                                                                      : values + " are",
                     summary.confidence_of_bound());
}

} // namespace

std::string why_missing(const Summary& summary, const OutputSummary& output,
                        const QuantileEstimate& quantile) {
  const Bounds& bounds = quantile.all.bounds;
  std::string why = why_no_quantile(output, quantile);
  return why.empty() && !(bounds.lower && bounds.upper) ? why_no_bound(summary, output) : why;
}

std::string why_no_bound(const Summary& summary, const StatusShare& share) {
  if (share.bounds.lower || summary.replicates == 0) return "";
  return std::string(summary.replicates == 1 ? one_replicate : replicates_agree);
}

std::string why_no_limit(const Summary& summary, const ToleranceLimitEstimate& estimate) {
  const auto& [spec, limits, beyond] = estimate;
  const bool missing =
      (spec.side != Side::upper && !limits.lower) || (spec.side != Side::lower && !limits.upper);
  if (!missing) return "";
  const double c = summary.interim.confidence_of_bound(spec.confidence);
  const long order = tolerance_order(summary.runs, spec.side, spec.probability, c);
  if (order > 0)
    return fmt::format("{} of {} runs rank beyond every number; at most {} may", beyond,
                       summary.runs, order - 1);
  const auto least = runs_to_show(spec.probability, c, spec.side == Side::both ? 1 : 0);
  return fmt::format("{} too few: it takes {}", counted(summary.runs, "run is", "runs are"),
                     least ? std::to_string(*least) : fmt::format("more than {}", most_runs_sized));
}

Column deployed_column(const Results& results) {
  Column column{"deployed", {}};
  for (const Status status : results.status)
    column.values.push_back(status == Status::deployed ? 1 : 0);
  results.status.release();
  return column;
}

Summary summarize(const Results& results, const StatisticsSpec& spec,
                  const Replication& replication, int threads,
                  std::span<const Requirement> requirements) {
  assert(replication.replicates == 0 || replication.of_row.size() == results.size());
  Summary summary;
  summary.runs = static_cast<long>(results.size());
  summary.confidence = spec.confidence;
  summary.replicates = replication.replicates;
  for (const Status status : statuses)
    summary.statuses.push_back(share_of_status(results, status, spec.confidence, replication));
  count_latch_orders(results.latch_order, summary);
  summarize_columns(results, spec, replication, threads, requirements, summary);
  summary.correlations = correlate_draws(results, threads);
  return summary;
}

} // namespace wingspread
