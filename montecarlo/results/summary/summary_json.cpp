#include "montecarlo/results/summary/summary_json.hpp"

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/summary/verdict_json.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wingspread {
namespace {

/// The definitions of bounds, for independent draws and for replicates.
std::string source_of(const Summary& summary, const char* independent, const char* replicated) {
  if (summary.replicates == 0)
    return independent + over_interim_analyses(summary.interim, summary.confidence);
  if (summary.replicates == 1) return std::string(one_replicate);
  return fmt::format("{} {} independent replicates", replicated, summary.replicates);
}

Json definitions(const Summary& summary) {
  const bool independent = summary.replicates == 0;
  Json json{
      {"std", "divisor n - 1"},
      {"mean_error",
       independent ? "std / sqrt(count)" : source_of(summary, "", "spread of the means of")},
      {"skewness", "G1 = m3/m2^1.5 sqrt(n(n - 1))/(n - 2), adjusted Fisher-Pearson"},
      {"kurtosis", "G2 = (n - 1)/((n - 2)(n - 3)) ((n + 1)(m4/m2^2 - 3) + 6), excess"},
      {"quantile", "order statistic of rank ceil(n p)"},
      {"quantile_bounds", source_of(summary, "order statistics, binomial, two-sided",
                                    "Woodruff: inverse of the pooled distribution, Student's t "
                                    "over")},
      {"rate_bounds", source_of(summary, "Clopper-Pearson, two-sided",
                                "Korn-Graubard: Clopper-Pearson for the effective number of "
                                "draws, Student's t over")},
      {"spearman", "Pearson's of the mid-ranks"},
      {"outputs", "over the runs in which they happened"},
      {"requirements", independent
                           ? "over all runs, one-sided: P(Bin(n, 1 - p) <= failures) <= 1 - c; "
                             "a run that did not deploy, or without the output, is a failure"
                           : "none: the draws depend on each other"}};
  if (std::ranges::any_of(summary.outputs, [](const auto& each) { return each.missing > 0; }))
    json["quantile_missing"] =
        "quantiles are over all n runs: those without a value rank as missing_ranks says; null "
        "where one of them has the rank; among_runs_with_value: over the others alone";
  if (std::ranges::any_of(summary.outputs,
                          [](const auto& each) { return !each.tolerance_limits.empty(); }))
    json["tolerance"] = "over all n runs, as requirements: a run that did not deploy, has no value "
                        "or has a peak that t_end cut is beyond_every_number: above for an upper "
                        "or two-sided limit, below for a lower one. Quantiles, unlike limits, use "
                        "every value that a run has";
  if (summary.nominal)
    json["nominal"] = "of the run with every dispersion at the median of its law, tables included";
  if (summary.without_rows) {
    json["quantile"] = "order statistic of rank ceil(n p): exact among the extremes that are kept, "
                       "else interpolated: it lies in `within`, and rank_error bounds its rank";
    json["quantile_bounds"] =
        "order statistics, binomial, two-sided, at the outer edges of the bins "
        "that they lie in";
    json["spearman"] = "none: ranks take the rows";
    json["histograms"] = "edges where the number of values below is known exactly";
  }
  if (summary.requirements.size() > 1)
    json["joint_confidence"] =
        "lower bound of the confidence that all passed requirements hold: 1 - the sum of (1 - c) "
        "over all requirements";
  if (summary.peaks)
    json["peaks_final"] =
        "runs whose peaks are proven (true) or were cut by t_end (false): a cut peak breaks every "
        "requirement on it, and disproves none unless it is beyond the limit already; moments_cut, "
        "forces_cut: where only the one or the other was cut in some runs";
  if (summary.accuracy)
    json["accuracy"] =
        "runs drawn at random and repeated by the reference: largest and RMS difference; "
        "order_in_doubt: runs with another status or latch order there; moved: runs in which an "
        "output differs by more than 1 %; share_at_most: Clopper-Pearson's one-sided bound of the "
        "share of all runs, which includes runs in doubt or unreached; standard_error: of the mean";
  if (!judge_groups(summary.requirements).empty())
    json["groups"] = "m requirements of a group are judged at 1 - (1 - c)/m each, so that all of "
                     "them together hold at c";
  if (!summary.interim.before.empty())
    json["extended"] =
        "runs were added to draws that had been analysed. The risk of a wrong pass at any of the "
        "analyses is at most risk_of_wrong_pass, 1 - c, however the numbers of runs were chosen: "
        "each analysis after the first spends at most half of what is left after the failures "
        "seen; risk_if_alone: the risk if each were judged alone at c; bounds "
        "of analysis k at 1 - (1 - c)/(k(k - 1)), for numbers of runs not chosen by the results";
  return json;
}

Json statuses_json(const Summary& summary) {
  Json json = Json::object();
  for (const StatusShare& share : summary.statuses) {
    Json entry{{"count", share.count},
               {"rate", json_number(share.rate)},
               {"lower", json_number(share.bounds.lower)},
               {"upper", json_number(share.bounds.upper)}};
    if (std::string why = why_no_bound(summary, share); !why.empty())
      entry["note"] = std::move(why);
    json[to_string(share.status)] = std::move(entry);
  }
  return json;
}

Json nominal_json(const NominalRun& run) {
  Json json{{"status", to_string(run.status)}, {"latch_order", run.latch_order}};
  if (!run.reason.empty()) json["reason"] = run.reason;
  if (run.peaks != PeaksFinal::unknown) json["peaks_final"] = to_string(run.peaks);
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

void add_stopped(Json& json, const Summary& summary) {
  for (const StoppedHinge& each : summary.stalled_at)
    json["stalled_at"][each.hinge] = {{"runs", each.runs},
                                      {"median", json_number(each.median)},
                                      {"least", json_number(each.least)},
                                      {"largest", json_number(each.largest)}};
}

void add_latch_orders(Json& json, const Summary& summary) {
  json["latch_order"] = Json::object();
  long omitted = summary.runs - summary.without_latch;
  for (const auto& [order, count] : summary.latch_orders) {
    json["latch_order"][order] = count;
    omitted -= count;
  }
  json["latch_order_omitted"] = omitted;
  json["latch_order_missing"] = summary.without_latch;
}

void add_quantile(Json& json, const QuantileValue& quantile) {
  const auto& [value, bounds, error] = quantile;
  json.update({{"value", json_number(value)},
               {"lower", json_number(bounds.lower)},
               {"upper", json_number(bounds.upper)}});
  if (!error) return;
  json["rank_error"] = error->rank;
  json["within"] = {error->lower, error->upper};
}

Json quantiles_json(const Summary& summary, const OutputSummary& output) {
  Json json = Json::array();
  for (const QuantileEstimate& quantile : output.quantiles) {
    Json entry{{"p", quantile.p}};
    add_quantile(entry, quantile.all);
    if (std::string why = why_missing(summary, output, quantile); !why.empty())
      entry["note"] = std::move(why);
    if (quantile.among) add_quantile(entry["among_runs_with_value"], *quantile.among);
    json.push_back(std::move(entry));
  }
  return json;
}

Json tolerance_json(const Summary& summary, const OutputSummary& output) {
  Json json = Json::array();
  for (const ToleranceLimitEstimate& estimate : output.tolerance_limits) {
    const auto& [spec, limits, beyond] = estimate;
    Json entry{{"probability", spec.probability},
               {"confidence", spec.confidence},
               {"side", side_names[static_cast<std::size_t>(spec.side)]}};
    if (spec.side != Side::upper) entry["lower"] = json_number(limits.lower);
    if (spec.side != Side::lower) entry["upper"] = json_number(limits.upper);
    if (beyond > 0) entry["beyond_every_number"] = beyond;
    if (std::string why = why_no_limit(summary, estimate); !why.empty())
      entry["note"] = std::move(why);
    json.push_back(std::move(entry));
  }
  return json;
}

Json output_json(const Summary& summary, const OutputSummary& output) {
  const Moments& m = output.moments;
  Json json{{"unit", parse_output_name(output.name).unit}};
  if (output.nominal) json["nominal"] = json_number(output.nominal);
  json.update({{"count", m.count},
               {"missing", output.missing},
               {"mean", json_number(m.mean)},
               {"mean_error", json_number(output.mean_error)},
               {"std", json_number(m.std)},
               {"min", json_number(m.min)},
               {"max", json_number(m.max)},
               {"skewness", json_number(m.skewness)},
               {"kurtosis", json_number(m.kurtosis)},
               {"quantiles", quantiles_json(summary, output)}});
  if (output.missing > 0) json["missing_ranks"] = words_of(output.missing_end);
  if (!output.tolerance_limits.empty()) json["tolerance"] = tolerance_json(summary, output);
  return json;
}

/// The runs that break a requirement, and the command that replays one.
void add_broken(Json& json, const Verdict& verdict) {
  const auto& broken = verdict.broken;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(broken.size(), most_broken));
  json["broken"] = std::vector<long>(broken.begin(), broken.begin() + shown);
  json["broken_omitted"] = verdict.failures() - shown;
  if (!broken.empty()) json["replay"] = replay_command("DIR", broken.front());
}

Json verdict_json(const Summary& summary, const Verdict& verdict) {
  Json json = write_requirements({&verdict.requirement, 1}).front();
  json["verdict"] = to_string(verdict.decision);
  json["margin"] = json_number(verdict.margin);
  json["evidence"] = evidence(verdict);
  json["runs"] = verdict.runs;
  json.update(evidence_json(verdict));
  if (!verdict.allowed && verdict.least_runs) json["least_runs"] = *verdict.least_runs;
  if (!verdict.requirement.group.empty()) json["confidence_alone"] = verdict.confidence_alone;
  if (summary.interim.count() > 1) json["confidence_at_this_analysis"] = verdict.confidence;
  if (const auto& joint = verdict.joint) {
    json["risk_of_wrong_pass"] = joint->risk;
    json["risk_if_alone"] = joint->risk_alone;
    json["failures"]["allowed_if_alone"] =
        joint->allowed_alone ? Json(*joint->allowed_alone) : Json(nullptr);
  }
  add_broken(json, verdict);
  return json;
}

Json requirements_json(const Summary& summary) {
  Json json = Json::array();
  for (const Verdict& verdict : summary.requirements)
    json.push_back(verdict_json(summary, verdict));
  return json;
}

Json groups_json(std::span<const GroupVerdict> groups) {
  Json json = Json::array();
  for (const GroupVerdict& group : groups)
    json.push_back({{"group", group.name},
                    {"confidence", group.confidence},
                    {"requirements", group.members},
                    {"passed", group.passed},
                    {"verdict", to_string(group.decision)}});
  return json;
}

/// The goals of the stopping rule, and how far they are reached.
Json until_json(const Summary& summary) {
  Json goals = Json::array();
  for (const GoalState& found : summary.until) {
    Json json = write_stopping_rule({found.goal}).front();
    if (std::holds_alternative<WidthGoal>(found.goal)) json["found"] = json_number(found.width);
    if (found.relative) json["found_relative"] = *found.relative;
    json["met"] = found.met;
    goals.push_back(std::move(json));
  }
  return {
      {"stopped", summary.stopped}, {"checkpoints", summary.interim.count()}, {"widths", goals}};
}

/// An extended campaign: the numbers of runs at earlier analyses.
Json extended_json(const Summary& summary) {
  return {{"analysed_at", summary.interim.before}, {"analyses", summary.interim.count()}};
}

Json correlations_json(const Summary& summary) {
  Json json = Json::object();
  for (const auto& [draw, output, value] : summary.correlations)
    json[draw][output] = {{"count", value.count},
                          {"pearson", json_number(value.pearson)},
                          {"spearman", json_number(value.spearman)}};
  return json;
}

std::vector<double> densities(const Histogram& histogram) {
  std::vector<double> result;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) result.push_back(histogram.density(i));
  return result;
}

/// The number of repeated runs that have a property, and an upper bound of its share among all runs.
Json share_json(const Summary& summary, std::size_t found) {
  return {
      {"runs", found},
      {"share_at_most", share_at_most(*summary.accuracy, found, summary.confidence_of_bound())}};
}

} // namespace

std::string over_interim_analyses(const InterimAnalyses& interim, double confidence) {
  if (interim.count() == 1) return "";
  const double of_bound = interim.confidence_of_bound(confidence);
  if (!interim.before.empty())
    return fmt::format(", at a confidence of {:.10g}: of analysis {} of the same draws, the bounds "
                       "of all extensions hold together at {:.10g}",
                       of_bound, interim.count(), confidence);
  return fmt::format(", at a confidence of {:.10g} each, to hold at whichever of {} analyses the "
                     "campaign stops",
                     of_bound, interim.count());
}

Json accuracy_json(const Summary& summary) {
  if (!summary.accuracy) return nullptr;
  const Accuracy& accuracy = *summary.accuracy;
  Json outputs = Json::array();
  for (std::size_t i = 0; i < accuracy.outputs.size(); ++i)
    outputs.push_back({{"output", accuracy.outputs[i].output},
                       {"largest", json_number(accuracy.outputs[i].largest)},
                       {"rms", json_number(accuracy.outputs[i].rms)},
                       {"standard_error", json_number(summary.outputs[i].mean_error)}});
  Json json{{"runs", accuracy.runs},
            {"method", accuracy.method},
            {"rtol", accuracy.rtol},
            {"reference_method", accuracy.reference_method},
            {"reference_rtol", accuracy.reference_rtol},
            {"order_in_doubt", std::ssize(accuracy.in_doubt)},
            {"beyond_largest", share_json(summary, 0)},
            {"moved", share_json(summary, accuracy.moved.size())},
            {"outputs", std::move(outputs)}};
  if (!accuracy.moved.empty())
    json["moved"].update({{"which", accuracy.moved}, {"outputs", accuracy.moved_outputs}});
  if (!accuracy.in_doubt.empty()) json["in_doubt"] = accuracy.in_doubt;
  if (accuracy.unreached > 0) json["unreached"] = accuracy.unreached;
  return json;
}

Json summary_json(const Summary& summary, const Json& about) {
  Json json{{stamp_key, about}, {"runs", summary.runs}, {"confidence", summary.confidence}};
  if (summary.nominal) json["nominal"] = nominal_json(*summary.nominal);
  json["status"] = statuses_json(summary);
  add_reasons(json, summary);
  add_stopped(json, summary);
  add_latch_orders(json, summary);
  if (summary.peaks) json["peaks_final"] = peaks_json(*summary.peaks);
  json["outputs"] = Json::object();
  for (const OutputSummary& output : summary.outputs)
    json["outputs"][output.name] = output_json(summary, output);
  json["correlations"] = correlations_json(summary);
  if (summary.accuracy) json["accuracy"] = accuracy_json(summary);
  json["requirements"] = requirements_json(summary);
  if (summary.requirements.size() > 1)
    json["joint_confidence"] = joint_confidence(summary.requirements);
  if (const auto groups = judge_groups(summary.requirements); !groups.empty())
    json["groups"] = groups_json(groups);
  if (const auto lines = warnings(summary); !lines.empty()) json["warnings"] = lines;
  if (!summary.until.empty()) json["until"] = until_json(summary);
  if (!summary.interim.before.empty()) json["extended"] = extended_json(summary);
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
      append_csv_cells(csv, histogram.edges[i], histogram.edges[i + 1], histogram.counts[i],
                       histogram.density(i));
      csv += '\n';
    }
  }
  return csv;
}

} // namespace wingspread
