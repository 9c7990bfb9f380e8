#include "montecarlo/summary_json.hpp"

#include "montecarlo/output_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wingspread {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json definitions(const Summary& summary) {
  const bool binomial = summary.replicates == 0;
  const std::string replicates =
      fmt::format("Student's t over {} independent replicates", summary.replicates);
  return {{"std", "divisor n - 1"},
          {"skewness", "G1 = m3/m2^1.5 sqrt(n(n - 1))/(n - 2), adjusted Fisher-Pearson"},
          {"kurtosis", "G2 = (n - 1)/((n - 2)(n - 3)) ((n + 1)(m4/m2^2 - 3) + 6), excess"},
          {"quantile", "order statistic of rank ceil(n p)"},
          {"quantile_bounds", binomial ? "order statistics, binomial, two-sided"
                                       : "inverse of the pooled distribution, " + replicates},
          {"rate_bounds", binomial ? "Clopper-Pearson, two-sided" : replicates},
          {"spearman", "Pearson's of the mid-ranks"},
          {"outputs", "over the runs in which they happened"}};
}

Json statuses_json(const Summary& summary) {
  Json json = Json::object();
  for (const StatusShare& share : summary.statuses)
    json[to_string(share.status)] = {{"count", share.count},
                                     {"rate", number(share.rate)},
                                     {"lower", number(share.bounds.lower)},
                                     {"upper", number(share.bounds.upper)}};
  return json;
}

void add_reasons(Json& json, const Summary& summary) {
  json["reasons"] = Json::array();
  long omitted = 0;
  for (std::size_t i = 0; i < summary.reasons.size(); ++i) {
    const auto& [status, reason, count] = summary.reasons[i];
    if (i >= most_reasons)
      omitted += count;
    else
      json["reasons"].push_back(
          {{"status", to_string(status)}, {"reason", reason}, {"count", count}});
  }
  json["reasons_omitted"] = omitted;
}

void add_latch_orders(Json& json, const Summary& summary) {
  json["latch_order"] = Json::object();
  long omitted = 0;
  for (std::size_t i = 0; i < summary.latch_orders.size(); ++i) {
    const auto& [order, count] = summary.latch_orders[i];
    if (i >= most_latch_orders)
      omitted += count;
    else
      json["latch_order"][order] = count;
  }
  json["latch_order_omitted"] = omitted;
  json["latch_order_missing"] = summary.without_latch;
}

/// Why a bound of a quantile is null.
std::string missing_bound(const Summary& summary, const OutputSummary& output) {
  if (summary.replicates == 1)
    return "no bounds: the draws of one replicate depend on each other; take two replicates or "
           "more";
  return fmt::format("{} {} are too few for every bound at a confidence of {}",
                     output.moments.count, output.moments.count == 1 ? "value" : "values",
                     summary.confidence);
}

Json quantiles_json(const Summary& summary, const OutputSummary& output) {
  Json json = Json::array();
  for (const auto& [p, value, bounds] : output.quantiles) {
    Json entry{{"p", p},
               {"value", number(value)},
               {"lower", number(bounds.lower)},
               {"upper", number(bounds.upper)}};
    if (!bounds.lower || !bounds.upper) entry["note"] = missing_bound(summary, output);
    json.push_back(std::move(entry));
  }
  return json;
}

Json output_json(const Summary& summary, const OutputSummary& output) {
  const Moments& m = output.moments;
  return {{"unit", parse_output_name(output.name).unit},
          {"count", m.count},
          {"missing", output.missing},
          {"mean", number(m.mean)},
          {"std", number(m.std)},
          {"min", number(m.min)},
          {"max", number(m.max)},
          {"skewness", number(m.skewness)},
          {"kurtosis", number(m.kurtosis)},
          {"quantiles", quantiles_json(summary, output)}};
}

Json correlations_json(const Summary& summary) {
  Json json = Json::object();
  for (const auto& [draw, output, value] : summary.correlations)
    json[draw][output] = {{"count", value.count},
                          {"pearson", number(value.pearson)},
                          {"spearman", number(value.spearman)}};
  return json;
}

std::vector<double> densities(const Histogram& histogram) {
  std::vector<double> result;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) result.push_back(histogram.density(i));
  return result;
}

} // namespace

Json summary_json(const Summary& summary, const Json& about) {
  Json json{{"wingspread", about}, {"runs", summary.runs}, {"confidence", summary.confidence}};
  json["status"] = statuses_json(summary);
  add_reasons(json, summary);
  add_latch_orders(json, summary);
  json["outputs"] = Json::object();
  for (const OutputSummary& output : summary.outputs)
    json["outputs"][output.name] = output_json(summary, output);
  json["correlations"] = correlations_json(summary);
  json["definitions"] = definitions(summary);
  return json;
}

Json histograms_json(const Summary& summary) {
  Json json = Json::object();
  for (const OutputSummary& output : summary.outputs)
    json[output.name] = {{"unit", parse_output_name(output.name).unit},
                         {"count", output.moments.count},
                         {"missing", output.missing},
                         {"edges", output.histogram.edges},
                         {"counts", output.histogram.counts},
                         {"density", densities(output.histogram)}};
  return json;
}

std::string histograms_csv(const Summary& summary) {
  std::string csv = "output,lower,upper,count,density\n";
  for (const OutputSummary& output : summary.outputs) {
    const Histogram& histogram = output.histogram;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
      append_csv_cell(csv, output.name);
      for (const double edge : {histogram.edges[i], histogram.edges[i + 1]}) {
        csv += ',';
        append_csv_cell(csv, edge);
      }
      csv += fmt::format(",{},", histogram.counts[i]);
      append_csv_cell(csv, histogram.density(i));
      csv += '\n';
    }
  }
  return csv;
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

} // namespace wingspread
