#include "montecarlo/model/campaign/campaign_settings.hpp"

#include "core/outcome.hpp"
#include "montecarlo/foundation/formats/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

constexpr std::int64_t most_bins = 10'000;
constexpr std::size_t most_quantiles = 1000;
constexpr std::int64_t most_replicates = 1'000'000;
constexpr std::string_view fixed_step_method = "runge_kutta4";

constexpr std::int64_t most_accuracy_runs = 10'000;
constexpr const char* accuracy_runs_expected = "an integer from 0 (none) to 10000";

constexpr double least_rtol = 1e-15; // some 4 epsilon: below, rounding dominates every step
constexpr const char* rtol_expected = "a number, ≥ 1e-15 and < 1, for example 1e-8";

bool is_rtol(const double& rtol) { return rtol >= least_rtol && rtol < 1; }
bool is_at_least_1(const std::int64_t& number) { return number >= 1; }

/// Returns false if it noted a problem.
bool read_method(const JsonCursor& at, std::string& method) {
  std::vector<std::string_view> names;
  for (const MethodInfo& info : methods()) names.push_back(info.name);
  const auto index = at.choice(names);
  if (index) method = names[*index];
  return index.has_value();
}

/// Refuses a step that the method would ignore.
void refuse_step(const JsonCursor& at, std::string_view method) {
  at.refuse(fmt::format("no step with the method \"{}\" (only used by a method with a fixed step: "
                        "{})",
                        method, fixed_step_method));
}

/// Refuses more replicates than runs or than most_replicates.
void refuse_replicates(const JsonCursor& at, const Sampling& sampling) {
  if (sampling.replicates > most_replicates)
    at.refuse(fmt::format("at most {}", most_replicates));
  else if (sampling.replicates > sampling.runs)
    at.refuse(fmt::format("at most the number of runs, {}", sampling.runs));
}

/// Reads the numbers of runs of earlier interim analyses.
void read_extended_from(const JsonCursor& at, Sampling& sampling) {
  constexpr const char* expected = "an array of integers ≥ 1, each less than the next";
  if (sampling.design == DesignKind::latin_hypercube)
    return void(at.refuse("none: a Latin hypercube of more runs has other draws"));
  if (!at.value().is_array()) return void(at.refuse(expected));
  std::int64_t before = 0;
  for (const JsonCursor& element : at.elements()) {
    std::int64_t runs = 0;
    if (!element.read(runs, expected)) continue;
    if (runs <= before)
      element.refuse(expected);
    else if (runs >= sampling.runs)
      element.refuse(fmt::format("less than the number of runs, {}", sampling.runs));
    else
      sampling.extended_from.push_back(before = runs);
  }
}

void read_latch_form(const JsonCursor& at, std::optional<double>& smoothing) {
  constexpr std::string_view expected = "\"event\" or { \"smoothed\": a number, rad, > 0 }";
  if (at.value() == "event") return smoothing.reset();
  if (!at.value().is_object()) return void(at.refuse(expected));
  JsonObject object(at, expected);
  object.required("smoothed", smoothing.emplace(), Dimension{"rad", "> 0"}, is_positive);
  object.refuse_others();
}

void read_quantiles(const JsonCursor& at, std::vector<double>& quantiles) {
  if (at.value().is_array() && at.value().size() > most_quantiles)
    return void(at.refuse(fmt::format("at most {} quantiles", most_quantiles)));
  if (!at.read(quantiles, "an array of numbers, each > 0 and < 1")) return;
  for (std::size_t i = 0; i < quantiles.size(); ++i) {
    const auto here = quantiles.begin() + static_cast<std::ptrdiff_t>(i);
    if (!is_proper_share(*here))
      at.element(i).refuse("a number, > 0 and < 1");
    else if (std::find(quantiles.begin(), here, *here) != here)
      at.element(i).refuse_repeated("each quantile once");
  }
  std::ranges::sort(quantiles); // tables and charts show the first and the last as the outermost
}

void read_tolerance(const JsonCursor& at, std::vector<ToleranceLimitSpec>& tolerance) {
  if (!at.value().is_array()) return void(at.refuse("an array of tolerance limits"));
  tolerance.clear();
  for (const JsonCursor& element : at.elements()) {
    ToleranceLimitSpec& spec = tolerance.emplace_back();
    JsonObject object(element, "an object with probability and confidence");
    object.required("probability", spec.probability, "a number, > 0 and < 1", is_proper_share);
    object.required("confidence", spec.confidence, "a number, > 0 and < 1", is_proper_share);
    object.optional_choice("side", spec.side, side_names);
    object.refuse_others();
  }
}

Json write_tolerance(const std::vector<ToleranceLimitSpec>& tolerance) {
  Json list = Json::array();
  for (const auto& [probability, confidence, side] : tolerance)
    list.push_back({{"probability", probability},
                    {"confidence", confidence},
                    {"side", side_names[static_cast<std::size_t>(side)]}});
  return list;
}

void read_accuracy_runs(const JsonCursor& at, StatisticsSpec& statistics) {
  std::int64_t runs = 0;
  if (!at.read(runs, accuracy_runs_expected)) return;
  if (runs < 0 || runs > most_accuracy_runs) return void(at.refuse(accuracy_runs_expected));
  statistics.accuracy_runs = runs;
}

void read_bins(const JsonCursor& at, Bins& bins) {
  if (at.value() == "auto") return void(bins = AutoBins{});
  const std::string expected = fmt::format("\"auto\" or an integer from 1 to {}", most_bins);
  std::int64_t count = 0;
  if (!at.read(count, expected)) return;
  if (count < 1 || count > most_bins) return void(at.refuse(expected));
  bins = static_cast<int>(count);
}

bool is_line(const std::string& text) { return !text.empty() && !has_control_characters(text); }

} // namespace

bool has_fixed_step(std::string_view method) { return method == fixed_step_method; }

Design design_of(const Sampling& sampling) {
  return {sampling.design, sampling.seed, static_cast<std::uint64_t>(sampling.runs),
          static_cast<std::uint64_t>(sampling.replicates)};
}

void read_sampling(const JsonCursor& at, Sampling& sampling) {
  JsonObject object(at, "an object with the sampling");
  object.optional_choice("design", sampling.design, design_names);
  object.optional("runs", sampling.runs, "an integer, ≥ 1", is_at_least_1);
  if (sampling.runs > most_runs)
    object.at().member("runs").refuse(fmt::format("at most {}", most_runs));
  object.optional("seed", sampling.seed, "an integer from 0 to 2^64 - 1");
  object.optional("replicates", sampling.replicates, "an integer, ≥ 1", is_at_least_1);
  const auto replicates = object.find("replicates");
  if (replicates && has_replicates(sampling)) refuse_replicates(*replicates, sampling);
  sampling.extended_from.clear();
  if (const auto extended = object.find("extended_from")) read_extended_from(*extended, sampling);
  object.refuse_others();
}

std::string beyond_smoothed_latches(const Scene& scene) {
  const Hinge* hinge = hinge_with_event_latch(scene);
  if (!hinge) return "";
  return fmt::format("a smoothed latch, and hinges.{}.latch.{}", hinge->name,
                     hinge->latch->capture_rate     ? "capture_rate"
                     : hinge->latch->holding_moment ? "holding_moment"
                                                    : "backlash");
}

void read_integration(const JsonCursor& at, Integration& integration) {
  JsonObject object(at, "an object with the integration");
  const auto method = object.find("method");
  const bool known = !method || read_method(*method, integration.method);
  const auto step = object.find("step");
  if (step && known && !has_fixed_step(integration.method))
    refuse_step(*step, integration.method);
  else
    object.optional("step", integration.step, Dimension{"s", "> 0"}, is_positive);
  object.optional("rtol", integration.rtol, rtol_expected, is_rtol);
  object.optional("atol", integration.atol, "a number, > 0", is_positive);
  if (const auto latch = object.find("latch")) read_latch_form(*latch, integration.smoothing);
  object.optional("t_end", integration.t_end, Dimension{"s", "> 0"}, is_positive);
  std::int64_t max_steps = integration.max_steps;
  object.optional("max_steps", max_steps, "an integer, ≥ 1", is_at_least_1);
  integration.max_steps = static_cast<long>(max_steps);
  object.refuse_others();
}

void read_statistics(const JsonCursor& at, StatisticsSpec& statistics) {
  JsonObject object(at, "an object with the statistics");
  if (const auto quantiles = object.find("quantiles"))
    read_quantiles(*quantiles, statistics.quantiles);
  object.optional("confidence", statistics.confidence, "a number, > 0 and < 1", is_proper_share);
  if (const auto bins = object.find("bins")) read_bins(*bins, statistics.bins);
  if (const auto tolerance = object.find("tolerance"))
    read_tolerance(*tolerance, statistics.tolerance_limits);
  if (const auto runs = object.find("accuracy_runs")) read_accuracy_runs(*runs, statistics);
  object.refuse_others();
}

void read_report_header(const JsonCursor& at, ReportHeader& header) {
  JsonObject object(at, "an object with the words on the report's first page");
  for (const auto& [key, help, member] : header_words)
    object.optional(key, header.*member, "a string, not empty, without control characters",
                    is_line);
  object.refuse_others();
}

Json write_sampling(const Sampling& sampling) {
  Json json{{"design", design_names[static_cast<std::size_t>(sampling.design)]},
            {"runs", sampling.runs},
            {"seed", sampling.seed},
            {"replicates", sampling.replicates}};
  if (!sampling.extended_from.empty()) json["extended_from"] = sampling.extended_from;
  return json;
}

Json write_integration(const Integration& integration) {
  const Json latch =
      integration.smoothing ? Json{{"smoothed", *integration.smoothing}} : Json("event");
  Json json{{"method", integration.method}, {"rtol", integration.rtol},
            {"atol", integration.atol},     {"latch", latch},
            {"t_end", integration.t_end},   {"max_steps", integration.max_steps}};
  if (has_fixed_step(integration.method)) json["step"] = integration.step;
  return json;
}

Json write_statistics(const StatisticsSpec& statistics) {
  const int* count = std::get_if<int>(&statistics.bins);
  Json json{{"quantiles", statistics.quantiles},
            {"confidence", statistics.confidence},
            {"bins", count ? Json(*count) : Json("auto")}};
  if (!statistics.tolerance_limits.empty())
    json["tolerance"] = write_tolerance(statistics.tolerance_limits);
  if (statistics.accuracy_runs) json["accuracy_runs"] = *statistics.accuracy_runs;
  return json;
}

Json write_report_header(const ReportHeader& header) {
  Json json = Json::object();
  for (const auto& [key, help, member] : header_words)
    if (!(header.*member).empty()) json[key] = header.*member;
  return json;
}

} // namespace wingspread
