/// The cost of runs, estimated from one nominal run and the draws of a few.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Cost and outcome of nominal runs.
struct NominalRuns {
  std::string cost; ///< "the nominal run takes 1240 evaluations, 3 ms"
  /// One for each nominal wing that does not deploy: "the nominal wing of case cold does not deploy: stalled (…)"; or whose
  /// run was given up.
  std::vector<std::string> notes;
  double seconds = 0;    ///< processor time: nominal run of the first case, draws of one run
  bool at_least = false; ///< that run was given up: it takes longer
};

/// The time of so many runs like the nominal one on this machine's threads: "about 40 s", or "more than 40 s".
[[nodiscard]] std::string time_of_runs(const NominalRuns& nominal, long runs);

/// Runs the scene once and measures the run; gives up after 50,000 trial steps.
[[nodiscard]] NominalRuns try_nominal(const Scene& scene, const Integration& integration);

/// Runs the nominal wing of every case. The cost is that of all runs on this machine's threads, estimated from the
/// first case: an upper estimate, because runs in packs are cheaper. The time of files and statistics is not in it.
[[nodiscard]] NominalRuns try_nominal(const Campaign& campaign);

} // namespace wingspread
