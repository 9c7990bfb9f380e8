// Outputs that have no value in the pilot, so that nothing is known of where their values lie.
#include "montecarlo/results/streaming/streaming_summary.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("an output without a value in the pilot has the moments of its values, or says nothing",
          "[streaming]") {
  const long values = GENERATE(100L, 4096L, 4097L);
  const Campaign campaign = campaign_of(quick_campaign(20'000));
  const RunPlan plan(campaign);
  const ResultNames& names = plan.names();
  ResultRow row;
  row.status = Status::deployed;
  row.draws.assign(names.draws.size(), 1);
  row.outputs.assign(names.outputs.size(), undefined);
  Results pilot(names);
  for (row.run = 0; row.run < 100; ++row.run) pilot.append(row);
  StreamingStatistics statistics(campaign, names, pilot);
  std::mt19937_64 random(7);
  std::normal_distribution<double> small(2.15, 1e-9), wide(2.15, 0.5);
  std::vector<double> all, wider;
  for (row.run = 0; row.run < values; ++row.run) {
    all.push_back(row.outputs[0] = small(random));
    wider.push_back(row.outputs[1] = wide(random));
    (void)statistics.add(row, {});
  }
  const StoredCampaign stored{{}, campaign, stamp_of(campaign, Shard{1, 2})};
  const Summary summary = streaming_summary(stored, statistics, campaign.statistics);
  const Moments found = summary.outputs[0].moments, expected = moments(all);
  CHECK(found.count == values);
  CHECK(found.mean == Approx(expected.mean).epsilon(1e-14));
  if (values <= 4096) {
    CHECK(found.std == Approx(expected.std).epsilon(1e-12));
    CHECK(found.skewness == Approx(expected.skewness).epsilon(1e-12).margin(1e-12));
    CHECK(found.kurtosis == Approx(expected.kurtosis).epsilon(1e-12).margin(1e-12));
  } else {
    CHECK((std::isnan(found.std) && std::isnan(found.skewness) && std::isnan(found.kurtosis)));
  }
  CHECK(summary.outputs[1].moments.std == Approx(moments(wider).std).epsilon(1e-12));
}
