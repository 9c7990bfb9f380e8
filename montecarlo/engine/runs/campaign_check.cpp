#include "montecarlo/engine/runs/campaign_check.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"

namespace wingspread {

std::vector<InputWarning> check_campaign(const Campaign& campaign,
                                         const std::filesystem::path& file) {
  const auto draw = [](const Campaign& of_case, long runs,
                       const std::function<void(const Scene&)>& use) {
    const RunPlan plan(of_case);
    std::vector<double> values(of_case.dispersions.size());
    Scene scene = of_case.scene;
    for (long run = 0; run < runs; ++run) {
      plan.draw(run, values);
      apply(of_case, values, of_case.scene, scene);
      use(scene);
    }
  };
  return check_input(campaign, file, draw);
}

} // namespace wingspread
