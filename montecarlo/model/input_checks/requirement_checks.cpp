#include "montecarlo/model/input_checks/requirement_checks.hpp"

#include "distributions/prepared_distribution.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr double far_off = 100; // heuristic: between a wide margin and N·mm for N·m

bool feels_air(const Scene& scene) {
  return scene.environment.air_density > 0 &&
         std::ranges::any_of(scene.bodies, [](const Body& body) { return body.plate.has_value(); });
}

bool stands_still(const Base& base) {
  return base.motion == BaseMotion::fixed ||
         (base.motion == BaseMotion::prescribed && !base.table && base.acceleration.isZero(0) &&
          base.angular_acceleration == 0 && base.rate == 0);
}

/// Whether the hinge swings in its latch's backlash until exact friction holds it.
bool has_backlash(const Hinge& hinge) { return hinge.latch && hinge.latch->backlash > 0; }
bool is_held_by_friction(const Hinge& hinge) {
  return hinge.friction.model == FrictionModel::exact && hinge.friction.coulomb != 0;
}

/// The output's value in the nominal deployment; nothing if it has none.
std::optional<double> nominal_of(const Campaign& campaign, const std::string& output,
                                 const Outcome& nominal) {
  const std::vector<OutputColumn> columns = output_columns(campaign.scene, campaign.outputs);
  const auto column = std::ranges::find(columns, output, &OutputColumn::name);
  if (column == columns.end()) return std::nullopt;
  const double value = output_of(*column, nominal);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// Whether a limit on an angle or a rate differs from the nominal value by about 57.3, either way. A limit leaves a
/// margin: up to a factor of 3 on either side. A limit of less than half a degree, or one meant in degrees, is none of
/// these.
bool looks_converted(double limit, double nominal, const std::string& unit) {
  constexpr double margin = 3;
  if (!unit.starts_with("rad") || nominal == 0) return false;
  const double ratio = std::abs(limit / nominal);
  const auto is_about = [](double factor, double of) {
    return factor > of / margin && factor < of * margin;
  };
  return (is_about(ratio, degrees_per_radian) && std::abs(limit) >= 0.5) ||
         is_about(1 / ratio, degrees_per_radian);
}

/// Whether an output is far from 0 in every wing that deploys, so that a sensible limit is near the nominal value. A
/// symmetric wing hardly turns its base, and a damped one hardly overtravels: such outputs are left out.
bool has_size(OutputQuantity quantity) {
  using enum OutputQuantity;
  constexpr std::array sizes{latch_time, latch_rate,          peak_moment,    peak_force,
                             rate_at,    peak_bending_moment, deployment_time};
  return std::ranges::find(sizes, quantity) != sizes.end();
}

/// "root travels 1.57 rad", if a final angle or an overtravel is limited to more than half of its hinge's travel; else
/// empty. A wing that deploys has small ones, so such a limit (2 for 2 deg) forbids nothing.
std::string beyond_travel(const Campaign& campaign, const OutputName& output, double limit) {
  using enum OutputQuantity;
  constexpr double most = 0.5; // heuristic: of the travel
  if (!output.kind || (output.kind->quantity != overtravel && output.kind->quantity != final_angle))
    return "";
  const auto hinge = std::ranges::find(campaign.scene.hinges, output.hinge, &Hinge::name);
  if (hinge == campaign.scene.hinges.end()) return "";
  const double travel = std::abs(hinge->latched - hinge->stowed);
  if (!(std::abs(limit) > most * travel)) return "";
  return fmt::format("{} travels {:.4g} rad", hinge->name, travel);
}

/// Warns of a limit that is far from the value of a nominal wing that deploys, and of one of an angle far beyond the travel.
void check_size(const Campaign& campaign, const Requirement& own, const std::string& at,
                double limit, const std::optional<double>& value, InputWarnings& warnings) {
  const OutputName output = parse_output_name(own.output);
  if (const std::string beyond = beyond_travel(campaign, output, limit); !beyond.empty())
    return warnings.add(at, fmt::format("a limit of {} {}; {}", limit, output.unit, beyond),
                        "a limit well within the travel (write degrees as \"5 deg\")");
  if (!value || *value == 0 || limit == 0 || !output.kind || !has_size(output.kind->quantity))
    return;
  const double ratio = std::abs(limit / *value);
  if (ratio < far_off && ratio > 1 / far_off) return;
  const bool every_run = (ratio > 1) == own.max.has_value();
  warnings.add(at,
               fmt::format("a limit of {} {}; the nominal {} is {:.4g} {}", limit, output.unit,
                           own.output, *value, output.unit),
               fmt::format("a limit near the nominal value: {} run meets this one",
                           every_run ? "probably every" : "probably no"));
}

/// The scene with every draw at the same quantile of its law.
Scene scene_at(const Campaign& campaign, double quantile) {
  std::vector<double> draws;
  for (const Dispersion& dispersion : campaign.dispersions)
    draws.push_back(PreparedDistribution(dispersion.distribution).quantile(quantile));
  Scene scene = campaign.scene;
  apply(campaign, draws, campaign.scene, scene);
  return scene;
}

/// why_never_final of the campaign, or of the first of its cases that has a reason: "in case hot with a base that …".
std::string why_cut_in(const Campaign& campaign) {
  for (const Campaign& each : campaigns_of(campaign))
    if (const std::string_view why = why_never_final(each); !why.empty())
      return (campaign.cases.empty() ? "" : fmt::format("in case {} ", each.of_case)) +
             std::string(why);
  return "";
}

/// @param why_cut why_cut_in the campaign
void check_requirement(const Campaign& campaign, std::size_t k, const Outcome& nominal,
                       const std::string& why_cut, InputWarnings& warnings) {
  const Requirement& own = campaign.requirements[k];
  const std::string at = fmt::format("/{}", k);
  const std::string key = own.max ? "/max" : "/min";
  const double limit = own.max ? *own.max : own.min.value_or(0);
  const std::string unit = parse_output_name(own.output).unit;
  const std::optional<double> value = nominal_of(campaign, own.output, nominal);
  const bool is_peak = peak_kind(own.output) != PeakKind::none;
  if (limit < 0 && (own.absolute || is_peak))
    warnings.add(at + key, fmt::format("a limit of {} {} on a magnitude", limit, unit),
                 "a limit ≥ 0");
  else if (value && !own.absolute && limit * *value < 0)
    warnings.add(at + key,
                 fmt::format("a limit of {} {}; the nominal {} is {:.4g} {}", limit, unit,
                             own.output, *value, unit),
                 "a limit on the same side of zero; \"abs\": true limits the magnitude");
  else if (value && looks_converted(limit, *value, unit))
    warnings.add(at + key,
                 fmt::format("a limit of {} {}; the nominal {} is {:.4g} {}", limit, unit,
                             own.output, *value, unit),
                 "a limit in SI, near the nominal value (write degrees as \"5 deg\" or \"5 "
                 "deg/s\": a factor of 57.3)");
  else if (!is_peak || !own.max || why_cut.empty())
    check_size(campaign, own, at + key, limit,
               nominal.status == Status::deployed ? value : std::nullopt, warnings);
  else
    warnings.add(
        at, fmt::format("a limit on {} {}", own.output, why_cut),
        "a wing without that: there no peak is proven final, and every such run breaks the "
        "requirement, whatever t_end is");
}

/// Warns of a limit on the overtravel of a hinge without a latch where runs end at the last latch, before it may be largest.
void check_overtravel(const Campaign& campaign, std::size_t k, InputWarnings& warnings) {
  using enum OutputFamily;
  const Requirement& own = campaign.requirements[k];
  const OutputName output = parse_output_name(own.output);
  if (!own.max || !output.kind || output.kind->quantity != OutputQuantity::overtravel) return;
  for (const OutputFamily on : {peak_moment, peak_force, final_angle, base_motion})
    if (campaign.outputs.contains(on)) return;
  const auto hinge = std::ranges::find(campaign.scene.hinges, output.hinge, &Hinge::name);
  if (hinge == campaign.scene.hinges.end() || hinge->latch) return;
  warnings.add(fmt::format("/{}", k),
               fmt::format("a limit on {} up to the last latch, where runs of these outputs end",
                           own.output),
               "peak_moment among the outputs: runs then go on until no overtravel rises");
}

/// Warns of a lower limit above an upper one of the same output: no run meets both.
void check_together(const std::vector<Requirement>& all, std::size_t k, InputWarnings& warnings) {
  if (!all[k].min) return;
  for (const Requirement& other : all)
    if (other.max && *other.max < *all[k].min && other.output == all[k].output &&
        other.absolute == all[k].absolute)
      return warnings.add(fmt::format("/{}/min", k),
                          fmt::format("{} of {}, which another requirement limits to {}",
                                      *all[k].min, all[k].output, *other.max),
                          "a lower limit below the upper one: no run meets both");
}

/// Why no peak is final in one of the wings that have each parameter as one of the scenes has it. The parameters that make
/// a reason together may vary apart.
/// @param every whether all draws have a reason; else the reason begins with "for runs"
std::string_view why_in(std::span<const Scene> scenes, bool every) {
  const auto in_any = [&](auto&& has) { return std::ranges::any_of(scenes, has); };
  if (in_any([](const Scene& scene) {
        return scene.base.motion == BaseMotion::prescribed && scene.base.angular_acceleration != 0;
      }))
    return every ? "with a base that turns faster and faster"
                 : "for runs with a base that turns faster and faster";
  if (in_any(feels_air) && in_any([](const Scene& scene) { return !stands_still(scene.base); }))
    return every ? "in air, with a base that moves" : "for runs in air, with a base that moves";
  for (std::size_t h = 0; h < scenes.front().hinges.size(); ++h)
    if (in_any([h](const Scene& scene) { return has_backlash(scene.hinges[h]); }) &&
        in_any([h](const Scene& scene) { return !is_held_by_friction(scene.hinges[h]); }))
      return every ? "with backlash in a latch whose hinge has no exact friction"
                   : "for runs with backlash in a latch whose hinge has no exact friction";
  return "";
}

} // namespace

std::string_view why_never_final(const Scene& scene) { return why_in({&scene, 1}, true); }

std::string_view why_never_final(const Campaign& campaign) {
  constexpr double end = 1e-6; // heuristic: a value of a discrete law that is rarer is not seen
  const std::array scenes{scene_at(campaign, end), scene_at(campaign, 1 - end),
                          nominal_scene(campaign)};
  const bool every = !why_never_final(scenes[0]).empty() && !why_never_final(scenes[1]).empty();
  return why_in(scenes, every);
}

void check_requirements(const Campaign& campaign, const Outcome& nominal, InputWarnings& warnings) {
  const bool limits_peak = std::ranges::any_of(campaign.requirements, [](const Requirement& own) {
    return own.max && peak_kind(own.output) != PeakKind::none;
  });
  const std::string why_cut = limits_peak ? why_cut_in(campaign) : "";
  for (std::size_t k = 0; k < campaign.requirements.size(); ++k) {
    check_requirement(campaign, k, nominal, why_cut, warnings);
    check_overtravel(campaign, k, warnings);
    check_together(campaign.requirements, k, warnings);
  }
}

} // namespace wingspread
