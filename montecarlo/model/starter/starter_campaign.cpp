#include "montecarlo/model/starter/starter_campaign.hpp"

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/starter/starter_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

using Elements = std::vector<AnnotatedLines>;

/// One dispersion. @param law the JSON of its distribution @param to "to" or "each" with its paths
AnnotatedLine dispersion(std::string_view name, std::string_view law, std::string_view to,
                         std::string_view note) {
  return {fmt::format(R"(    {{ "name": "{}", "distribution": {{ {} }}, "apply": "scale", {} }})",
                      name, law, to),
          std::string(note)};
}

std::string cut_normal(double std) {
  return fmt::format(R"("type": "normal", "mean": 1, "std": {}, "truncate": {{ "lower": {}, )"
                     R"("upper": {} }})",
                     std, short_number(1 - 4 * std), short_number(1 + 4 * std));
}

std::string lognormal(double sigma) {
  return fmt::format(R"("type": "lognormal", "mu_log": 0, "sigma_log": {})", sigma);
}

/// A factor that a temperature drives.
AnnotatedLine driven(std::string_view path, std::string_view factors, std::string_view note) {
  return {fmt::format(R"(        {{ "to": ["{}"], "apply": "scale", "table": {{ "at": [-80, -40, )"
                      R"(20, 70], "value": [{}] }} }})",
                      path, factors),
          std::string(note)};
}

/// Effects of the temperature. The factors are examples of a plausible size, for the user to replace by measured ones.
AnnotatedLines temperature(const WingDesign& design) {
  Elements effects;
  if (design.damper.value_or(0) > 0)
    effects.push_back({driven("hinges.*.damper.scale", "2.6, 1.8, 1, 0.7",
                              "its fluid: 1 at 20 °C, 2.6 times as stiff at −80 °C")});
  if (design.friction > 0)
    effects.push_back({driven("hinges.*.friction.scale", "1.9, 1.4, 1, 1.1", "grease")});
  if (design.harness > 0)
    effects.push_back({driven("hinges.*.harness.scale", "2.4, 1.6, 1, 0.85", "cables")});
  if (effects.empty()) // springs lose little; something has to depend on the cases
    effects.push_back({driven("hinges.*.spring.scale", "0.98, 0.99, 1, 1", "springs")});
  AnnotatedLines lines{
      {R"(    { "name": "temperature", "distribution": { "type": "normal", "mean": 20, "std": 5 },)",
       "one draw, in °C, that drives several parameters by tables: in a cold run all of them are "
       "stiff"},
      {R"(      "through": [)"}};
  for (AnnotatedLine& line : joined(std::move(effects))) lines.push_back(std::move(line));
  lines.back().json += " ] }";
  return lines;
}

AnnotatedLines dispersions(const WingDesign& design) {
  Elements all;
  all.push_back({dispersion("spring", cut_normal(0.03), R"("each": "hinges.*.spring.scale")",
                            "`each`: every hinge's spring has its own draw; 3 % if sorted after a "
                            "torque test, cut at ±4σ")});
  if (design.friction > 0)
    all.push_back({dispersion("friction", lognormal(0.3), R"("each": "hinges.*.friction.scale")",
                              "a factor of two at 2.3σ: lubrication, preload")});
  if (design.harness > 0)
    all.push_back({dispersion("harness", lognormal(0.25), R"("each": "hinges.*.harness.scale")",
                              "cables: routing, and how stiff they are")});
  if (design.damper.value_or(0) > 0)
    all.push_back({dispersion("damper", cut_normal(0.1), R"("each": "hinges.*.damper.scale")",
                              "10 % from one damper to the next")});
  all.push_back({dispersion("mass", cut_normal(0.01), R"("each": "bodies.*.mass")",
                            "weighed panels: adhesive, cables, cells")});
  all.push_back({dispersion("inertia", cut_normal(0.015), R"("each": "bodies.*.inertia")",
                            "usually computed, not measured")});
  all.push_back(
      {dispersion("latch_stiffness", cut_normal(0.08), R"("each": "hinges.*.latch.stiffness")",
                  "seldom known better before a modal test")});
  all.push_back(
      {dispersion("latch_damping", R"("type": "uniform", "lower": 0.7, "upper": 1.3)",
                  R"("each": "hinges.*.latch.damping")", "hardly ever known: no value preferred")});
  all.push_back(temperature(design));
  return joined(std::move(all));
}

AnnotatedLines requirements(const WingDesign& design, const StarterLimits& limits) {
  const std::string share = R"("probability": 0.9973, "confidence": 0.9)";
  Elements all;
  all.push_back(
      {{fmt::format(R"(    {{ "name": "D-1", "output": "deployed", {} }})", share),
        "at least 99.73 % of all wings that could be built deploy, shown with 90 % confidence"}});
  all.push_back(
      {{fmt::format(R"(    {{ "name": "D-2", "output": "deployment_time", "max": "{} s", )"
                    R"({} }})",
                    short_number(limits.deployment_time), share),
        limits.placeholders
            ? "the last latch; a placeholder: the nominal wing does not deploy in every case"
            : "the last latch; here twice the time of the slowest nominal case"}});
  const std::vector<DesignedWing> wings = designed_wings(design);
  for (std::size_t w = 0; w < wings.size(); ++w)
    all.push_back(
        {{fmt::format(R"(    {{ "name": "L-{}", "output": "{}.peak_moment", "max": "{} N*m", )"
                      R"({} }})",
                      w + 1, wings[w].hinges.front().name,
                      short_number(w < limits.moment.size() ? limits.moment[w] : 0), share),
          w > 0                 ? ""
          : limits.placeholders ? "what the root may carry; a placeholder"
                                : "what the root may carry; here three times that of the worst "
                                  "nominal case"}});
  return joined(std::move(all));
}

/// A campaign's file for limits that are not known yet: its wings can be run.
Campaign unlimited(const WingDesign& design) {
  StarterLimits none;
  none.t_end = latest_end;
  none.deployment_time = latest_end;
  none.moment.assign(static_cast<std::size_t>(design.wings), 1);
  Json json = parse_json(json_file_text(starter_campaign(design, "", none)));
  json["scene"] = parse_json(json_file_text(starter_scene(design)));
  return read_campaign(json.dump(), "");
}

// Heuristics: the dispersed wings of 1 to 4 panels stay below; a peak that depends on who latches last varies more.
constexpr double reserve_of_time = 2, reserve_of_moment = 3;

/// Rounded up to two digits.
double rounded_up(double limit) {
  const double near = two_digits(limit);
  const double step = std::pow(10, std::floor(std::log10(limit)) - 1);
  return near < limit ? two_digits(near + step) : near;
}

} // namespace

AnnotatedLines starter_campaign(const WingDesign& design, const std::string& scene_file,
                                const StarterLimits& limits) {
  AnnotatedLines lines{
      {"{"},
      {fmt::format(R"(  "scene": "{}",)", scene_file), "the wing, in the file beside this one"},
      {R"(  "dispersions": [)"}};
  const auto append = [&](AnnotatedLines more) {
    for (AnnotatedLine& line : more) lines.push_back(std::move(line));
  };
  append(dispersions(design));
  append(
      {{"  ],"},
       {R"(  "cases": [)"},
       {R"(    { "name": "cold", "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 5 } } },)",
        "variants of the wing, all with the same draws: here only the law of the temperature "
        "differs"},
       {R"(    { "name": "ambient" },)", "the campaign as it stands"},
       {R"(    { "name": "hot", "distributions": { "temperature": { "type": "normal", "mean": 60, "std": 5 } } })"},
       {"  ],"},
       {R"(  "sampling": { "design": "random", "runs": 1000, "seed": 1 },)",
        "independent draws; 852 runs without a failure show 99.73 % at 90 % (`wingspread size`)"},
       {fmt::format(R"(  "integration": {{ "t_end": {} }},)", short_number(limits.t_end)),
        "a run that has not deployed by then, in s, is counted as timed out; a run ends earlier, "
        "once "
        "no larger peak can follow"},
       {R"(  "requirements": [)"}});
  append(requirements(design, limits));
  append({{"  ]"}, {"}"}});
  return lines;
}

std::optional<StarterLimits> starter_limits(const WingDesign& design) {
  StarterLimits limits;
  for (const Campaign& campaign : campaigns_of(unlimited(design))) {
    const Outcome outcome = Deployment().run(nominal_scene(campaign), campaign.integration, {});
    if (outcome.status != Status::deployed) return std::nullopt;
    limits.deployment_time = std::max(limits.deployment_time, outcome.latches.back().time);
    if (outcome.peaks_final) limits.t_end = std::max(limits.t_end, outcome.t_end);
    const std::size_t each = outcome.peak_moment.size() / static_cast<std::size_t>(design.wings);
    limits.moment.resize(static_cast<std::size_t>(design.wings));
    for (std::size_t w = 0; w < limits.moment.size(); ++w)
      limits.moment[w] = std::max(limits.moment[w], outcome.peak_moment[w * each].value);
  }
  limits.deployment_time = rounded_up(reserve_of_time * limits.deployment_time);
  limits.t_end = rounded_up(2 * std::max(limits.deployment_time, limits.t_end));
  for (double& moment : limits.moment) moment = rounded_up(reserve_of_moment * moment);
  return limits;
}

} // namespace wingspread
