#include "montecarlo/report/page/static_margins_json.hpp"

#include "montecarlo/engine/runs/static_margin_draws.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace wingspread {

namespace {

/// What requirements by this standard ask of a drive's margin, "root+mid" of coupled hinges; 0, the standard's, if none does.
double required_of(const std::string& drive, const std::vector<Requirement>& requirements,
                   MarginKind kind) {
  double most = 0;
  for (const Requirement& each : requirements) {
    if (!each.static_margin || each.static_margin->kind != kind || !each.min) continue;
    const std::string& hinge = each.static_margin->hinge;
    if (hinge == "*" || ('+' + drive + '+').find('+' + hinge + '+') != std::string::npos)
      most = std::max(most, *each.min);
  }
  return most;
}

Json curves_of(Campaign some) {
  constexpr std::int64_t most_margin_draws = 1000;
  if (!has_replicates(some.sampling)) // the draws of a design depend on their number
    some.sampling.runs = std::min(some.sampling.runs, most_margin_draws);
  const auto required = std::ranges::find_if(
      some.requirements, [](const Requirement& each) { return each.static_margin.has_value(); });
  const MarginKind kind =
      required == some.requirements.end() ? MarginKind::nasa : required->static_margin->kind;
  Json curves = static_margin_curves(study_static_margins(some), kind, some.statistics.quantiles);
  if (curves.is_null()) return curves;
  curves["formula"] = formula_of(kind, some.motorization);
  for (Json& hinge : curves["hinges"])
    hinge["required"] = required_of(hinge["hinge"], some.requirements, kind);
  return curves;
}

} // namespace

Json static_margins_json(const Campaign& campaign) {
  Json all;
  for (const Campaign& each : campaigns_of(campaign)) {
    Json curves = curves_of(each);
    if (curves.is_null()) continue;
    if (!campaign.cases.empty())
      for (Json& hinge : curves["hinges"])
        hinge["hinge"] = hinge["hinge"].get<std::string>() + " (" + each.of_case + ")";
    if (all.is_null())
      all = std::move(curves);
    else
      for (Json& hinge : curves["hinges"]) all["hinges"].push_back(std::move(hinge));
  }
  return all;
}

} // namespace wingspread
