#include "montecarlo/report/data/page_source.hpp"

#include <utility>

namespace wingspread {

std::unique_ptr<PageSource> read_page_source(StoredCampaign stored, const std::string& label,
                                             const Campaign* before_case, int threads) {
  auto source = std::make_unique<PageSource>();
  source->label = label;
  source->before_case = before_case ? *before_case : stored.campaign;
  source->stored = std::move(stored);
  source->made_from = source->stored.folder;
  const Campaign& campaign = source->stored.campaign;
  source->results = std::move(read_stored_results(source->stored).results);
  source->replication = replication_of(campaign.sampling, source->results);
  source->summary = stored_summary(source->stored, source->results, campaign.statistics, threads);
  source->confidence = source->summary.interim.confidence_of_bound(campaign.statistics.confidence);
  source->orders = std::make_unique<OrderSplit>(source->results, source->summary, campaign.scene);
  return source;
}

} // namespace wingspread
