#include "montecarlo/report/page/static_margins_json.hpp"

#include "montecarlo/engine/runs/static_margin_draws.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"

#include <algorithm>

namespace wingspread {

Json static_margins_json(const Campaign& campaign) {
  constexpr std::int64_t most_margin_draws = 1000;
  Campaign some = campaign;
  if (!has_replicates(some.sampling)) // the draws of a design depend on their number
    some.sampling.runs = std::min(some.sampling.runs, most_margin_draws);
  const auto required = std::ranges::find_if(campaign.requirements, [](const Requirement& each) {
    return each.static_margin.has_value();
  });
  const MarginKind kind =
      required == campaign.requirements.end() ? MarginKind::nasa : required->static_margin->kind;
  return static_margin_curves(study_static_margins(some, campaign.scene), kind,
                              campaign.statistics.quantiles);
}

} // namespace wingspread
