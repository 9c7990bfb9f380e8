#include "montecarlo/model/input_checks/requirement_checks.hpp"

#include "core/laws/linear_law.hpp"
#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"
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
#include <variant>
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

/// Whether gravity or the base's acceleration, seen from the base, loads the hinges. A table may end without either.
bool is_pushed(const Scene& scene) {
  const Base& base = scene.base;
  const bool is_driven = base.motion == BaseMotion::prescribed;
  if (base.motion == BaseMotion::free || (is_driven && base.table)) return false;
  return (is_driven ? base.acceleration : Eigen::Vector2d{0, 0}) != scene.environment.gravity;
}
bool turns_steadily(const Base& base) {
  return base.motion == BaseMotion::prescribed && !base.table && base.rate != 0;
}

HingeTerms<double> terms_of(const Hinge& hinge) {
  HingeTerms<double> terms{};
  detail::set_hinge(terms, hinge);
  return terms;
}
/// The moment, tables left out, once the latch has engaged.
LinearLaw<double> latched_law(const Hinge& hinge) {
  const HingeTerms<double> terms = terms_of(hinge);
  return linear_law(terms, terms.has_latch);
}

/// Whether the hinge swings in its latch's backlash until exact friction holds it.
bool has_backlash(const Hinge& hinge) { return hinge.latch && hinge.latch->backlash > 0; }
bool can_stick(const Hinge& hinge) {
  const auto& spring = hinge.spring.table;
  const bool is_measured = spring && spring->both_ways() && hinge.friction.scale != 0 &&
                           hinge.friction.model == FrictionModel::exact;
  return is_measured || terms_of(hinge).can_stick();
}

/// Whether no spring, latch, table, motor or loop turns hinge h back: the energy does not bound how far it goes.
bool is_unheld(const Scene& scene, std::size_t h) {
  const Hinge& hinge = scene.hinges[h];
  const auto ties = [h](const Synchronisation& loop) {
    return loop.first == static_cast<int>(h) || loop.second == static_cast<int>(h);
  };
  return !hinge.spring.table && !hinge.harness.table && !hinge.motor &&
         std::ranges::none_of(scene.synchronisations, ties) && latched_law(hinge).stiffness <= 0;
}
/// Whether an unheld hinge is driven away: one without any load goes on at what energy it has, which is bounded.
bool is_driven_off(const Scene& scene, std::size_t h) {
  const LinearLaw<double> law = latched_law(scene.hinges[h]);
  return law.stiffness < 0 || law.drive != 0 || is_pushed(scene) || turns_steadily(scene.base);
}

/// Whether nothing damps the hinge but friction.
bool is_undamped(const Hinge& hinge) {
  return latched_law(hinge).damping == 0 && !hinge.damper && !hinge.motor &&
         !(hinge.latch && hinge.latch->dissipation);
}
/// Whether neither loops nor bending panels are damped.
bool is_undamped_elsewhere(const Scene& scene) {
  return std::ranges::all_of(
             scene.synchronisations, [](double d) { return d == 0; }, &Synchronisation::damping) &&
         std::ranges::none_of(scene.bodies, [](const Body& body) {
           return body.flexible && body.flexible->damping_ratio != 0;
         });
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

/// Why no peak is final in one of the wings that have each parameter as one of the scenes has it: the parameters that make
/// a reason together may vary apart. All scenes have the same hinges.
std::string_view why_in(std::span<const Scene> scenes) {
  const auto in_any = [&](auto&& has) { return std::ranges::any_of(scenes, has); };
  if (in_any([](const Scene& scene) {
        return scene.base.motion == BaseMotion::prescribed && scene.base.angular_acceleration != 0;
      }))
    return "for runs with a base that turns faster and faster";
  if (in_any(feels_air) && in_any([](const Scene& scene) { return !stands_still(scene.base); }))
    return "for runs in air, with a base that moves";
  bool all_undamped = in_any(is_undamped_elsewhere);
  for (std::size_t h = 0; h < scenes.front().hinges.size(); ++h) {
    const auto any_hinge = [&](auto&& is) {
      return in_any([&](const Scene& scene) { return is(scene.hinges[h]); });
    };
    const bool may_slide = any_hinge([](const Hinge& hinge) { return !can_stick(hinge); });
    if (may_slide && any_hinge(has_backlash))
      return "for runs with backlash in a latch whose hinge has no exact friction";
    if (may_slide && in_any([h](const Scene& scene) { return is_unheld(scene, h); }) &&
        in_any([h](const Scene& scene) { return is_driven_off(scene, h); }))
      return "for runs with a hinge that nothing holds";
    all_undamped = all_undamped && any_hinge(is_undamped);
  }
  if (all_undamped && in_any(is_pushed) &&
      in_any([](const Scene& scene) { return turns_steadily(scene.base); }))
    return "for runs with latches without damping on a base that is pushed and turns";
  return "";
}

/// Appends the wings with every draw at the low end of its law, at the high end, and at random.
void add_wings(const Campaign& campaign, std::vector<Scene>& scenes) {
  constexpr double end = 1e-6; // heuristic: rarer draws of a continuous law are not looked for
  constexpr std::uint64_t some = 16; // heuristic: as many random wings with a reason stand for all
  std::vector<PreparedDistribution> laws;
  std::vector<double> low, high;
  for (const Dispersion& dispersion : campaign.dispersions) {
    const PreparedDistribution& law = laws.emplace_back(dispersion.distribution);
    const bool has_steps = std::holds_alternative<Discrete>(dispersion.distribution.law) ||
                           std::holds_alternative<Empirical>(dispersion.distribution.law);
    low.push_back(law.quantile(has_steps ? 0 : end));
    high.push_back(law.quantile_complement(has_steps ? 0 : end));
  }
  scenes.push_back(scene_with(campaign, low));
  scenes.push_back(scene_with(campaign, high));
  std::vector<double> draws(laws.size());
  for (std::uint64_t k = 0; k < some && !laws.empty(); ++k) {
    for (std::size_t i = 0; i < laws.size(); ++i)
      draws[i] = laws[i].quantile(
          uniform(campaign.sampling.seed, k, stream_name(campaign.dispersions[i].name)));
    scenes.push_back(scene_with(campaign, draws));
  }
}

/// why_in, without "for runs" where each of the scenes has this reason.
std::string_view why_in_all(std::span<const Scene> scenes) {
  constexpr std::string_view some = "for runs ";
  std::string_view why = why_in(scenes);
  const bool every = std::ranges::all_of(scenes, [&](const Scene& scene) {
    return why_in({&scene, 1}) == why;
  });
  if (every && !why.empty()) why.remove_prefix(some.size());
  return why;
}

} // namespace

std::string_view why_never_final(const Scene& scene) { return why_in_all({&scene, 1}); }

std::string_view why_never_final(const Campaign& campaign) {
  std::vector<Scene> scenes;
  add_wings(campaign, scenes);
  return why_in_all(scenes);
}

std::string_view why_never_final(const Campaign& campaign, const Campaign& other) {
  std::vector<Scene> scenes;
  add_wings(campaign, scenes), add_wings(other, scenes);
  return why_in_all(scenes);
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
