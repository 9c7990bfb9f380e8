/// The design replicate of each row. Bounds for dependent draws are computed from replicates.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"

#include <string_view>
#include <vector>

namespace wingspread {

/// Independent replicates of a design: points of a Latin hypercube or of scrambled Sobol' points depend on each other
/// within a replicate. Independent draws have no replicates.
struct Replication {
  int replicates = 0;      ///< 0: draws are independent
  std::vector<int> of_row; ///< per row of the results, in [0, replicates)
};

/// The replicates of a campaign's rows. Replicates without rows do not count: a shard may lack some.
[[nodiscard]] Replication replication_of(const Sampling& sampling, const Results& results);

/// Why there are no bounds for a single replicate.
inline constexpr std::string_view one_replicate =
    "no bounds: the draws of one replicate depend on each other; take two replicates or more";

} // namespace wingspread
