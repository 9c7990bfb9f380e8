#include "montecarlo/report/data/output_json.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/report/data/convergence.hpp"
#include "montecarlo/report/data/distribution_curve.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace wingspread {
namespace {

Json moments_json(const OutputSummary& output) {
  const Moments& m = output.moments;
  const int digits = digits_of(m);
  return {{"count", m.count},
          {"missing", output.missing},
          {"nominal", page_number(output.nominal, digits)},
          {"mean", page_number(m.mean, digits)},
          {"mean_error", page_number(output.mean_error)},
          {"std", page_number(m.std)},
          {"min", page_number(m.min, digits)},
          {"max", page_number(m.max, digits)},
          {"skewness", page_number(m.skewness)},
          {"kurtosis", page_number(m.kurtosis)}};
}

Json quantiles_json(const Summary& summary, const OutputSummary& output) {
  Json json = Json::array();
  const int digits = digits_of(output.moments);
  const auto add = [digits](Json& to, const QuantileValue& quantile) {
    to["value"] = page_number(quantile.value, digits);
    add_bounds(to, quantile.bounds, digits);
  };
  // The page says "above 3" where one bound is there; the note is why it has none.
  const auto has_none = [](const QuantileValue& quantile) {
    return !quantile.bounds.lower && !quantile.bounds.upper;
  };
  for (const QuantileEstimate& quantile : output.quantiles) {
    json.push_back({{"p", quantile.p}});
    add(json.back(), quantile.all);
    if (quantile.among) add(json.back()["among"], *quantile.among);
    if (std::isnan(quantile.all.value) || has_none(quantile.all))
      json.back()["note"] = why_missing(summary, output, quantile);
    if (quantile.among && has_none(*quantile.among) && summary.replicates == 1)
      json.back()["among"]["note"] = one_replicate;
  }
  return json;
}

/// Merges neighbouring bins, so that at most `most_bins` are left.
Histogram coarser(const Histogram& own, std::size_t most_bins) {
  const std::size_t each = (own.counts.size() + most_bins - 1) / most_bins;
  Histogram merged;
  for (std::size_t bin = 0; bin < own.counts.size(); ++bin) {
    if (bin % each == 0) merged.edges.push_back(own.edges[bin]), merged.counts.push_back(0);
    merged.counts.back() += own.counts[bin];
  }
  merged.edges.push_back(own.edges.back());
  return merged;
}

/// The summary's bins, or `most_bins` if these are fewer.
/// @param sorted the values; empty without rows
Json histogram_json(const PageSource& source, std::size_t index, std::span<const double> sorted,
                    std::size_t most_bins) {
  const Histogram& own = source.summary.outputs[index].histogram;
  const Histogram shown = own.counts.size() <= most_bins ? own
                          : source.has_rows() ? histogram(sorted, static_cast<int>(most_bins))
                                              : coarser(own, most_bins);
  return {{"edges", page_numbers(shown.edges, digits_that_tell(shown.edges, 10))},
          {"counts", shown.counts},
          {"by_order", source.orders->counts(shown, source.results.outputs[index].values)}};
}

Json curve_json(const PageSource& source, const OutputSummary& output,
                const DistributionCurve& curve) {
  const int digits = digits_of(output.moments);
  Json json{{"x", Json::array()},
            {"p", Json::array()},
            {"lower", Json::array()},
            {"upper", Json::array()},
            {"steps", curve.steps}};
  for (const CurveKnot& knot : curve.knots) {
    json["x"].push_back(page_number(knot.x, digits));
    json["p"].push_back(page_share(knot.p));
    json["lower"].push_back(page_number(knot.band.lower));
    json["upper"].push_back(page_number(knot.band.upper));
  }
  json["band"] = band_name(source.replication.replicates, source.confidence);
  return json;
}

Json convergence_json(const OutputSummary& output, const Convergence& convergence) {
  // The mean moves by its standard error, which is less than the values' spread.
  const Moments& m = output.moments;
  const double spread = output.mean_error > 0 ? std::min(output.mean_error, m.std) : m.std;
  const int digits = digits_that_show(spread, std::max(std::abs(m.min), std::abs(m.max)));
  Json json{{"runs", Json::array()},           {"mean", Json::array()},
            {"lower", Json::array()},          {"upper", Json::array()},
            {"quantile_p", convergence.p},     {"quantile", Json::array()},
            {"quantile_lower", Json::array()}, {"quantile_upper", Json::array()}};
  for (const ConvergencePoint& point : convergence.points) {
    json["runs"].push_back(point.runs);
    json["mean"].push_back(page_number(point.mean, digits));
    json["lower"].push_back(page_number(point.mean_bounds.lower, digits));
    json["upper"].push_back(page_number(point.mean_bounds.upper, digits));
    json["quantile"].push_back(page_number(point.quantile, digits));
    json["quantile_lower"].push_back(page_number(point.quantile_bounds.lower, digits));
    json["quantile_upper"].push_back(page_number(point.quantile_bounds.upper, digits));
  }
  return json;
}

Json tolerance_json(const Summary& summary, const OutputSummary& output) {
  Json json = Json::array();
  for (const ToleranceLimitEstimate& estimate : output.tolerance_limits) {
    const auto& [spec, limits, beyond] = estimate;
    json.push_back(
        {{"text", fmt::format("{:g} % at {:g} %, {}", 100 * spec.probability, 100 * spec.confidence,
                              side_names[static_cast<std::size_t>(spec.side)])}});
    add_bounds(json.back(), limits, digits_of(output.moments));
    if (std::string why = why_no_limit(summary, estimate); !why.empty())
      json.back()["note"] = std::move(why);
  }
  return json;
}

/// Indices of the requirements on the output.
Json limits_json(const PageSource& source, const std::string& name) {
  Json json = Json::array();
  for (std::size_t i = 0; i < source.summary.requirements.size(); ++i)
    if (source.summary.requirements[i].requirement.output == name) json.push_back(i);
  return json;
}

/// Adds the histogram, the curve and the convergence, from the rows.
void add_pictures(const PageSource& source, std::size_t index, const PageDetail& detail,
                  Json& json) {
  const Column& column = source.results.outputs[index];
  const auto& asked = source.stored.campaign.statistics.quantiles;
  const double p = asked.empty() ? 0.99 : std::ranges::max(asked);
  const SortedWithConvergence sorted_column =
      sort_with_convergence(column, p, source.confidence, source.replication,
                            detail.convergence_points, source.summary.outputs[index].missing_end);
  json["histogram"] = histogram_json(source, index, sorted_column.sorted, detail.bins);
  json["curve"] = curve_json(source, source.summary.outputs[index],
                             distribution_curve(sorted_column.sorted, sorted_column.replicated,
                                                source.replication.replicates, source.confidence,
                                                detail.knots));
  json["convergence"] = convergence_json(source.summary.outputs[index], sorted_column.convergence);
  column.values.release();
}

/// Adds the histogram and the curve, from streaming statistics. Without the order of the runs there is no convergence.
void add_streaming_pictures(const PageSource& source, std::size_t index, const PageDetail& detail,
                            Json& json) {
  const RankedPopulation values(source.streaming->outputs()[index].values);
  json["histogram"] = histogram_json(source, index, {}, detail.bins);
  json["curve"] = curve_json(source, source.summary.outputs[index],
                             distribution_curve(values, source.confidence, detail.knots));
  json["convergence"] = nullptr;
}

Json output_json(const PageSource& source, std::size_t index, const PageDetail& detail) {
  const OutputSummary& output = source.summary.outputs[index];
  const OutputName name = parse_output_name(output.name);
  Json json{
      {"name", output.name},
      {"unit", name.unit},
      {"family", name.quantity},
      {"hinge", name.hinge.empty() || name.hinge == "base" ? Json(nullptr) : Json(name.hinge)}};
  json.update(moments_json(output));
  json["quantiles"] = quantiles_json(source.summary, output);
  (source.has_rows() ? add_pictures : add_streaming_pictures)(source, index, detail, json);
  json["tolerance_limits"] = tolerance_json(source.summary, output);
  json["limits"] = limits_json(source, output.name);
  return json;
}

} // namespace

int digits_of(const Moments& m) {
  return digits_that_show(m.std, std::max(std::abs(m.min), std::abs(m.max)));
}

std::vector<std::size_t> shown_outputs(const PageSource& source, const PageDetail& detail) {
  std::vector<std::size_t> shown(source.results.outputs.size());
  std::iota(shown.begin(), shown.end(), std::size_t{0});
  if (shown.size() <= detail.outputs) return shown;
  std::ranges::stable_partition(shown, [&](std::size_t i) {
    return std::ranges::any_of(source.summary.requirements, [&](const Verdict& verdict) {
      return verdict.requirement.output == source.results.outputs[i].name;
    });
  });
  shown.resize(detail.outputs);
  std::ranges::sort(shown);
  return shown;
}

Json outputs_json(const PageSource& source, const PageDetail& detail, int threads) {
  const std::vector<std::size_t> shown = shown_outputs(source, detail);
  const std::size_t bytes = (source.replication.replicates > 0 ? 64 : 16) * source.results.size();
  std::vector<Json> blocks(shown.size());
  for_each_task(threads_within_memory(threads, bytes), shown.size(),
                [&](std::size_t i) { blocks[i] = output_json(source, shown[i], detail); });
  return blocks;
}

} // namespace wingspread
