/// A results folder, read and worked out for the page.
#pragma once

#include "montecarlo/report/data/order_split.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <memory>
#include <optional>
#include <string>

namespace wingspread {

/// One set of runs: of a folder, or of one case of it.
struct PageSource {
  std::string label;
  StoredCampaign stored;
  /// The whole campaign before its case changed it; the set's own where it is of no case.
  Campaign before_case;
  Results results;
  Replication replication;
  Summary summary;
  double confidence = 0; ///< of each bound, where several looks share it
  std::unique_ptr<OrderSplit> orders;

  /// Whether runs of it can be made again.
  [[nodiscard]] bool replayable() const { return !stored.foreign && results.size() > 0; }
};

/// Reads a folder and works out its statistics.
/// @param threads as of thread_count (team.hpp)
/// @throws SpecError as read_stored_results does
[[nodiscard]] std::unique_ptr<PageSource> read_page_source(StoredCampaign stored,
                                                           const std::string& label,
                                                           const Campaign* before_case,
                                                           int threads);

} // namespace wingspread
