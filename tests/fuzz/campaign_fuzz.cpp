/// Reads a campaign from any bytes. It is refused with reasons; or it can be described, keeps its hash when written and
/// read back, and makes draws and two runs of at most 20 steps.
#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace wingspread;

namespace {

/// Limits dispersions, runs and replicates, so that an input takes no seconds.
bool is_small(const Campaign& campaign) {
  return campaign.dispersions.size() <= 64 && campaign.scene.bodies.size() <= 32 &&
         (!has_replicates(campaign.sampling) || campaign.sampling.runs <= 100'000);
}

void run_some(Campaign& campaign) {
  campaign.integration.max_steps = 20;
  campaign.integration.t_end = std::min(campaign.integration.t_end, 1.0);
  const RunPlan plan(campaign);
  Runner runner(plan);
  for (const long k : {0L, campaign.sampling.runs - 1}) (void)runner.run(k);
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Campaign campaign;
  const std::string text(test::text_of(data, size));
  if (!test::takes([&] { campaign = read_campaign(text, "/nonexistent"); })) return 0;
  test::demand(!describe(campaign).empty(), "a campaign can be described");
  const Stamp stamp = stamp_of(campaign, {});
  const Campaign again = read_campaign(campaign_text(campaign, stamp), "/nonexistent");
  test::demand(stamp_of(again, {}) == stamp, "a stored campaign keeps its hash");
  if (is_small(campaign)) run_some(campaign);
  return 0;
}
