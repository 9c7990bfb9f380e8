#include "montecarlo/analyses/margin/margin_report.hpp"

#include "montecarlo/analyses/margin/scaled_springs.hpp"

namespace wingspread {

MarginReport margin_report(const Campaign& campaign, const MarginResult& result) {
  MarginReport report{campaign, result, {}};
  for (const Campaign& each : result.campaigns)
    report.motorization.push_back({1, each, study_motorization(each, each.scene)});
  const MarginSearch* search = recommending(campaign, result);
  if (search && *search->recommended != 1) {
    const double scale = *search->recommended;
    for (const Campaign& each : result.campaigns)
      report.motorization.push_back(
          {scale, each,
           study_motorization(scaled(each, search->scaled, scale),
                              scaled(each.scene, search->scaled, scale))});
  }
  return report;
}

} // namespace wingspread
