#include "montecarlo/analyses/rare/rare_report.hpp"

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/model/campaign/describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wingspread {
namespace {

/// The unit of the event's output; empty for "not deployed".
std::string unit_of(const RareEvent& event) {
  return event.output.empty() ? "" : parse_output_name(event.output).unit;
}

/// "root.peak_moment > 400 N·m".
std::string with_unit(const RareEvent& event) {
  const std::string unit = unit_of(event);
  return describe(event) + (unit.empty() ? "" : ' ' + unit);
}

Json estimate_json(const SubsetEstimate& estimate, const RareEvent& event) {
  Json levels = Json::array();
  for (const SubsetLevel& level : estimate.levels)
    levels.push_back({{"threshold", json_number(level_of(event, level.threshold))},
                      {"share", level.share},
                      {"chain_correlation", level.correlation},
                      {"variation", json_number(level.variation)},
                      {"moves_taken", json_number(level.taken)}});
  return {{"probability", estimate.probability}, {"variation", json_number(estimate.variation)},
          {"reached", estimate.reached},         {"stuck", estimate.stuck},
          {"runs", estimate.evaluations},        {"levels", levels}};
}

Json likeliest_json(const LikeliestRun& run, const Campaign& campaign) {
  Json draws = Json::object(), z = Json::object(), units = Json::object();
  for (std::size_t i = 0; i < run.draws.size(); ++i) {
    draws[campaign.dispersions[i].name] = json_number(run.draws[i]);
    z[campaign.dispersions[i].name] = json_number(run.z[i]);
    units[campaign.dispersions[i].name] = unit_of_draw(campaign.dispersions[i]);
  }
  return {{"distance", run.distance}, {"status", to_string(run.status)},
          {"reason", run.reason},     {"draws", draws},
          {"units", units},           {"z", z}};
}

Json repeats_json(const StratumEstimate& part, const RareEvent& event) {
  Json repeats = Json::array();
  for (const SubsetEstimate& estimate : part.estimates)
    repeats.push_back(estimate_json(estimate, event));
  return repeats;
}

Json stratum_json(const StratumEstimate& part, const RareEvent& event) {
  const RareEstimate& estimate = part.estimate;
  Json rare = Json::object();
  for (const auto& [name, value] : part.stratum.rare) rare[name] = json_number(value);
  return {{"draws", describe(part.stratum)},
          {"rare_values", rare},
          {"probability", part.stratum.probability},
          {"samples", part.samples},
          {"event", estimate.probability},
          {"reached", estimate.reached},
          {"lower", estimate.interval.lower},
          {"upper", estimate.interval.upper},
          {"runs", estimate.evaluations},
          {"repeats", repeats_json(part, event)}};
}

bool is_stratified(const RareResult& result) {
  return result.strata.size() > 1 || result.left_out > 0;
}

/// Null without strata: `repeats` then has the whole simulation.
Json strata_json(const RareResult& result, const RareEvent& event) {
  if (!is_stratified(result)) return nullptr;
  Json strata = Json::array();
  for (const StratumEstimate& part : result.strata) strata.push_back(stratum_json(part, event));
  return strata;
}

const char* method_of(const RareResult& result) {
  if (is_stratified(result)) return "stratified_subset_simulation";
  return result.estimate.plain ? "plain_sampling" : "subset_simulation";
}

/// P of the stratum and the event; "≤ " before an upper bound, "≲ " before an estimated one.
std::string part_text(const StratumEstimate& part, double factor) {
  const RareEstimate& estimate = part.estimate;
  const bool hit = estimate.reached && estimate.probability > 0;
  return fmt::format("{}{:.3g}",
                     hit                ? ""
                     : estimate.reached ? "≤ "
                                        : "≲ ",
                     factor * (hit ? estimate.probability : estimate.interval.upper));
}

/// The strata, largest part of the sum first, at most 12.
std::string strata_text(const RareResult& result) {
  if (!is_stratified(result)) return "";
  constexpr std::size_t most_lines = 12;
  std::vector<const StratumEstimate*> order;
  for (const StratumEstimate& part : result.strata) order.push_back(&part);
  std::ranges::stable_sort(order, std::ranges::greater{}, [](const StratumEstimate* part) {
    return part->stratum.probability * part->estimate.interval.upper;
  });
  std::string text =
      "\nSTRATA: rare values of discrete dispersions are drawn by themselves; their probability is "
      "exact\n";
  text += fmt::format("  {:<40}{:>13}{:>13}{:>13}{:>9}\n", "draws", "P(draws)", "P(event)",
                      "product", "runs");
  const std::size_t shown = std::min(order.size(), most_lines);
  for (const StratumEstimate* part : std::span(order).first(shown))
    text += fmt::format("  {:<40}{:>13.3g}{:>13}{:>13}{:>9}\n", describe(part->stratum),
                        part->stratum.probability, part_text(*part, 1),
                        part_text(*part, part->stratum.probability), part->estimate.evaluations);
  if (shown < order.size()) {
    const StratumEstimate& next = *order[shown];
    text += fmt::format("  {} others, each at most {:.2g}\n", order.size() - shown,
                        next.stratum.probability * next.estimate.interval.upper);
  }
  if (result.left_out > 0)
    text += fmt::format("  {:<40}{:>13.3g}{:>13}{:>13}{:>9}\n", "not simulated", result.left_out,
                        "≤ 1", fmt::format("≤ {:.3g}", result.left_out), 0);
  return text;
}

std::string repeats_text(const RareResult& result, const RareOptions& options) {
  const StratumEstimate& first = result.strata.front();
  std::string text =
      fmt::format("\n{:<8}{:>14}{:>12}{:>10}   {}{}\n", "REPEAT", "probability", "variation",
                  "runs", "levels", is_stratified(result) ? ", of draws with no rare value" : "");
  for (std::size_t k = 0; k < first.estimates.size(); ++k) {
    const SubsetEstimate& estimate = first.estimates[k];
    text += fmt::format("  {:<6}{:>14}{:>12}{:>10}  ", k + 1,
                        fmt::format("{}{:.3g}", estimate.reached || estimate.stuck ? "" : "≲ ",
                                    estimate.probability),
                        estimate.probability > 0 ? percent(estimate.variation, 0) : "–",
                        estimate.evaluations);
    for (const SubsetLevel& level : estimate.levels)
      text += fmt::format(" {:.4g}", level_of(options.event, level.threshold));
    text += '\n';
  }
  return text;
}

/// The run's draws, largest deviation first, at most 8.
std::string likeliest_text(const LikeliestRun& run, const Campaign& campaign) {
  constexpr std::size_t most_lines = 8;
  std::vector<std::size_t> order(run.draws.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t i) { return std::abs(run.z[i]); });
  std::string text = fmt::format(
      "\nMOST LIKELY run of the event, at the distance {:.2f} in normal coordinates: {}{}{}\n",
      run.distance, to_string(run.status), run.reason.empty() ? "" : ", ", run.reason);
  text += fmt::format("  {:<40}{:>14}{:>24}\n", "dispersion", "draw", "normal coordinate");
  const std::size_t shown = std::min(order.size(), most_lines);
  for (const std::size_t i : std::span(order).first(shown))
    text += fmt::format("  {:<40}{:>14.6g}{:>+24.2f}\n", campaign.dispersions[i].name, run.draws[i],
                        run.z[i]);
  if (shown < order.size())
    text += fmt::format("  {} others, at most {:.2f}\n", order.size() - shown,
                        std::abs(run.z[order[shown]]));
  text += "  normal coordinate: 0 at the law's median; of a normal law (draw - mean)/std";
  if (!campaign.wanted_correlations.empty())
    text += "; of a\n  correlated draw the part that draws before it, by name, do not explain";
  return text + '\n';
}

std::string plain_text(const RareEstimate& estimate) {
  if (!estimate.reached || estimate.plain || !std::isfinite(estimate.plain_runs)) return "";
  if (estimate.plain_is_enough())
    return fmt::format(
        " Plain sampling would have been enough: {:.0f} runs give the same accuracy.",
        std::ceil(estimate.plain_runs));
  return fmt::format(" Plain sampling would take {:.2g} runs for the same accuracy.",
                     estimate.plain_runs);
}

/// The upper bound that the first levels give as a plain sample: it also holds if the simulation misses a cause.
std::string counted_text(const RareResult& result, double confidence) {
  const RareEstimate& all = result.estimate;
  if (is_stratified(result) || !all.reached || all.plain || all.draws == 0) return "";
  return fmt::format("The first levels, a plain sample of {} runs, show P ≤ {:.2g}.\n", all.draws,
                     clopper_pearson(all.hits, all.draws, confidence).upper);
}

/// Whether the bounds of a stratum's estimate keep their confidence.
bool is_bounded(const StratumEstimate& part) { return part.estimate.reached; }

/// The estimate and its bounds.
std::string result_text(const RareResult& result, double confidence, const std::string& event) {
  const RareEstimate& all = result.estimate;
  if (is_stratified(result) && all.interval.lower > 0)
    return fmt::format("P({}) = {:.4g}, {:g} % bounds {:.4g} … {:.4g}{}\n", event, all.probability,
                       100 * confidence, all.interval.lower, all.interval.upper,
                       all.reached ? "" : "; the upper one is an estimate, not guaranteed");
  if (is_stratified(result) && !all.reached)
    return fmt::format(
        "P({}): not reached. {:g} % upper bound {:.3g}{}\n", event, 100 * confidence,
        all.interval.upper,
        std::ranges::all_of(result.strata, is_bounded) ? "" : ", estimated, not guaranteed");
  const std::vector<SubsetEstimate>& repeats = result.strata.front().estimates;
  if (!all.reached)
    return fmt::format(
        "P({}): not reached in {} of {} repeats. Probability of the last levels {:.3g}, {:g} % "
        "bound "
        "{:.3g}:\nestimated upper bound, not guaranteed\n",
        event, std::ranges::count(repeats, false, &SubsetEstimate::reached), repeats.size(),
        all.probability, 100 * confidence, all.interval.upper);
  if (all.plain && all.hits == 0)
    return fmt::format("P({}): not reached, {:g} % upper bound {:.3g} (Clopper–Pearson)\nThe first "
                       "levels are a plain sample: 0 of {} runs have the event.\n",
                       event, 100 * confidence, all.interval.upper, all.draws);
  if (all.plain)
    return fmt::format("P({}) = {:.6g}, {:g} % bounds {:.6g} … {:.6g} (Clopper–Pearson)\nThe "
                       "first levels are a plain sample: {} of {} runs have the event. For such an "
                       "event use `wingspread run`.\n",
                       event, all.probability, 100 * confidence, all.interval.lower,
                       all.interval.upper, all.hits, all.draws);
  return fmt::format("P({}) = {:.3g}, {:g} % bounds {:.3g} … {:.3g}, variation {}\n", event,
                     all.probability, 100 * confidence, all.interval.lower, all.interval.upper,
                     percent(all.variation, 0));
}

/// Whether a stratum's upper bound is at least 1 % of the sum's.
bool matters(const StratumEstimate& part, const RareEstimate& all) {
  return part.stratum.probability * part.estimate.interval.upper >= 0.01 * all.interval.upper;
}

/// "t_end cut the peak in 500 of 500 runs: …"; empty if it cut none.
std::string cut_text(const RareResult& result) {
  if (result.cut == 0) return "";
  return fmt::format("t_end cut the peak in {} of {} runs: they count as the event, so the "
                     "probability may be too large. {}",
                     result.cut, result.estimate.evaluations, advice_on_t_end(result.never_final));
}

std::string unseen_text(const std::string& name, double draws) {
  return fmt::format(
      "\"{}\" has values that the simulation may miss: the rarest one is drawn {:.2g} "
      "times on average in all first levels. The upper bound is that of plain "
      "sampling: more --samples or --repeats",
      name, draws);
}

} // namespace

Json event_json(const RareEvent& event) {
  if (event.output.empty()) return nullptr;
  return {{"output", event.output},
          {"above", event.above},
          {"abs", event.absolute},
          {"limit", json_number(event.limit)},
          {"unit", unit_of(event)}};
}

std::vector<std::string> doubts_of(const RareResult& result) {
  std::vector<std::string> doubts;
  if (const long invalid = result.statuses[static_cast<std::size_t>(Status::invalid)]; invalid > 0)
    doubts.push_back(fmt::format("{} of {} runs have an unphysical draw and count as the event",
                                 invalid, result.estimate.evaluations));
  if (result.cut > 0) doubts.push_back(cut_text(result));
  if (result.absent > 0)
    doubts.push_back(
        fmt::format("{} of {} runs have no value (a hinge that never latched, for example) and "
                    "count as the event",
                    result.absent, result.estimate.evaluations));
  if (result.undeployed > 0)
    doubts.push_back(fmt::format(
        "{} of {} runs did not deploy and count by their value, where a requirement counts "
        "them as broken; without --output, `rare` states the probability that a wing does "
        "not deploy",
        result.undeployed, result.estimate.evaluations));
  if (result.open_latches > 0)
    doubts.push_back(
        warn_of_open_latches(result.open_latches, result.estimate.evaluations, result.never_final));
  const auto any = [&](auto is) {
    return std::ranges::any_of(result.strata, [&](const StratumEstimate& part) {
      return matters(part, result.estimate) && is(part);
    });
  };
  if (any([](const StratumEstimate& part) {
        return std::ranges::any_of(part.estimates, &SubsetEstimate::stuck);
      }))
    doubts.emplace_back("at some levels all runs are equally far from the event, so the simulation "
                        "could not approach it");
  if (any([](const StratumEstimate& part) { return repetitions_disagree(part.estimates); }))
    doubts.emplace_back("the repeats scatter more than their Markov chains explain: some may have "
                        "missed a cause of the event. Use more --samples and --repeats");
  for (const auto& [name, draws] : result.unseen) doubts.push_back(unseen_text(name, draws));
  if (result.left_out > 0.1 * result.estimate.probability)
    doubts.push_back(fmt::format("draws with the probability {:.3g} are not simulated: they are in "
                                 "the upper bound, not in the estimate",
                                 result.left_out));
  return doubts;
}

Json rare_json(const RareResult& result, const RareOptions& options, const Campaign& campaign,
               const Json& about) {
  const RareEstimate& all = result.estimate;
  Json by_status = Json::object();
  for (const Status status : statuses)
    by_status[to_string(status)] = result.statuses[static_cast<std::size_t>(status)];
  Json json{
      {stamp_key, about},
      {"scene", campaign.scene.name},
      {"event", describe(options.event)},
      {"beyond", event_json(options.event)},
      {"case", campaign.of_case.empty() ? Json(nullptr) : Json(campaign.of_case)},
      {"probability", all.probability},
      {"reached", all.reached && all.probability > 0},
      {"method", method_of(result)},
      {"first_levels", {{"runs", all.draws}, {"with_event", all.hits}}},
      {"confidence", options.confidence},
      {"lower", all.interval.lower},
      {"upper", all.interval.upper},
      {"variation",
       {{"value", json_number(all.variation)},
        {"from_chains", json_number(all.from_chains)},
        {"from_repeats", json_number(all.from_spread)}}},
      {"runs", all.evaluations},
      {"bias", json_number(all.bias)},
      {"plain_runs", json_number(all.plain_runs)},
      {"plain_sampling_is_enough", all.plain_is_enough()},
      {"definitions",
       {{"probability",
         "mean over independent subset simulations; one that did not reach the event counts with "
         "the estimated probability of its last level, which is larger than the event's; one that "
         "stopped because all its runs were equally far from the event counts with 0; by "
         "plain_sampling: with_event over the runs of the first_levels"},
        {"bias", "relative error by which the probability is too large on average: 0.5 times "
                 "the squared variation of a repeat, as measured on events of known probability; "
                 "the lower bound is less by it; probability and upper bound are not corrected"},
        {"variation", "coefficient of variation of the mean: by the correlation along chains, "
                      "by the repeats' spread, and the larger of the two"},
        {"bounds", "probability exp(+- q variation), q normal or Student's, the wider; the lower "
                   "one less by the bias; no "
                   "lower one where a repeat did not reach the event; by plain_sampling: "
                   "Clopper-Pearson, two-sided"},
        {"without_value", "runs without the output: they count as the event"},
        {"peaks_cut", "runs whose peak t_end cut: they count as the event, as they break a "
                      "requirement in wingspread run"},
        {"plain_runs", "runs of plain sampling for the same variation"},
        {"distance", "of the likeliest run: length of the vector of its normal coordinates, "
                     "of rows drawn together one coordinate"},
        {"z", "normal coordinate of a draw: standard normal and independent of the others; 0 "
              "at the law's median, of a normal law (draw - mean)/std; of a correlated draw "
              "the part that draws before it, by name, do not explain"},
        {"strata", "draws with rare values of discrete dispersions are simulated by themselves: "
                   "probability: that of these draws, exact; event: that of the event among "
                   "them; the result is the sum of the products; null without rare values"},
        {"repeats", "those of the draws with no rare value"},
        {"not_simulated",
         "probability of the draws in no stratum; it is added to the upper bound"}}},
      {"samples", options.samples},
      {"strata", strata_json(result, options.event)},
      {"not_simulated", result.left_out},
      {"warnings", doubts_of(result)},
      {"repeats", repeats_json(result.strata.front(), options.event)},
      {"statuses", by_status},
      {"peaks_cut", result.cut},
      {"without_value", result.absent},
      {"likeliest",
       result.likeliest ? likeliest_json(*result.likeliest, campaign) : Json(nullptr)}};
  if (campaign.report != ReportHeader{}) json["report"] = write_report_header(campaign.report);
  return json;
}

std::string rare_text(const RareResult& result, const RareOptions& options,
                      const Campaign& campaign) {
  const RareEstimate& all = result.estimate;
  std::string text =
      fmt::format("{}{} · subset simulation, {} repeats of {} a level · seed {}\n\n",
                  campaign.scene.name, campaign.of_case.empty() ? "" : " · " + campaign.of_case,
                  options.repeats, options.samples, campaign.sampling.seed);
  text += result_text(result, options.confidence, with_unit(options.event));
  if (result.cut > 0) text += paragraph(cut_text(result), 0);
  if (all.reached && all.bias > 0)
    text += fmt::format("Bias: such estimates are too large by about {} on average\n",
                        percent(all.bias, 1));
  text += fmt::format("{} runs made.{}\n", all.evaluations, plain_text(all));
  text += counted_text(result, options.confidence);
  text += strata_text(result);
  text += repeats_text(result, options);
  if (result.likeliest) text += likeliest_text(*result.likeliest, campaign);
  return text;
}

} // namespace wingspread
