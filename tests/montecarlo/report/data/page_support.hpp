/// For the tests of the page's data: sets of invented rows, and sets of real runs.
#pragma once

#include "montecarlo/report/data/page_source.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <cmath>

namespace wingspread::test {

inline constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

inline Column column_of(std::string name, const std::vector<double>& values) {
  return {std::move(name), Spilled<double>(values)};
}

/// A set with the given rows of a campaign, as read_page_source would read it from a folder.
inline std::unique_ptr<PageSource> source_of(const Campaign& campaign, Results results) {
  auto source = std::make_unique<PageSource>();
  source->label = "set";
  source->stored = {"results/set", campaign, stamp_of(campaign, {})};
  source->made_from = source->analyzed_in = source->stored.folder;
  source->before_case = campaign;
  source->results = std::move(results);
  source->replication = replication_of(campaign.sampling, source->results);
  source->summary = stored_summary(source->stored, source->results, 1);
  source->confidence = campaign.statistics.confidence;
  source->orders = std::make_unique<OrderSplit>(source->results, campaign.scene);
  return source;
}

/// Makes a campaign's runs, and returns the set of them.
inline std::unique_ptr<PageSource> made(const Json& json) {
  const Campaign campaign = campaign_of(json);
  return source_of(campaign, rows_of(RunPlan(campaign), {0, campaign.sampling.runs}));
}

} // namespace wingspread::test
