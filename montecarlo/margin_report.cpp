#include "montecarlo/margin_report.hpp"

#include <algorithm>

namespace wingspread {
namespace {

std::string_view kind_of(const std::vector<Window>& holds) {
  if (holds.empty()) return "never";
  if (holds.size() > 1) return "several";
  const bool lower = holds.front().below.has_value(), upper = holds.front().above.has_value();
  if (lower) return upper ? "both" : "lower";
  return upper ? "upper" : "always";
}

MarginEdge edge(double passing, const std::optional<double>& failing, const Looks& looks) {
  if (!failing) return {passing, failing, {}};
  const Failing& conditions = looks.at(*failing);
  return {passing, failing, {conditions.begin(), conditions.end()}};
}

} // namespace

std::vector<ConditionReport> conditions(const MarginReport& report, const MarginSearch& search) {
  const Looks looks = looks_of(search);
  std::vector<ConditionReport> all;
  for (const MarginCondition& condition : conditions_of(report.campaign, report.result)) {
    const auto holds = windows_of(looks, all.size());
    ConditionReport& each = all.emplace_back();
    each.requirement = to_string(report.campaign.requirements[condition.requirement]);
    each.which_case = report.result.cases[condition.which_case].name;
    each.holds = holds;
    each.kind = kind_of(holds);
    if (search.recommended)
      each.out_of_order = out_of_order(search, condition, *search.recommended);
  }
  return all;
}

MarginEdge lower_edge(const Window& window, const Looks& looks) {
  return edge(window.lower, window.below, looks);
}

MarginEdge upper_edge(const Window& window, const Looks& looks) {
  return edge(window.upper, window.above, looks);
}

bool is_met(const MarginResult& result) {
  return std::ranges::all_of(result.searches, is_confirmed);
}

} // namespace wingspread
