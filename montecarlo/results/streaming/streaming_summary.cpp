#include "montecarlo/results/streaming/streaming_summary.hpp"

#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

using Bin = ValueCounts::Bin;

/// Treated as infinite, as in verdict.cpp.
constexpr double no_number = std::numeric_limits<double>::max();

QuantileValue quantile_of(const RankedPopulation& values, const PartialRanks& ranks, double p,
                          double confidence) {
  QuantileValue quantile;
  if (values.count() == 0) return quantile;
  if (const auto rank = ranks.among_present(quantile_rank(ranks.all(), p))) {
    const OrderStatistic found = values.at(*rank);
    quantile.value = found.value;
    quantile.error = QuantileError{found.rank_error, found.lower, found.upper};
  }
  const RankBounds bounds = quantile_rank_bounds(ranks, p, confidence);
  if (bounds.lower) quantile.bounds.lower = values.at(*bounds.lower).lower;
  if (bounds.upper) quantile.bounds.upper = values.at(*bounds.upper).upper;
  return quantile;
}

/// Quantiles over all runs, and among those with a value.
QuantileEstimate estimate_quantile(const RankedPopulation& values, const PartialRanks& ranks,
                                   double p, double confidence) {
  QuantileEstimate estimate{p, quantile_of(values, ranks, p, confidence), {}};
  if (ranks.missing > 0 && ranks.present > 0)
    estimate.among = quantile_of(values, {ranks.present}, p, confidence);
  return estimate;
}

/// The bin edge nearest to `wanted`, and the number of values below that edge.
std::pair<double, long> edge_near(const std::vector<Bin>& bins, double wanted) {
  const auto next =
      std::ranges::partition_point(bins, [&](const Bin& bin) { return bin.upper <= wanted; });
  if (next == bins.end()) return {wanted, bins.back().below + bins.back().count};
  if (wanted <= next->lower) return {wanted, next->below};
  return wanted - next->lower < next->upper - wanted
             ? std::pair(next->lower, next->below)
             : std::pair(next->upper, next->below + next->count);
}

/// A histogram with bins of nearly equal width: each edge is moved to the nearest edge of the stored bins, so that
/// counts are exact.
Histogram histogram_of(const RankedPopulation& values, const Bins& bins) {
  if (values.count() == 0) return {};
  const long n = values.count();
  if (values.min() == values.max()) return {histogram(std::vector{values.min()}, 1).edges, {n}};
  const double iqr =
      values.at(quantile_rank(n, 0.75)).value - values.at(quantile_rank(n, 0.25)).value;
  const int wanted = count_bins(bins, n, values.max() - values.min(), iqr);
  Histogram result{{values.min()}, {}};
  long below = 0;
  for (int i = 1; i < wanted; ++i) {
    const auto [edge, count] = edge_near(
        values.bins(), std::lerp(values.min(), values.max(), static_cast<double>(i) / wanted));
    if (!(edge > result.edges.back() && edge < values.max())) continue;
    result.edges.push_back(edge);
    result.counts.push_back(count - below);
    below = count;
  }
  result.edges.push_back(values.max());
  result.counts.push_back(n - below);
  return result;
}

/// An output without a value in the pilot has no shift, and its sums lose the digits by which its mean exceeds its
/// standard deviation. Its values are rare: as long as all of them are kept, the moments are theirs.
Moments moments_of(const StreamingStatistics::Output& output) {
  const Population& values = output.values;
  const bool any = values.count() > 0;
  if (any && output.scale == Scale{} && values.count() <= static_cast<long>(kept_extremes)) {
    std::vector<double> all;
    for (const RunValue& each : values.lowest().sorted()) all.push_back(each.value);
    return moments(all);
  }
  return output.sums.moments(output.scale, any ? values.min() : undefined,
                             any ? values.max() : undefined);
}

OutputSummary output_summary(const std::string& name, const StreamingStatistics::Output& output,
                             long runs, const StatisticsSpec& spec,
                             std::span<const Requirement> requirements) {
  OutputSummary summary{
      name, {}, 0, runs - output.values.count(), {}, {}, missing_rank(requirements, name)};
  const RankedPopulation values(output.values);
  summary.moments = moments_of(output);
  summary.mean_error = summary.moments.std / std::sqrt(static_cast<double>(values.count()));
  for (const double p : spec.quantiles)
    summary.quantiles.push_back(estimate_quantile(
        values, {values.count(), summary.missing, summary.missing_end}, p, spec.confidence));
  summary.histogram = histogram_of(values, spec.bins);
  return summary;
}

/// A required output's values over all runs. Runs worse than any number rank at the end that breaks the requirement.
class RankedRequired {
public:
  explicit RankedRequired(const RequiredPopulation& population)
      : values_(population.values), worse_(population.worse) {}

  [[nodiscard]] const RankedPopulation& numbers() const { return values_; }
  [[nodiscard]] long beyond() const { return worse_; }
  /// The value at a rank counted from above, 1 for the largest; nothing if a run worse than any number has that rank.
  /// @param end where runs worse than any number rank
  [[nodiscard]] std::optional<OrderStatistic> from_above(long rank, MissingRank end) const {
    return from_below(values_.count() + worse_ + 1 - rank, end);
  }
  [[nodiscard]] std::optional<OrderStatistic> from_below(long rank, MissingRank end) const {
    const auto place = PartialRanks{values_.count(), worse_, end}.among_present(rank);
    return place ? std::optional(values_.at(*place)) : std::nullopt;
  }

private:
  RankedPopulation values_;
  long worse_;
};

std::optional<double> number_of(const std::optional<OrderStatistic>& found,
                                double OrderStatistic::*which) {
  if (!found || !(std::abs((*found).*which) < no_number)) return std::nullopt;
  return (*found).*which;
}

/// Tolerance limits as by tolerance_limits (wilks.hpp), but at the outer edges of the bins.
Bounds limits_of(const RankedRequired& values, long runs, const ToleranceLimitSpec& spec) {
  const long order = tolerance_order(runs, spec.side, spec.probability, spec.confidence);
  if (order == 0) return {};
  Bounds limits;
  if (spec.side != Side::upper)
    limits.lower =
        number_of(values.from_below(order, spec.side == Side::lower ? MissingRank::below
                                                                    : MissingRank::above),
                  &OrderStatistic::lower);
  if (spec.side != Side::lower)
    limits.upper = number_of(values.from_above(order, MissingRank::above), &OrderStatistic::upper);
  return limits;
}

/// Sets the values of the output. If the requirement is passed, both are at least as good as the limit.
void add_values(const RankedRequired& values, Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  const bool is_min = requirement.min.has_value();
  const auto from_worst = [&](long place) { // place 0 is the worst run
    return is_min ? values.from_below(place + 1, MissingRank::below)
                  : values.from_above(place + 1, MissingRank::above);
  };
  if (verdict.runs > 0)
    verdict.observed =
        number_of(from_worst(verdict.runs - quantile_rank(verdict.runs, requirement.probability)),
                  &OrderStatistic::value);
  if (verdict.allowed)
    verdict.guaranteed = number_of(from_worst(*verdict.allowed),
                                   is_min ? &OrderStatistic::lower : &OrderStatistic::upper);
  if (verdict.decision == Decision::pass) // the exact count of runs beyond the limit says so
    for (std::optional<double>* value : {&verdict.guaranteed, &verdict.observed})
      if (*value)
        *value = is_min ? std::max(**value, *requirement.min) : std::min(**value, *requirement.max);
  if (verdict.guaranteed)
    verdict.margin = limit_of(requirement) - sign_of(requirement) * *verdict.guaranteed;
  if (values.numbers().count() > 0)
    verdict.beyond_zero = beyond_zero(values.numbers().min(), values.numbers().max(), requirement);
}

std::vector<Verdict> verdicts_of(const Campaign& campaign, const StreamingStatistics& statistics,
                                 const std::vector<RankedRequired>& ranked) {
  std::vector<Verdict> verdicts;
  for (std::size_t r = 0; r < campaign.requirements.size(); ++r) {
    const Requirement& requirement = campaign.requirements[r];
    const RequirementCounts& counted = statistics.requirements()[r];
    Verdict verdict;
    verdict.requirement = requirement;
    verdict.runs = statistics.runs();
    for (const RunValue& worst : counted.worst.sorted()) verdict.broken.push_back(worst.run);
    verdict.not_listed = counted.failures - std::ssize(verdict.broken);
    verdict.cut = counted.cut, verdict.open = counted.open, verdict.absent = counted.absent;
    decide(confidence_alone(campaign.requirements, requirement), {}, verdict);
    const auto found = std::ranges::find_if(statistics.required(), [&](const RequiredOutput& each) {
      return is_of(each, requirement);
    });
    if (found != statistics.required().end())
      add_values(ranked[static_cast<std::size_t>(found - statistics.required().begin())], verdict);
    else if (verdict.allowed)
      verdict.margin = verdict.guaranteed_share - requirement.probability;
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

void add_counts(const StreamingStatistics& statistics, double confidence, Summary& summary) {
  const long n = statistics.runs();
  for (const Status status : statuses)
    summary.statuses.push_back(status_share(status, statistics.count_of(status), n, confidence));
  summary.reasons = statistics.reasons().sorted();
  for (const auto& [order, count] : statistics.latch_orders())
    if (order.empty())
      summary.without_latch = count;
    else
      summary.latch_orders.push_back({order, count});
  summary.latch_order_kinds = std::ssize(summary.latch_orders);
  summary.more_order_kinds = statistics.other_orders() > 0;
  std::ranges::stable_sort(summary.latch_orders, std::greater{}, &LatchOrderCount::count);
  if (summary.latch_orders.size() > most_latch_orders)
    summary.latch_orders.resize(most_latch_orders);
}

void add_correlations(const ResultNames& names, const StreamingStatistics& statistics,
                      Summary& summary) {
  if (!statistics.correlations()) return;
  for (std::size_t i = 0; i < names.draws.size(); ++i)
    for (std::size_t j = 0; j <= names.outputs.size(); ++j)
      summary.correlations.push_back({names.draws[i],
                                      j < names.outputs.size() ? names.outputs[j] : "deployed",
                                      statistics.correlations()->of(i, j)});
}

/// The counterpart of stopped_hinges (summary.cpp), which reads rows.
std::vector<StoppedHinge> stopped_hinges(const StreamingStatistics& statistics) {
  std::vector<StoppedHinge> stopped;
  for (const auto& [columns, angles] : statistics.stopped()) {
    if (angles.count() == 0) continue;
    const RankedPopulation ranked(angles);
    stopped.push_back({columns.hinge, ranked.count(),
                       ranked.at(quantile_rank(ranked.count(), 0.5)).value, ranked.min(),
                       ranked.max()});
  }
  return stopped;
}

/// The counterpart of overtravels (overtravel.hpp), which reads rows.
void add_overtravels(const Scene& scene, const ResultNames& names,
                     const StreamingStatistics& statistics, Summary& summary) {
  for (const Hinge& hinge : scene.hinges) {
    const auto found = std::ranges::find(names.outputs, hinge.name + ".overtravel");
    if (hinge.stop || found == names.outputs.end()) continue;
    const StreamingStatistics::Output& output =
        statistics.outputs()[static_cast<std::size_t>(found - names.outputs.begin())];
    if (output.beyond_stowed > 0)
      summary.overtravels.push_back({hinge.name, output.beyond_stowed, output.values.max()});
  }
}

} // namespace

Summary streaming_summary(const StoredCampaign& stored, const StreamingStatistics& statistics,
                          const StatisticsSpec& spec) {
  const Campaign& campaign = stored.campaign;
  const ResultNames names = RunPlan(campaign).names();
  Summary summary;
  summary.runs = statistics.runs();
  summary.confidence = spec.confidence;
  summary.without_rows = true;
  add_counts(statistics, spec.confidence, summary);
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    summary.outputs.push_back(output_summary(names.outputs[i], statistics.outputs()[i],
                                             statistics.runs(), spec, campaign.requirements));
  add_correlations(names, statistics, summary);
  std::vector<RankedRequired> ranked;
  for (const RequiredPopulation& population : statistics.required_values())
    ranked.emplace_back(population);
  summary.requirements = verdicts_of(campaign, statistics, ranked);
  for (const ToleranceLimitSpec& limit : spec.tolerance_limits)
    for (std::size_t q = 0; q < ranked.size(); ++q) {
      const RequiredOutput& required = statistics.required()[q];
      if (required.absolute || required.column >= names.outputs.size() ||
          required.from_below != takes_cut_peaks(required.output, limit.side == Side::lower))
        continue;
      summary.outputs[required.column].tolerance_limits.push_back(
          {limit, limits_of(ranked[q], statistics.runs(), limit), ranked[q].beyond()});
    }
  add_nominal(campaign, summary);
  add_overtravels(campaign.scene, names, statistics, summary);
  summary.stalled_at = stopped_hinges(statistics);
  if (names.peaks_final) {
    summary.peaks.emplace();
    for (const PeaksFinal final : all_peaks_final)
      summary.peaks->add(final, statistics.peaks()[static_cast<std::size_t>(final)]);
  }
  withdraw_if_one_run(campaign, summary);
  explain_cuts(campaign, summary);
  if (stored.stamp.is_part() || statistics.runs() < stored.runs().size()) withdraw_of_part(summary);
  return summary;
}

std::string extremes_csv(const ResultNames& names, const StreamingStatistics& statistics) {
  std::string csv = "output,end,rank,run,value\n";
  const auto add = [&](const std::string& name, const char* end, const Extremes& extremes) {
    long rank = 0;
    for (const auto& [value, run] : extremes.sorted()) {
      append_csv_cell(csv, name);
      append_csv_cells(csv, std::string_view(end), ++rank, run, value);
      csv += '\n';
    }
  };
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    add(names.outputs[i], "lowest", statistics.outputs()[i].values.lowest());
    add(names.outputs[i], "highest", statistics.outputs()[i].values.highest());
  }
  return csv;
}

} // namespace wingspread
