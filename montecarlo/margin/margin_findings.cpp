#include "montecarlo/margin/margin_findings.hpp"

#include "montecarlo/statistics/bonferroni.hpp"

#include <algorithm>
#include <iterator>

namespace wingspread {
namespace {

std::string_view kind_of(const std::vector<Window>& holds) {
  if (holds.empty()) return "never";
  if (holds.size() > 1) return "several";
  const bool lower = holds.front().below.has_value(), upper = holds.front().above.has_value();
  if (lower) return upper ? "both" : "lower";
  return upper ? "upper" : "always";
}

/// Whether a condition is broken by nothing but runs that did not deploy.
bool lacks_deployment(const Verdict& verdict, const CaseLook& look) {
  const long deployed = look.statuses[static_cast<std::size_t>(Status::deployed)];
  return std::ssize(verdict.broken) == verdict.runs - deployed;
}

MarginEdge edge(const MarginSearch& search, double passing, const std::optional<double>& failing) {
  MarginEdge edge{passing, failing, {}, {}};
  if (!failing) return edge;
  const ScaleLook& look = search.seen.at(*failing);
  const Failing why = telling(look);
  edge.set_by.assign(why.begin(), why.end());
  std::ranges::set_difference(wingspread::failing(look), why, std::back_inserter(edge.as_well));
  return edge;
}

/// The confidence of each condition.
std::vector<double> confidences_of(const Campaign& campaign, const MarginResult& result) {
  std::vector<double> confidences;
  for (const MarginCondition& condition : conditions_of(campaign, result))
    confidences.push_back(
        confidence_alone(campaign.requirements, campaign.requirements[condition.requirement]));
  return confidences;
}

} // namespace

std::vector<ConditionFinding> condition_findings(const Campaign& campaign,
                                                 const MarginResult& result,
                                                 const MarginSearch& search) {
  const Looks looks = looks_of(search);
  std::vector<ConditionFinding> all;
  for (const MarginCondition& condition : conditions_of(campaign, result)) {
    const auto holds = windows_of(looks, all.size());
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

Failing telling(const ScaleLook& look) {
  Failing all;
  std::size_t first = 0; // condition of the case
  for (const CaseLook& each : look) {
    std::optional<std::size_t> deployment; // the condition that stands for its want
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

bool is_met(const MarginResult& result) {
  return std::ranges::all_of(result.searches, is_confirmed);
}

const MarginSearch* recommending(const Campaign& campaign, const MarginResult& result) {
  const MarginSearch& search = result.searches.front();
  const bool joint = campaign.margin->mode == MarginMode::joint;
  return joint && search.recommended ? &search : nullptr;
}

} // namespace wingspread
