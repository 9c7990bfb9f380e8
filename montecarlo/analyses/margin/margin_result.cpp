#include "montecarlo/analyses/margin/margin_result.hpp"

#include "montecarlo/foundation/statistics/binomial_bounds.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace wingspread {
namespace {

/// The number of draws that break the condition at one of the scales but not at the scale before it, summed over them.
long relapses(const std::vector<const ScaleResult*>& scales, const MarginCondition& condition) {
  std::set<long> relapsed;
  for (std::size_t k = 1; k < scales.size(); ++k) {
    const Spilled<long>& before = verdict_of(*scales[k - 1], condition).broken;
    const std::set<long> broken(before.begin(), before.end());
    for (const long run : verdict_of(*scales[k], condition).broken)
      if (!broken.contains(run)) relapsed.insert(run);
  }
  return std::ssize(relapsed);
}

} // namespace

DeployedShare deployed_share(const CaseResult& one, double confidence) {
  const long runs = std::reduce(one.statuses.begin(), one.statuses.end());
  const long deployed = one.statuses[static_cast<std::size_t>(Status::deployed)];
  return {runs, static_cast<double>(deployed) / static_cast<double>(runs),
          clopper_pearson(deployed, runs, confidence)};
}

bool applies(const Requirement& requirement, const MarginCase& which) {
  return which.weakened.empty() || !requirement.static_margin;
}

std::vector<MarginCondition> conditions_of(const Campaign& campaign, const MarginResult& result) {
  std::vector<MarginCondition> conditions;
  for (std::size_t which = 0; which < result.cases.size(); ++which) {
    std::size_t verdict = 0;
    for (std::size_t k = 0; k < campaign.requirements.size(); ++k)
      if (applies(campaign.requirements[k], result.cases[which]))
        conditions.push_back({which, k, verdict++});
  }
  return conditions;
}

const Verdict& verdict_of(const ScaleResult& cases, const MarginCondition& condition) {
  return cases[condition.which_case].verdicts[condition.verdict];
}

double quantile_of(const ScaleResult& cases, const MarginCondition& condition) {
  const std::vector<double>& quantiles = cases[condition.which_case].quantiles;
  return condition.verdict < quantiles.size() ? quantiles[condition.verdict]
                                              : std::numeric_limits<double>::quiet_NaN();
}

Failing failing(const ScaleResult& cases) {
  Failing failing;
  std::size_t condition = 0;
  for (const CaseResult& each : cases)
    for (const Verdict& verdict : each.verdicts) {
      if (verdict.decision != Decision::pass) failing.insert(condition);
      ++condition;
    }
  return failing;
}

FailingByScale failing_by_scale(const MarginSearch& search) {
  FailingByScale by_scale;
  for (const auto& [scale, cases] : search.seen) by_scale[scale] = failing(cases);
  return by_scale;
}

bool is_confirmed(const MarginSearch& search) {
  return search.confirmation && failing(*search.confirmation).empty();
}

OutOfOrder out_of_order(const MarginSearch& search, const MarginCondition& condition,
                        double middle) {
  std::vector<const ScaleResult*> below, above; // each from its outermost scale inwards
  for (const auto& [scale, cases] : search.seen) {
    if (scale <= middle) below.push_back(&cases);
    if (scale >= middle) above.insert(above.begin(), &cases);
  }
  return {relapses(below, condition), relapses(above, condition)};
}

} // namespace wingspread
