#include "montecarlo/model/campaign/describe.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <set>
#include <span>

namespace wingspread {
namespace {

/// "2 N·m"; without a unit the number only.
std::string with_unit(double value, std::string_view unit) {
  if (unit == "rad") return degrees_text(value) + " deg";
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string describe_argument(double value) { return fmt::format("{:.6g}", value); }
std::string describe_argument(const std::vector<double>& values) {
  return values.size() <= 4 ? fmt::format("{}", fmt::join(values, " "))
                            : fmt::format("{} numbers", values.size());
}

/// "nominal 2 N·m", or where the draws' medians change the value "2 N·m as written, nominal 5.4 N·m".
std::string value_of_parameter(const Scene& written, const Scene& nominal,
                               const SceneParameter& what) {
  const std::string before = with_unit(what.in(written), unit_of(what)),
                    median = with_unit(what.in(nominal), unit_of(what));
  return (before == median ? "" : before + " as written, ") + "nominal " + median;
}

std::string describe_targets(const Scene& written, const Scene& nominal,
                             std::span<const SceneParameter> parameters) {
  std::vector<std::string> targets;
  for (const SceneParameter& target : parameters)
    targets.push_back(fmt::format("{} ({})", path_of(written, target),
                                  value_of_parameter(written, nominal, target)));
  return fmt::format("{}", fmt::join(targets, ", "));
}

/// "1.2 to 0.9 over -60 to 70 (monotone cubic through 3 points)".
std::string describe_table(const Curve& table) {
  const auto value_at = [&](std::size_t knot) { return table.pieces()[knot + 1].c[0]; };
  const std::vector<double>& draws = table.knots();
  return fmt::format("{} to {} over {} to {} (monotone cubic through {} points)", value_at(0),
                     value_at(draws.size() - 1), draws.front(), draws.back(), draws.size());
}

/// One line, and one more for each entry of a `through`.
std::string describe_dispersion(const Scene& written, const Scene& nominal,
                                const Dispersion& dispersion) {
  std::string text = fmt::format("{}: {}", dispersion.name, describe(dispersion.distribution));
  if (!dispersion.rows.empty()) text += fmt::format(", a column of the rows {}", dispersion.rows);
  for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve* table) {
    const std::string_view verb = apply_names[static_cast<std::size_t>(how)];
    text += table ? fmt::format("\n    {} by {}: {}", verb, describe_table(*table),
                                describe_targets(written, nominal, targets))
                  : fmt::format(", {} {}", verb, describe_targets(written, nominal, targets));
  });
  return text;
}

/// The parameters that several draws change, with the order of the draws.
std::string describe_shared(const Campaign& campaign) {
  std::string text;
  for (const auto& [paths, draws] : shared_targets(campaign.dispersions, campaign.scene))
    text += fmt::format("  {}: {}\n", fmt::join(paths, ", "), fmt::join(draws, ", then "));
  return text.empty() ? "" : "parameters changed by several draws\n" + text;
}

std::string describe_case(const Campaign& campaign, const CaseSpec& spec) {
  std::vector<std::string> changes;
  for (const auto& [how, target, value] : spec.changes) {
    const std::string_view unit = unit_of(target);
    changes.push_back(fmt::format(
        "{} {} {} ({} as written)", apply_names[static_cast<std::size_t>(how)],
        path_of(campaign.scene, target), with_unit(value, how == Apply::scale ? "" : unit),
        with_unit(target.in(campaign.scene), unit)));
  }
  for (const auto& [dispersion, distribution] : spec.distributions)
    changes.push_back(fmt::format("{}: {}", dispersion, describe(distribution)));
  if (changes.empty()) changes.emplace_back("as it is");
  return fmt::format("{}: {}", spec.name, fmt::join(changes, ", "));
}

std::string describe_cases(const Campaign& campaign) {
  if (campaign.cases.empty()) return "";
  std::string text = counted(std::ssize(campaign.cases), "case", "cases") + "\n";
  for (const CaseSpec& spec : campaign.cases)
    text += fmt::format("  {}\n", describe_case(campaign, spec));
  return text;
}

/// The replicates of a design and their sizes; empty for independent draws.
std::string describe_replicates(const Sampling& sampling) {
  if (!has_replicates(sampling)) return "";
  const auto each = static_cast<std::uint64_t>(sampling.runs / sampling.replicates);
  const bool even = sampling.runs % sampling.replicates == 0;
  const bool uneven_net =
      sampling.design == DesignKind::sobol && !(even && std::has_single_bit(each));
  std::string text;
  if (sampling.replicates > 1)
    text = fmt::format(", {} replicates of {} runs", sampling.replicates,
                       even ? fmt::format("{}", each) : fmt::format("{} or {}", each, each + 1));
  if (uneven_net) text += "; Sobol' points are most accurate with powers of two";
  if (sampling.replicates == 1) text += "; one replicate, so no bounds";
  return text;
}

std::string describe_sampling(const Sampling& sampling) {
  return fmt::format("{}, {}, seed {}", design_names[static_cast<std::size_t>(sampling.design)],
                     counted(sampling.runs, "run", "runs"), sampling.seed) +
         describe_replicates(sampling) +
         (sampling.extended_from.empty() ? ""
                                         : fmt::format(", extended: interim analyses after {} runs",
                                                       fmt::join(sampling.extended_from, ", ")));
}

std::string describe_correlation(const Campaign& campaign, const RankCorrelation& correlation) {
  return fmt::format("{} and {}: Spearman {}", campaign.dispersions[correlation.first].name,
                     campaign.dispersions[correlation.second].name, correlation.spearman);
}

/// The correlated dispersions that a stratified design does not stratify: the copula (copula.hpp) leaves the first of a
/// correlated group by name alone, and couples the others to it.
std::string describe_lost_strata(const Campaign& campaign) {
  if (campaign.sampling.design == DesignKind::random) return "";
  std::set<std::string> later;
  for (const RankCorrelation& pair : campaign.wanted_correlations)
    if (pair.spearman != 0)
      later.insert(
          std::max(campaign.dispersions[pair.first].name, campaign.dispersions[pair.second].name));
  if (later.empty()) return "";
  return fmt::format("  {} {} not stratified: of correlated dispersions the design stratifies the "
                     "first by name only\n",
                     fmt::join(later, ", "), later.size() == 1 ? "is" : "are");
}

std::string describe_integration(const Integration& integration) {
  const std::string latch =
      integration.smoothing ? fmt::format("smoothed over {} rad", *integration.smoothing) : "event";
  const std::string step =
      has_fixed_step(integration.method) ? fmt::format(", step {} s", integration.step) : "";
  return fmt::format("method {}{}, rtol {}, atol {}, latch {}, up to {} s and {} steps",
                     integration.method, step, integration.rtol, integration.atol, latch,
                     integration.t_end, integration.max_steps);
}

std::string describe_outputs(const Outputs& outputs) {
  std::vector<std::string_view> names;
  for (const OutputFamily family : outputs) names.push_back(about(family).name);
  if (names.empty()) return "none";
  return fmt::format(
      "{}{}", fmt::join(names, ", "),
      outputs.contains(OutputFamily::final_angle)
          ? "; for final_angle every run goes to t_end, unless all hinges stick before"
          : "");
}

std::string describe_statistics(const StatisticsSpec& statistics) {
  const int* bins = std::get_if<int>(&statistics.bins);
  const std::string accuracy = !statistics.accuracy_runs ? ""
                               : *statistics.accuracy_runs == 0
                                   ? ", integration error not measured"
                                   : fmt::format(", integration error from {}",
                                                 counted(*statistics.accuracy_runs, "run", "runs"));
  return fmt::format("quantiles {}, confidence {}, bins {}{}", fmt::join(statistics.quantiles, " "),
                     statistics.confidence, bins ? std::to_string(*bins) : "auto", accuracy);
}

/// The settings of static margins that differ from the defaults, "ecss/friction 1.5, points 11"; empty if none does.
std::string describe_static_margins(const StaticMarginSpec& spec, const Scene& scene) {
  const StaticMarginSpec usual = default_static_margins(scene);
  std::string text;
  const auto add = [&](const std::string& key, const std::string& value) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value);
  };
  for (const Json& change :
       Json::diff(write_static_margins(usual, scene), write_static_margins(spec, scene)))
    add(change.at("path").get<std::string>().substr(1), change.at("value").dump());
  if (spec.springs_per_hinge != usual.springs_per_hinge)
    add("springs_per_hinge", std::to_string(spec.springs_per_hinge));
  return text;
}

/// The requirement, and how many failures the campaign's runs allow.
/// @param unvaried where_nothing_varies in the campaign
std::string describe_requirement(const Campaign& campaign, const Requirement& requirement,
                                 const std::string& unvaried) {
  const long runs = campaign.sampling.runs;
  const double p = requirement.probability;
  const std::string text = to_string(requirement);
  if (!unvaried.empty())
    return fmt::format("{}: cannot be shown by runs that are all the same; dispersions: {}", text,
                       unvaried);
  const InterimAnalyses interim = interim_analyses(campaign);
  const double c = confidence_alone(campaign.requirements, requirement);
  if (!interim.before.empty() && allowed_failures(runs, p, c))
    return fmt::format("{}: how many of {} may break it depends on how many of the first {} do",
                       text, counted(runs, "run", "runs"), fmt::join(interim.before, ", "));
  const PassingRule rule = passing_rule({interim.planned}, runs, p, c);
  if (rule.allowed)
    return fmt::format("{}: {} of {} may break it", text, *rule.allowed,
                       counted(runs, "run", "runs"));
  const auto least = runs_to_show(p, rule.confidence, 0);
  return fmt::format("{}: cannot be shown with {}, it takes {}", text, counted(runs, "run", "runs"),
                     least ? std::to_string(*least) : fmt::format("more than {}", most_runs_sized));
}

std::string describe_margin(const MarginSpec& margin, const Scene& scene) {
  return fmt::format("{} scaled by {} to {}, {}, {}",
                     fmt::join(paths_of(scene, margin.scaled), ", "), margin.lower, margin.upper,
                     margin.mode == MarginMode::joint ? "all together" : "hinge by hinge",
                     !margin.one_spring_out ? "no spring lost"
                     : margin.nominal       ? "with and without a spring lost"
                                            : "with a spring lost");
}

std::string describe_guarantees(const Campaign& campaign) {
  std::string text;
  for (const auto& [probability, confidence, side] : campaign.statistics.tolerance_limits)
    text += fmt::format("tolerance limits: {} probability, {} confidence, {}\n", probability,
                        confidence, side_names[static_cast<std::size_t>(side)]);
  const std::string unvaried = where_nothing_varies(campaign);
  for (const Requirement& requirement : campaign.requirements)
    text += "requirement: " + describe_requirement(campaign, requirement, unvaried) + "\n";
  for (const StoppingGoal& goal : campaign.until)
    text += (std::holds_alternative<WidthGoal>(goal) ? "stop at an interval's width of: "
                                                     : "stop when decided: ") +
            to_string(goal) + "\n";
  if (const auto changed = describe_static_margins(campaign.motorization, campaign.scene);
      !changed.empty())
    text += "motorization: " + changed + "\n";
  if (campaign.margin)
    text += "margin: " + describe_margin(*campaign.margin, campaign.scene) + "\n";
  return text;
}

} // namespace

std::string describe(const Distribution& distribution) {
  std::string text(type_of(distribution.law));
  const char* separator = " (";
  std::visit(
      [&]<class L>(const L& law) {
        for (const auto& parameter : L::parameters()) {
          text += fmt::format("{}{} {}", separator, parameter.name,
                              describe_argument(law.*parameter.member));
          separator = ", ";
        }
      },
      distribution.law);
  text += ")";
  if (distribution.truncate)
    text +=
        fmt::format(" within [{}, {}]", distribution.truncate->lower, distribution.truncate->upper);
  return text;
}

std::string_view unit_of_draw(const Dispersion& dispersion) {
  if (dispersion.targets.empty() || dispersion.apply == Apply::scale) return "";
  const std::string_view unit = unit_of(dispersion.targets.front());
  const bool common = std::ranges::all_of(
      dispersion.targets, [&](const auto& target) { return unit_of(target) == unit; });
  return common ? unit : "";
}

std::string describe(const Campaign& campaign) {
  std::string text = "campaign\n" + describe(campaign.scene) +
                     counted(std::ssize(campaign.dispersions), "dispersion", "dispersions") + "\n";
  const Scene nominal = nominal_scene(campaign);
  for (const Dispersion& dispersion : campaign.dispersions)
    text += fmt::format("  {}\n", describe_dispersion(campaign.scene, nominal, dispersion));
  text += describe_shared(campaign) + describe_cases(campaign);
  if (!campaign.wanted_correlations.empty())
    text += counted(std::ssize(campaign.wanted_correlations), "correlation", "correlations") + "\n";
  for (const RankCorrelation& correlation : campaign.wanted_correlations)
    text += fmt::format("  {}\n", describe_correlation(campaign, correlation));
  text += describe_lost_strata(campaign);
  text += "sampling: " + describe_sampling(campaign.sampling) + "\n";
  text += "integration: " + describe_integration(campaign.integration) + "\n";
  text += "outputs: " + describe_outputs(campaign.outputs) + "\n";
  text += "statistics: " + describe_statistics(campaign.statistics) + "\n";
  return text + describe_guarantees(campaign);
}

} // namespace wingspread
