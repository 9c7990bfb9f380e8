#include "montecarlo/results/summary/summary.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "montecarlo/results/summary/reason_pattern.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace wingspread {

namespace {

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

/// The present values with their replicates, smallest first.
std::vector<ReplicateValue> with_replicates(const Column& column, const Replication& replication) {
  std::vector<ReplicateValue> values;
  values.reserve(column.values.size());
  for (std::size_t row = 0; row < column.values.size(); ++row)
    if (!std::isnan(column.values[row]))
      values.push_back({column.values[row], replication.of_row[row]});
  std::ranges::stable_sort(values, {}, &ReplicateValue::value);
  return values;
}

/// @param replicated the same values with their replicates, if there are any
std::vector<QuantileEstimate> estimate_quantiles(std::span<const double> sorted,
                                                 std::span<const ReplicateValue> replicated,
                                                 const StatisticsSpec& spec, int replicates) {
  std::vector<QuantileEstimate> estimates;
  for (const double p : spec.quantiles) {
    const Bounds bounds =
        replicates > 0 ? replicate_quantile_bounds(replicated, replicates, p, spec.confidence)
                       : quantile_bounds(sorted, p, spec.confidence);
    estimates.push_back({p, quantile(sorted, p), bounds});
  }
  return estimates;
}

OutputSummary summarize_output(const Column& column, const StatisticsSpec& spec,
                               const Replication& replication) {
  // Sorted values make even the last bits independent of the order of the rows.
  const std::vector<double> sorted = sorted_present(column.values);
  const Moments all = moments(sorted);
  const int replicates = replication.replicates;
  std::vector<ReplicateValue> replicated;
  if (replicates > 0) replicated = with_replicates(column, replication);
  column.values.release();
  const double mean_error = replicates > 0 ? replicate_mean_error(replicated, replicates, all.mean)
                                           : all.std / std::sqrt(static_cast<double>(all.count));
  return {column.name,
          all,
          mean_error,
          std::ssize(column.values) - std::ssize(sorted),
          estimate_quantiles(sorted, replicated, spec, replicates),
          histogram(sorted, spec.bins)};
}

/// The reasons, and each output.
void summarize_columns(const Results& results, const StatisticsSpec& spec,
                       const Replication& replication, int threads, Summary& summary) {
  const std::size_t bytes = (replication.replicates > 0 ? 56 : 16) * results.size();
  summary.outputs.resize(results.outputs.size());
  const std::size_t tasks = 1 + results.outputs.size();
  const int team =
      threads_worth(threads, sorting_operations(results.size()) * static_cast<double>(tasks));
  for_each_task(threads_within_memory(team, bytes), tasks, [&](std::size_t task) {
    if (task == 0)
      summary.reasons = count_reasons(results);
    else
      summary.outputs[task - 1] = summarize_output(results.outputs[task - 1], spec, replication);
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

StatusShare status_share(Status status, long count, long runs, double confidence) {
  StatusShare share{status, count, static_cast<double>(count) / static_cast<double>(runs), {}};
  if (runs == 0) return share;
  const Interval interval = clopper_pearson(count, runs, confidence);
  share.bounds = {interval.lower, interval.upper};
  return share;
}

Column deployed_column(const Results& results) {
  Column column{"deployed", {}};
  for (const Status status : results.status) {
    const bool stayed = status == Status::stalled || status == Status::timed_out;
    column.values.push_back(status == Status::deployed ? 1 : stayed ? 0 : undefined);
  }
  results.status.release();
  return column;
}

Summary summarize(const Results& results, const StatisticsSpec& spec,
                  const Replication& replication, int threads) {
  assert(replication.replicates == 0 || replication.of_row.size() == results.size());
  Summary summary;
  summary.runs = static_cast<long>(results.size());
  summary.confidence = spec.confidence;
  summary.replicates = replication.replicates;
  for (const Status status : statuses)
    summary.statuses.push_back(share_of_status(results, status, spec.confidence, replication));
  count_latch_orders(results.latch_order, summary);
  summarize_columns(results, spec, replication, threads, summary);
  summary.correlations = correlate_draws(results, threads);
  return summary;
}

} // namespace wingspread
