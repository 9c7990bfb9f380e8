/// The runs that break a requirement, by cause, and the runs that are worth a replay: the worst, and those with the
/// fewest latched hinges.
#pragma once

#include "montecarlo/results/summary/verdict.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace wingspread {

struct JudgedRun {
  long run = 0;
  double value = 0; ///< of the requirement's output; its magnitude where that is limited
};
struct LatchedRun {
  long run = 0;
  long latched = 0; ///< number of hinges that latched
};

/// Counts over all runs; the four add up to Verdict::failures().
struct BrokenRuns {
  long not_deployed = 0;
  long without_value = 0; ///< deployed, but the output did not happen
  long cut = 0;           ///< deployed, but t_end cut the peak
  long beyond = 0;        ///< deployed, with a value beyond the limit
  /// The worst value of the runs that deployed, whether or not it is beyond the limit; the first of equals.
  std::optional<JudgedRun> worst;
  std::vector<JudgedRun> beyond_runs;        ///< the worst first
  std::vector<LatchedRun> not_deployed_runs; ///< those with the fewest latched hinges first
};

/// @param most largest length of each list
/// @pre the verdict was decided from these rows
[[nodiscard]] BrokenRuns broken_runs(const Verdict& verdict, const Results& results,
                                     std::size_t most);

/// The runs of a status, those with the fewest latched hinges first, then by number; at most `most`.
[[nodiscard]] std::vector<LatchedRun> fewest_latched(const Results& results, Status status,
                                                     std::size_t most);

} // namespace wingspread
