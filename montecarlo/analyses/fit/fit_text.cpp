#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/engine/runs/trajectory_columns.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

constexpr double other_mode_distance = 3; // standard deviations
constexpr std::size_t name_width = 30;

/// "chi² 812 for 401 numbers (196 independent ones), p 0.0004".
std::string misfit_text(const FittedChannel& fitted) {
  const Channel& channel = fitted.channel;
  if (!channel.column)
    return fmt::format("{:.1f} σ from the fitted {:.6g}", std::abs(fitted.sigmas), fitted.fitted);
  return fmt::format("χ² {:.4g} for {} numbers ({:.0f} independent ones), p {:.2g}",
                     fitted.chi_squared, channel.count, channel.effective, fitted.p_value);
}

/// "85.6 deg"; a rate in rad/s, a moment in N·m.
std::string with_unit(double value, std::string_view unit) {
  return unit == "rad" ? degrees_text(value) + " deg" : fmt::format("{:.5g} {}", value, unit);
}

/// The numbers far from the rest, at most 3.
std::string outliers_text(const FittedChannel& fitted, std::string_view unit) {
  constexpr std::size_t most = 3;
  const std::size_t count = fitted.outliers.size();
  std::string text = fmt::format("{} of {} numbers {} far from the rest:", count,
                                 fitted.channel.count, count == 1 ? "is" : "are");
  for (std::size_t i = 0; i < std::min(count, most); ++i)
    text += fmt::format("{} {} at {:.6g} s, {:.0f} σ from the fit", i == 0 ? "" : ";",
                        with_unit(fitted.outliers[i].measured, unit), fitted.outliers[i].time,
                        fitted.outliers[i].sigmas);
  if (count > most) text += fmt::format("; and {} others", count - most);
  return text + (count == 1 ? ". Is it a bad sample? It pulls the fit: leave it out"
                            : ". Are they bad samples? They pull the fit: leave them out");
}

/// "spring 0.035 in place of 0.0101", or as wide as the prior.
std::string widened_text(const FitResult& result) {
  constexpr double least = 1.05;
  std::string text;
  for (const FittedParameter& each : result.parameters)
    if (each.widening > least || each.held_decides)
      text += fmt::format("{}{} {:.3g} in place of {:.3g}{}", text.empty() ? "" : ", ", each.name,
                          each.widening * each.std, each.std,
                          each.held_decides ? " (as wide as the prior: the held values decide it)"
                                            : "");
  return text;
}

/// "spring = 1 (prior 1 +- 0.05; 0.8 in "cold")".
std::string held_text(const HeldDispersion& held, std::string_view before) {
  std::string elsewhere;
  for (const auto& [test, median] : held.in_tests)
    elsewhere += fmt::format("; {:.5g} in \"{}\", by the law of its case", median, test);
  return fmt::format("{}{} = {:.5g} (prior {:.4g} +- {:.3g}{})", before, held.name, held.median,
                     held.prior_mean, held.prior_std, elsewhere);
}

void add_held(const FitResult& result, std::vector<std::string>& list) {
  constexpr std::size_t most = 6;
  const std::size_t count = result.held.size();
  if (count == 0) return;
  std::string text;
  for (std::size_t i = 0; i < std::min(count, most); ++i)
    text += held_text(result.held[i], text.empty() ? "" : ", ");
  if (count > most) text += fmt::format(" and {} others", count - most);
  const std::string widened = widened_text(result);
  list.push_back(fmt::format("not fitted, held at {} in all tests: {}. {}",
                             count == 1 ? "its median" : "their medians", text,
                             widened.empty()
                                 ? "To first order the spread of what is held adds nothing"
                                 : "To first order, with the spread of what is held, the "
                                   "posterior sd is: " +
                                       widened));
}

/// Tests with the same measured numbers: each counts as a test of its own.
void add_repeated(const FitSpec& spec, std::vector<std::string>& list) {
  const auto measured = [](const FitTest& test) {
    std::vector<double> numbers = test.times;
    for (const auto& column : test.columns)
      numbers.insert(numbers.end(), column.measured.begin(), column.measured.end());
    return numbers;
  };
  for (std::size_t k = 1; k < spec.tests.size(); ++k)
    for (std::size_t i = 0; i < k; ++i)
      if (!spec.tests[k].times.empty() && measured(spec.tests[i]) == measured(spec.tests[k]))
        list.push_back(fmt::format("\"{}\" has the numbers of \"{}\": the same trace counts twice",
                                   spec.tests[k].name, spec.tests[i].name));
}

/// Residuals that count as fewer. If they were too large for as many independent ones, something bends them.
std::string dependence_text(const FittedChannel& fitted, const FitSpec& spec) {
  const Channel& channel = fitted.channel;
  const auto count = static_cast<double>(channel.count);
  std::string text =
      fmt::format("the residuals of {} of \"{}\" depend on each other: {} numbers "
                  "count as {:.0f}",
                  fitted.name, spec.tests[channel.test].name, channel.count, channel.effective);
  const double p = std::isfinite(fitted.chi_squared)
                       ? boost::math::gamma_q(count / 2, fitted.chi_squared / 2)
                       : 1;
  if (channel.std && p < misfit_p_value)
    text += fmt::format(". As independent ones they would not fit (χ² {:.4g}, p {:.2g}): the model "
                        "lacks something, as an offset of the clock (time_offset_std) or a "
                        "dispersion that is not fitted, and parameters may be off by more than "
                        "their intervals",
                        fitted.chi_squared, p);
  return text;
}

void add_misfits(const FitResult& result, const FitSpec& spec, std::vector<std::string>& list) {
  for (const FittedChannel& fitted : result.channels) {
    const std::string where =
        fmt::format("{} of \"{}\"", fitted.name, spec.tests[fitted.channel.test].name);
    const double sigmas = fitted.channel.std ? fitted.rms / *fitted.channel.std : 0;
    const bool far_samples = !fitted.outliers.empty();
    if (far_samples)
      list.push_back(where + ": " + outliers_text(fitted, unit_of_column(fitted.name)));
    const double rest = far_samples ? fitted.rest_rms / fitted.channel.std.value_or(fitted.rms) : 0;
    if (far_samples && rest <= foreign_sigmas) continue;
    if (fitted.channel.column && sigmas > foreign_sigmas)
      list.push_back(fmt::format("{}: the residuals are {:.0f} σ at the best fit: a trace of "
                                 "another hinge, another sense or unit, a test under other "
                                 "conditions, or a local optimum: then more \"starts\" fit it",
                                 where, sigmas));
    else if (fitted.channel.column && sigmas > 0 && sigmas * too_close < 1)
      list.push_back(fmt::format("{}: the residuals are {:.2g} σ at the best fit: is its std too "
                                 "large, or in another unit?",
                                 where, sigmas));
    else if (fitted.p_value < misfit_p_value)
      list.push_back(fmt::format("the model does not fit {}: {}", where, misfit_text(fitted)));
  }
  if (result.values.count > 1 && result.values.p_value < misfit_p_value)
    list.push_back(fmt::format("the model does not fit the {} measured values together: χ² {:.4g}, "
                               "p {:.2g}",
                               result.values.count, result.values.chi_squared,
                               result.values.p_value));
  for (const FittedParameter& each : result.parameters)
    if (each.prior_sigmas > conflict_sigmas)
      list.push_back(fmt::format("{} lies {:.1f} standard deviations of its prior from the prior's "
                                 "median: tests and prior contradict each other",
                                 each.name, each.prior_sigmas));
  for (const FittedParameter& each : result.parameters)
    if (each.limit)
      list.push_back(
          fmt::format("{} lies at the limit {:.6g} of its prior: the tests ask for a "
                      "value beyond it, and the posterior is cut there. Widen its law, or "
                      "look for what the model lacks",
                      each.name, *each.limit));
}

std::string parameters_text(const FitResult& result) {
  std::string text =
      fmt::format("{}{:>24}{:>24}{:>26}{:>10}\n", in_column("PARAMETER", name_width),
                  "prior mean ± sd", "posterior mean ± sd", "95 % interval", "sd left");
  for (const FittedParameter& each : result.parameters)
    text += fmt::format(
        "{}{:>24}{:>24}{:>26}{:>10}{}\n", in_column("  " + each.name, name_width),
        fmt::format("{:.5g} +- {:.3g}", each.prior_mean, each.prior_std),
        fmt::format("{:.5g} +- {:.3g}", each.mean, each.std),
        fmt::format("{:.5g} to {:.5g}", each.lower, each.upper), percent(each.std_ratio(), 0),
        each.limit ? fmt::format("\n    at the limit {:.6g} of its prior", *each.limit) : "");
  return text;
}

std::string identifiability_text(const FitResult& result) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < result.common; ++k) names.push_back(result.parameters[k].name);
  std::string text = "\nIDENTIFIABILITY\n";
  bool all_seen = true;
  for (const FitDirection& direction : result.directions) {
    if (direction.std_ratio < unseen_ratio) continue;
    all_seen = false;
    text += paragraph(describe(direction, names, result.score_covariance, result.prior_covariance));
  }
  if (all_seen) text += paragraph("the tests see every combination of the parameters");
  if (const std::vector<std::string> by_prior = names_by_prior(result); !by_prior.empty())
    text +=
        paragraph(fmt::format("the prior decides, not the tests: {}", fmt::join(by_prior, ", ")));
  return text;
}

std::string candidates_text(const FitResult& result) {
  if (result.candidates.empty()) return "";
  std::string text =
      "\nFURTHER TESTS                  expected information   sd that shrinks most\n";
  std::vector<CandidateGain> sorted = result.candidates;
  std::ranges::stable_sort(sorted, std::greater(), &CandidateGain::information);
  for (const CandidateGain& gain : sorted) {
    const auto least = std::ranges::min_element(gain.shrink) - gain.shrink.begin();
    text += fmt::format("{}{:>17.2f} nats   {} to {}\n", in_column("  " + gain.name, name_width),
                        gain.information, result.parameters[static_cast<std::size_t>(least)].name,
                        percent(gain.shrink[static_cast<std::size_t>(least)], 0));
  }
  return text;
}

/// Finds the predicted peaks that t_end cut.
void add_cut_peaks(const FitResult& result, std::vector<std::string>& list) {
  std::vector<std::string> names;
  long most = 0;
  for (const PredictedOutput& output : result.prediction.outputs)
    if (output.cut > 0) names.push_back(output.name), most = std::max(most, output.cut);
  if (!names.empty())
    list.push_back(fmt::format("t_end cut the predicted peaks of {} in up to {} of {} runs: their "
                               "quantiles are those of the cut values. {}",
                               fmt::join(names, ", "), most, 2 * predicted_runs,
                               advice_on_t_end(result.prediction.never_final)));
}

/// Fewer measured numbers than unknown dispersions leave some of them to the priors.
void add_few_numbers(const FitResult& result, std::vector<std::string>& list) {
  std::size_t numbers = 0;
  for (const FittedChannel& fitted : result.channels) numbers += fitted.channel.count;
  const auto unknowns = static_cast<std::size_t>(
      std::ranges::count(result.space, FitParameter::Kind::dispersion, &FitParameter::kind));
  if (numbers < unknowns)
    list.push_back(fmt::format("{} measured number{} for {} parameters: the priors decide the rest",
                               numbers, numbers == 1 ? "" : "s", unknowns));
}

std::string prediction_text(const FitResult& result) {
  const FitPrediction& prediction = result.prediction;
  if (prediction.outputs.empty()) return "";
  const auto line = [](std::string_view name, std::string_view before, std::string_view after) {
    return fmt::format("{}  {:>34}  {:>34}\n", in_column(name, name_width), before, after);
  };
  std::string text =
      '\n' + line("PREDICTION 5 %, 50 %, 95 %", "before the tests", "after") +
      line("  deployed", percent(prediction.deployed[0], 1), percent(prediction.deployed[1], 1));
  bool some_missing = false;
  const auto value = [&](double quantile) {
    some_missing = some_missing || std::isnan(quantile);
    return std::isnan(quantile) ? std::string("none") : fmt::format("{:.5g}", quantile);
  };
  const auto range = [&](const std::array<double, 3>& values) {
    return fmt::format("{}  {}  {}", value(values[0]), value(values[1]), value(values[2]));
  };
  for (const PredictedOutput& output : prediction.outputs)
    text += line("  " + output.name, range(output.before), range(output.after));
  if (some_missing)
    text += "  none: the quantile is over all runs, and too many of them lack the output\n";
  return text;
}

/// "spring 0.95 (best 1.02), friction 1.3 (best 0.9)".
std::string mode_text(const FitResult& result, const std::vector<double>& other) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t k = 0; k < std::min(other.size(), most); ++k)
    text += fmt::format("{}{} {:.5g} (best {:.5g})", k == 0 ? "" : ", ", result.parameters[k].name,
                        other[k], result.parameters[k].mode);
  return text;
}

/// Offsets of sensors that their std hardly allows.
void add_far_offsets(const FitResult& result, const FitSpec& spec, std::vector<std::string>& list) {
  for (const FittedChannel& fitted : result.channels) {
    const Channel& channel = fitted.channel;
    if (!channel.std || std::abs(fitted.offset) <= conflict_sigmas * channel.offset_std) continue;
    const std::string_view unit = unit_of_column(fitted.name);
    list.push_back(fmt::format(
        "the offset of {} of \"{}\" is {}, {:.1f} standard deviations ({}): test and "
        "prior contradict each other, and parameters may be off",
        fitted.name, spec.tests[channel.test].name, with_unit(fitted.offset, unit),
        std::abs(fitted.offset) / channel.offset_std, with_unit(channel.offset_std, unit)));
  }
}

} // namespace

std::vector<std::string> names_by_prior(const FitResult& result) {
  std::vector<std::string> names;
  for (const FittedParameter& each : result.parameters)
    if (each.score_std >= unseen_ratio) names.push_back(each.name);
  return names;
}

std::vector<std::string> fit_findings(const FitResult& result, const FitSpec& spec) {
  std::vector<std::string> list;
  add_misfits(result, spec, list);
  add_far_offsets(result, spec, list);
  add_cut_peaks(result, list);
  if (!result.finished)
    list.push_back(fmt::format(
        "not finished: effective sample size {:.0f} of {}, split R-hat {:.3f} "
        "after {} runs of the sampler",
        result.sampler.ess, spec.samples, result.sampler.r_hat, result.sampler.evaluations));
  for (const OtherMode& mode : result.other_modes)
    if (mode.distance > other_mode_distance)
      list.push_back(
          fmt::format("another mode lies {:.1f} sd away, {:.1f} nats below the best one: {}",
                      mode.distance, mode.drop, mode_text(result, mode.parameters)));
  for (const FittedChannel& fitted : result.channels)
    if (fitted.channel.effective < 0.5 * static_cast<double>(fitted.channel.count))
      list.push_back(dependence_text(fitted, spec));
  for (const InterpolatedTest& test : result.interpolated)
    list.push_back(fmt::format("the trace of \"{}\" asks for more samples of a run than are kept: "
                               "interpolated over {:.3g} s, the "
                               "predictions are off by up to χ² = {:.2g}. Split it, or leave "
                               "samples out where nothing moves",
                               test.name, test.interval, test.chi_squared));
  add_repeated(spec, list);
  add_few_numbers(result, list);
  add_held(result, list);
  const auto is_own = [](const FitParameter& each) { return each.test.has_value(); };
  if (!result.space.empty() && std::ranges::all_of(result.space, is_own) &&
      result.posterior.columns.empty())
    list.push_back(
        "every fitted parameter is a test's own: nothing is known of other units, so there is no "
        "posterior.csv, no campaign.json and no prediction");
  if (result.beside_cases && !result.prediction.outputs.empty())
    list.emplace_back(
        "the prediction is of the campaign's wing without any of its cases; `wingspread "
        "run` of the written campaign predicts each");
  for (const std::string& law : result.lost_laws)
    list.push_back("the law of this case is not in the written campaign, which draws the posterior "
                   "in every case, so that its prediction is not of this case: " +
                   law);
  return list;
}

std::string fit_text(const FitResult& result, const FitSpec& spec) {
  std::string text;
  for (const std::string& finding : fit_findings(result, spec)) text += paragraph(finding, 0);
  if (!text.empty()) text += '\n';
  text += parameters_text(result) + identifiability_text(result) + candidates_text(result) +
          prediction_text(result);
  text += fmt::format(
      "\n{} runs; effective sample size {:.0f}, split R-hat {:.4f}, {} of the moves "
      "accepted\n",
      result.runs, result.sampler.ess, result.sampler.r_hat, percent(result.sampler.acceptance, 0));
  return text;
}

} // namespace wingspread
