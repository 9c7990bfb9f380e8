#include "montecarlo/report/page/static_margins_json.hpp"

#include "montecarlo/analyses/margin/motorization_study.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <algorithm>

namespace wingspread {
namespace {

MarginKind kind_of(const Campaign& campaign) {
  for (const Requirement& requirement : campaign.requirements)
    if (requirement.static_margin) return requirement.static_margin->kind;
  return MarginKind::nasa;
}

/// The lowest quantile that the campaign asks for; NaN without any.
double lowest(const MarginSpread& spread, const std::vector<double>& probabilities) {
  if (spread.quantiles.empty()) return undefined;
  const auto least = std::ranges::min_element(probabilities) - probabilities.begin();
  return spread.quantiles[static_cast<std::size_t>(least)];
}

Json drive_json(const Campaign& campaign, const DriveMotorization& drive, std::size_t kind) {
  const std::vector<double>& probabilities = campaign.statistics.quantiles;
  Json json{{"hinge", name_of(drive.drive, campaign.scene)},
            {"angle", Json::array()},
            {"margin", Json::array()},
            {"margin_lower", Json::array()},
            {"required", 0}};
  for (const TravelPoint& point : drive.travel) {
    json["angle"].push_back(page_number(point.angle));
    json["margin"].push_back(page_number(point.margins[kind], 5));
    json["margin_lower"].push_back(page_number(lowest(point.spread[kind], probabilities), 5));
  }
  json["least"] = page_number(drive.worst[kind], 5);
  json["lower"] = page_number(lowest(drive.worst_spread[kind], probabilities), 5);
  return json;
}

} // namespace

Json static_margins_json(const Campaign& campaign) {
  constexpr std::int64_t most_margin_draws = 1000;
  Campaign some = campaign;
  if (!has_replicates(some.sampling)) // of a design the draws depend on their number
    some.sampling.runs = std::min(some.sampling.runs, most_margin_draws);
  const MotorizationStudy study = study_motorization(some, campaign.scene);
  if (study.drives.empty()) return nullptr;
  const auto kind = static_cast<std::size_t>(kind_of(campaign));
  const auto& probabilities = campaign.statistics.quantiles;
  Json json{
      {"kind", margin_kind_texts[kind]},
      {"draws", study.draws},
      {"lower_p", probabilities.empty() ? Json(nullptr) : Json(std::ranges::min(probabilities))},
      {"hinges", Json::array()}};
  for (const DriveMotorization& drive : study.drives)
    json["hinges"].push_back(drive_json(campaign, drive, kind));
  return json;
}

} // namespace wingspread
