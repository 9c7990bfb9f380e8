#include "montecarlo/analyses/margin/margin_findings.hpp"

#include "montecarlo/analyses/margin/recommendation.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

namespace wingspread {
namespace {

std::string_view kind_of(const std::vector<Window>& holds) {
  if (holds.empty()) return "never";
  if (holds.size() > 1) return "several";
  const bool lower = holds.front().below.has_value(), upper = holds.front().above.has_value();
  if (lower) return upper ? "both" : "lower";
  return upper ? "upper" : "always";
}

/// Whether only runs that did not deploy break a condition.
bool lacks_deployment(const Verdict& verdict, const CaseResult& one) {
  const long deployed = one.statuses[static_cast<std::size_t>(Status::deployed)];
  return std::ssize(verdict.broken) == verdict.runs - deployed;
}

MarginEdge edge(const MarginSearch& search, double passing, const std::optional<double>& failing) {
  MarginEdge edge{passing, failing, {}, {}};
  if (!failing) return edge;
  const ScaleResult& cases = search.seen.at(*failing);
  const Failing why = to_report(cases);
  edge.set_by.assign(why.begin(), why.end());
  std::ranges::set_difference(wingspread::failing(cases), why, std::back_inserter(edge.as_well));
  return edge;
}

std::vector<double> confidences_of(const Campaign& campaign, const MarginResult& result) {
  std::vector<double> confidences;
  for (const MarginCondition& condition : conditions_of(campaign, result))
    confidences.push_back(
        confidence_alone(campaign.requirements, campaign.requirements[condition.requirement]));
  return confidences;
}

/// Whether some scale fails only because of cut peaks: all its requirements would pass if these did not break any.
bool is_closed_by_cut_peaks(const MarginSearch& search) {
  return std::ranges::any_of(search.seen, [](const auto& seen) {
    if (failing(seen.second).empty()) return false;
    return std::ranges::all_of(seen.second, [](const CaseResult& one) {
      return std::ranges::all_of(one.verdicts, [](const Verdict& verdict) {
        return verdict.decision == Decision::pass || rests_on_cut_peaks(verdict);
      });
    });
  });
}

std::string warn_of(const CutPeaks& each, const MarginResult& result) {
  return fmt::format("{}{}: at scale {} t_end cut the peak in {} of {} runs, and a cut peak breaks "
                     "the requirement. {}",
                     each.requirement,
                     result.cases.size() == 1 ? "" : fmt::format(" ({})", each.which_case),
                     each.scale, each.cut, each.runs, advice_on_t_end(each.never_final));
}

std::string_view never_final_in(const MarginResult& result, std::size_t which_case) {
  return why_never_final(result.campaigns[result.cases[which_case].campaign]);
}

/// The warning of the scale with most deployed runs whose latches may let go after t_end.
std::optional<std::string> open_latches(const MarginResult& result, const MarginSearch& search) {
  long most = 0, runs = 0;
  double at = 1;
  std::size_t in_case = 0;
  for (const auto& [scale, cases] : search.seen)
    for (std::size_t which = 0; which < cases.size(); ++which)
      if (const CaseResult& each = cases[which]; each.open_latches > most) {
        most = each.open_latches, at = scale, in_case = which;
        runs = std::accumulate(each.statuses.begin(), each.statuses.end(), 0L);
      }
  if (most == 0) return std::nullopt;
  return fmt::format("at scale {} {}", at,
                     warn_of_open_latches(most, runs, never_final_in(result, in_case)));
}

/// Whether more runs break the condition, or its quantile comes nearer to the limit.
bool is_worse(const Concession& change) {
  const bool nearer = change.recommended->requirement.min
                          ? change.quantile < change.present_quantile
                          : change.quantile > change.present_quantile;
  return nearer || change.recommended->broken.size() > change.present->broken.size();
}

} // namespace

std::vector<ConditionFinding> condition_findings(const Campaign& campaign,
                                                 const MarginResult& result,
                                                 const MarginSearch& search) {
  const FailingByScale by_scale = failing_by_scale(search);
  std::vector<ConditionFinding> all;
  for (const MarginCondition& condition : conditions_of(campaign, result)) {
    const auto holds = windows_of(by_scale, all.size());
    ConditionFinding& each = all.emplace_back();
    each.condition = condition;
    each.requirement = to_string(campaign.requirements[condition.requirement]);
    each.which_case = result.cases[condition.which_case].name;
    each.holds = holds;
    each.kind = kind_of(holds);
    if (search.recommended)
      each.out_of_order = out_of_order(search, condition, *search.recommended);
  }
  return all;
}

MarginEdge lower_edge(const MarginSearch& search, const Window& window) {
  return edge(search, window.lower, window.below);
}

MarginEdge upper_edge(const MarginSearch& search, const Window& window) {
  return edge(search, window.upper, window.above);
}

ScaleGap widest_gap(const MarginSearch& search, const Window& window) {
  ScaleGap widest{window.lower, window.lower};
  for (auto below = search.seen.find(window.lower); below->first < window.upper;) {
    const auto above = std::next(below);
    if (above->first / below->first > widest.upper / widest.lower)
      widest = {below->first, above->first};
    below = above;
  }
  return widest;
}

double window_confidence(const Campaign& campaign, const MarginResult& result,
                         const Window& window) {
  std::vector<double> confidences;
  for (const bool is_edge : {window.below.has_value(), window.above.has_value()})
    if (is_edge)
      std::ranges::copy(confidences_of(campaign, result), std::back_inserter(confidences));
  return joint_confidence(confidences);
}

double confirmation_confidence(const Campaign& campaign, const MarginResult& result) {
  return joint_confidence(confidences_of(campaign, result));
}

Failing to_report(const ScaleResult& cases) {
  Failing all;
  std::size_t first = 0; // the case's first condition
  for (const CaseResult& each : cases) {
    std::optional<std::size_t>
        deployment; // the condition reported for the runs that did not deploy
    for (std::size_t k = 0; k < each.verdicts.size(); ++k) {
      const Verdict& verdict = each.verdicts[k];
      if (verdict.decision == Decision::pass) continue;
      const bool is_deployed = verdict.requirement.output == deployed_output;
      if (!is_deployed && !lacks_deployment(verdict, each))
        all.insert(first + k);
      else if (is_deployed || !deployment)
        deployment = first + k;
    }
    if (deployment) all.insert(*deployment);
    first += each.verdicts.size();
  }
  return all;
}

std::vector<Concession> concessions(const Campaign& campaign, const MarginResult& result,
                                    const MarginSearch& search) {
  std::vector<Concession> all;
  const auto present = search.seen.find(1);
  if (!search.recommended || *search.recommended == 1 || present == search.seen.end()) return all;
  const ScaleResult& recommended = search.seen.at(*search.recommended);
  const auto conditions = conditions_of(campaign, result);
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const Concession change{
        k, &verdict_of(present->second, conditions[k]), &verdict_of(recommended, conditions[k]),
        quantile_of(present->second, conditions[k]), quantile_of(recommended, conditions[k])};
    if (is_worse(change)) all.push_back(change);
  }
  return all;
}

std::size_t most_strained(const ScaleResult& cases) {
  std::vector<double> strains;
  for (const CaseResult& each : cases)
    for (const Verdict& verdict : each.verdicts) strains.push_back(strain(verdict));
  return static_cast<std::size_t>(std::ranges::max_element(strains) - strains.begin());
}

ScaledWords words_of(const MarginSearch& search) {
  if (search.of_springs) return {};
  return {"values", "lowest values", "highest values", "present values", "scale", "NEW VALUES"};
}

std::string_view rule_of(const MarginSearch& search) {
  if (search.as_good.lower == search.as_good.upper) return "least strain";
  return *search.recommended == 1 ? words_of(search).present : "geometric mean";
}

std::string why_this_one(const MarginSearch& search) {
  const auto [lower, upper] = search.as_good;
  if (lower == upper) return "";
  const bool none_breaks = strain(search.seen.at(*search.recommended)) == 0;
  const std::string others =
      none_breaks ? fmt::format(", nor at any other scale seen from {} to {}", lower, upper)
                  : fmt::format(". No scale seen has fewer, and those from {} to {} have as few",
                                lower, upper);
  return fmt::format("{}: {}", others,
                     *search.recommended == 1 ? fmt::format("the {} are among them and are kept",
                                                            words_of(search).present)
                                              : "their geometric mean is recommended");
}

std::vector<CutPeaks> cut_peaks(const MarginResult& result, const MarginSearch& search) {
  std::map<std::pair<std::size_t, std::size_t>, CutPeaks> most; // by case and verdict
  for (const auto& [scale, cases] : search.seen)
    for (std::size_t which = 0; which < cases.size(); ++which)
      for (std::size_t k = 0; k < cases[which].verdicts.size(); ++k) {
        const Verdict& verdict = cases[which].verdicts[k];
        const bool used = scale == 1 || scale == search.recommended;
        if (verdict.cut == 0 || !(used || rests_on_cut_peaks(verdict))) continue;
        CutPeaks& known = most[{which, k}];
        const CutPeaks here{scale, to_string(verdict.requirement), result.cases[which].name,
                            verdict.cut, verdict.runs};
        const auto rank = [](const CutPeaks& each) {
          return std::pair(each.cut, -std::abs(std::log(each.scale)));
        };
        if (rank(here) > rank(known)) known = here;
      }
  std::vector<CutPeaks> all;
  for (auto& [place, each] : most) {
    each.never_final = never_final_in(result, place.first);
    all.push_back(std::move(each));
  }
  return all;
}

namespace {

/// "; nothing was run between 1.36 and 1.45, where a window is not ruled out: …", or empty.
std::string unseen_windows(const MarginSearch& search) {
  std::vector<std::string> cells;
  for (const auto& [lower, upper] : unresolved_cells(failing_by_scale(search)))
    cells.push_back(fmt::format("between {} and {}", lower, upper));
  if (cells.empty()) return "";
  return fmt::format("; nothing was run {}, where a window is not ruled out: a smaller "
                     "\"tolerance\" looks closer",
                     fmt::join(cells, " and "));
}

} // namespace

std::string why_withheld(const MarginSearch& search) {
  const std::string_view things = words_of(search).things;
  switch (search.withheld) {
  case Withheld::nothing:
    return "";
  case Withheld::no_window:
    return fmt::format("no scale that was run meets all requirements{}{}",
                       is_closed_by_cut_peaks(search) ? "; at some only because t_end cut peaks"
                                                      : "",
                       unseen_windows(search));
  case Withheld::no_lower_edge:
    return fmt::format(
        "nothing fails down to {}: no edge was found, and how far down the {} may go "
        "is not known",
        search.seen.begin()->first, things);
  case Withheld::no_upper_edge:
    return fmt::format("nothing fails up to {}: no edge was found, for nothing that is required "
                       "limits the {} from above",
                       search.seen.rbegin()->first, things);
  case Withheld::short_of_torque:
    break;
  }
  return fmt::format("only {} meet all requirements, and their static margins fall short",
                     search.of_springs ? "weaker springs" : "other values") +
         (search.passed_over ? ": " + to_string(*search.passed_over) : "");
}

std::vector<std::string> margin_warnings(const MarginResult& result) {
  std::vector<std::string> lines;
  if (std::ranges::any_of(result.campaigns, [](const Campaign& campaign) {
        return campaign.scene.base.motion == BaseMotion::prescribed;
      }))
    lines.emplace_back("the static margins leave out the loads of the moving base; give them as "
                       "\"inertia\" in the margin's \"torques\"");
  if (!result.campaigns.empty() && result.campaigns.front().margin &&
      !result.campaigns.front().margin->nominal)
    for (const Requirement& requirement : result.campaigns.front().requirements)
      if (requirement.static_margin)
        lines.push_back(
            fmt::format("\"{}\" is not judged, because every case of the margin lacks a "
                        "spring: add \"nominal\" to its cases",
                        to_string(requirement)));
  for (const MarginSearch& search : result.searches) {
    for (const CutPeaks& each : cut_peaks(result, search)) lines.push_back(warn_of(each, result));
    if (const auto open = open_latches(result, search)) lines.push_back(*open);
    if (!search.recommended) continue;
    std::string margins;
    for (const Shortfall& each :
         short_margins(result.campaigns, search.scaled, *search.recommended))
      margins += (margins.empty() ? "" : "; ") + to_string(each);
    if (!margins.empty())
      lines.push_back(fmt::format("at the recommended scale {} static margins are below 0: {}. "
                                  "Require them (\"motorization\") if the standard applies",
                                  *search.recommended, margins));
  }
  return lines;
}

bool is_met(const MarginResult& result) {
  return std::ranges::all_of(result.searches, is_confirmed);
}

const MarginSearch* recommending(const Campaign& campaign, const MarginResult& result) {
  const MarginSearch& search = result.searches.front();
  const bool joint = campaign.margin->mode == MarginMode::joint;
  return joint && search.recommended ? &search : nullptr;
}

} // namespace wingspread
