#include "montecarlo/analyses/margin/margin_report.hpp"

#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "montecarlo/engine/runs/static_margin_draws.hpp"

namespace wingspread {
namespace {

/// Static margins with other springs. The worst draws do not list the scale, which is a constant.
StaticMarginStudy study_scaled(const Campaign& campaign,
                               const std::vector<SceneParameter>& parameters, double scale) {
  const Campaign other = scaled(campaign, parameters, scale);
  StaticMarginStudy study = study_static_margins(other);
  for (DriveMargins& drive : study.drives)
    for (Json& draw : drive.worst_draw) draw.erase(other.dispersions.back().name);
  return study;
}

} // namespace

MarginReport margin_report(const Campaign& campaign, const MarginResult& result) {
  MarginReport report{
      campaign, result, {campaign.motorization, campaign.scene, campaign.statistics.quantiles, {}}};
  std::vector<CaseMargins>& cases = report.static_margins.cases;
  for (const Campaign& each : result.campaigns)
    cases.push_back({1, each.of_case, study_static_margins(each)});
  const MarginSearch* search = recommending(campaign, result);
  if (search && *search->recommended != 1) {
    const double scale = *search->recommended;
    for (const Campaign& each : result.campaigns)
      cases.push_back({scale, each.of_case, study_scaled(each, search->scaled, scale)});
  }
  return report;
}

} // namespace wingspread
