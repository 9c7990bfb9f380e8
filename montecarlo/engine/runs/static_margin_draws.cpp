#include "montecarlo/engine/runs/static_margin_draws.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"

#include <vector>

namespace wingspread {

StaticMarginStudy study_static_margins(const Campaign& campaign) {
  const RunPlan plan(campaign);
  std::vector<double> values(campaign.dispersions.size());
  Scene scene = campaign.scene;
  const auto visit = [&](const DrawnScenes::Use& use) {
    long invalid = 0;
    for (long run = 0; run < campaign.sampling.runs; ++run) {
      plan.draw(run, values);
      apply(campaign, values, campaign.scene, scene);
      if (unphysical(scene).empty())
        use(run, scene);
      else
        ++invalid;
    }
    return invalid;
  };
  const auto values_of = [&](long run) {
    Json json = Json::object();
    plan.draw(run, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      json[campaign.dispersions[i].name] = json_number(values[i]);
    return json;
  };
  return study_static_margins(nominal_scene(campaign), campaign.motorization,
                              {campaign.sampling.runs, visit, values_of},
                              campaign.statistics.quantiles);
}

} // namespace wingspread
