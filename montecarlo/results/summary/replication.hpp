/// Which replicate of its design each row is from: what the bounds of draws that depend on each other
/// are judged by.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"

#include <string_view>
#include <vector>

namespace wingspread {

/// Which independent replicate of its design each row comes from: Latin hypercubes and scrambled
/// Sobol' points depend on each other within one. Independent draws have no replicates.
struct Replication {
  int replicates = 0;      ///< 0: all draws are independent
  std::vector<int> of_row; ///< per row of the results, in [0, replicates)
};

/// That of a campaign's rows. Only the replicates of which there are rows count: of the first runs, or
/// of a shard, it can be fewer.
[[nodiscard]] Replication replication_of(const Sampling& sampling, const Results& results);

/// Why there are no bounds where draws depend on each other and nothing tells how far.
inline constexpr std::string_view one_replicate =
    "no bounds: the draws of one replicate depend on each other; take two replicates or more";

} // namespace wingspread
