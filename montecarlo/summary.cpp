#include "montecarlo/summary.hpp"

#include "montecarlo/reason_pattern.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace wingspread {

namespace {

Bounds share_bounds(const std::vector<bool>& hit, long hits, double confidence,
                    const Replication& replication) {
  if (hit.empty()) return {};
  if (replication.replicates == 0) {
    const Interval interval = clopper_pearson(hits, static_cast<long>(hit.size()), confidence);
    return {interval.lower, interval.upper};
  }
  std::vector<long> hits_of(static_cast<std::size_t>(replication.replicates), 0), sizes = hits_of;
  for (std::size_t row = 0; row < hit.size(); ++row) {
    const auto replicate = static_cast<std::size_t>(replication.of_row[row]);
    ++sizes[replicate];
    if (hit[row]) ++hits_of[replicate];
  }
  return replicate_proportion_bounds(hits_of, sizes, confidence);
}

StatusShare status_share(const Results& results, Status status, double confidence,
                         const Replication& replication) {
  std::vector<bool> hit;
  for (const Status each : results.status) hit.push_back(each == status);
  const long count = std::ranges::count(hit, true);
  const double rate = static_cast<double>(count) / static_cast<double>(results.size());
  return {status, count, rate, share_bounds(hit, count, confidence, replication)};
}

std::vector<ReasonCount> count_reasons(const Results& results) {
  struct Group {
    ReasonPattern pattern;
    long count = 0;
  };
  std::map<std::pair<Status, std::vector<std::string>>, Group> groups; // by status and words
  for (std::size_t row = 0; row < results.size(); ++row) {
    if (results.reason[row].empty()) continue;
    const ReasonPattern pattern = pattern_of(results.reason[row]);
    Group& group =
        groups.try_emplace({results.status[row], pattern.words}, Group{pattern, 0}).first->second;
    widen(group.pattern, pattern);
    ++group.count;
  }
  std::vector<ReasonCount> reasons;
  for (const auto& [key, group] : groups)
    reasons.push_back({key.first, to_string(group.pattern), group.count});
  std::ranges::stable_sort(reasons, [](const ReasonCount& a, const ReasonCount& b) {
    return a.status != b.status ? a.status < b.status : a.count > b.count;
  });
  return reasons;
}

std::vector<LatchOrderCount> count_latch_orders(const Results& results) {
  std::map<std::string, long> counts;
  for (const std::string& order : results.latch_order)
    if (!order.empty()) ++counts[order];
  std::vector<LatchOrderCount> orders;
  for (const auto& [order, count] : counts) orders.push_back({order, count});
  std::ranges::stable_sort(orders, std::ranges::greater{}, &LatchOrderCount::count);
  return orders;
}

/// The present values with their replicates, smallest first.
std::vector<ReplicateValue> with_replicates(const Column& column, const Replication& replication) {
  std::vector<ReplicateValue> values;
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
  const double mean_error = replicates > 0 ? replicate_mean_error(replicated, replicates, all.mean)
                                           : all.std / std::sqrt(static_cast<double>(all.count));
  return {column.name,
          all,
          mean_error,
          std::ssize(column.values) - std::ssize(sorted),
          estimate_quantiles(sorted, replicated, spec, replicates),
          histogram(sorted, spec.bins)};
}

Column success_column(const Results& results) {
  Column column{"deployed", {}};
  std::ranges::transform(results.status, std::back_inserter(column.values),
                         [](Status status) { return status == Status::deployed ? 1.0 : 0.0; });
  return column;
}

std::vector<DrawCorrelation> correlate(const Results& results) {
  const Column deployed = success_column(results);
  std::vector<const Column*> outputs;
  for (const Column& output : results.outputs) outputs.push_back(&output);
  outputs.push_back(&deployed);
  std::vector<RankedColumn> ranked;
  for (const Column* output : outputs) ranked.emplace_back(output->values);
  std::vector<DrawCorrelation> correlations;
  for (const Column& draw : results.draws) {
    const RankedColumn ranked_draw(draw.values);
    for (std::size_t i = 0; i < outputs.size(); ++i)
      correlations.push_back({draw.name, outputs[i]->name, correlation(ranked_draw, ranked[i])});
  }
  return correlations;
}

} // namespace

Summary summarize(const Results& results, const StatisticsSpec& spec,
                  const Replication& replication) {
  assert(replication.replicates == 0 || replication.of_row.size() == results.size());
  Summary summary{static_cast<long>(results.size()),
                  spec.confidence,
                  replication.replicates,
                  {},
                  count_reasons(results),
                  count_latch_orders(results),
                  std::ranges::count(results.latch_order, std::string{}),
                  {},
                  correlate(results)};
  for (const Status status : statuses)
    summary.statuses.push_back(status_share(results, status, spec.confidence, replication));
  for (const Column& output : results.outputs)
    summary.outputs.push_back(summarize_output(output, spec, replication));
  return summary;
}

} // namespace wingspread
