#include "montecarlo/margin/margin_report.hpp"

#include "montecarlo/margin/scaled_springs.hpp"

namespace wingspread {

MarginReport margin_report(const Campaign& campaign, const MarginResult& result) {
  MarginReport report{campaign, result, {{1, study_motorization(campaign, campaign.scene)}}};
  const MarginSearch* search = recommending(campaign, result);
  if (search && *search->recommended != 1) {
    const double scale = *search->recommended;
    report.motorization.push_back(
        {scale, study_motorization(scaled(campaign, search->scaled, scale),
                                   scaled(campaign.scene, search->scaled, scale))});
  }
  return report;
}

} // namespace wingspread
