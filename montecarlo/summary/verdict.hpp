/// Whether the runs show what is required of them, and on what evidence.
///
/// A run breaks a requirement when it did not deploy, when the output did not happen in it, or when
/// its value is beyond the limit. So a run that stalled, timed out, failed or whose draw was
/// unphysical ranks above every finite value of a `max` and below every one of a `min`: leaving it
/// out would flatter the result.
///
/// Symbols as in wilks.hpp: n runs, k of them break the requirement P ≥ p at confidence c.
#pragma once

#include "montecarlo/campaign/campaign_settings.hpp"
#include "montecarlo/campaign/requirement.hpp"
#include "montecarlo/runs/results.hpp"
#include "montecarlo/statistics/wilks.hpp"

#include <span>

namespace wingspread {

enum class Decision {
  pass,     ///< shown
  fail,     ///< not shown, though n runs could have shown it
  undecided ///< n runs are too few to show it whatever comes of them, and do not disprove it
};
[[nodiscard]] std::string_view to_string(Decision decision);

struct Verdict {
  Requirement requirement;
  Decision decision = Decision::undecided;
  long runs = 0;         ///< n
  double confidence = 0; ///< what has to be shown at: c, or more when there were several looks
  std::optional<long> allowed;    ///< most runs that may break it; nothing when n decides nothing
  Spilled<long> broken;           ///< numbers of the runs that do, the worst first
  std::optional<long> least_runs; ///< that could show it, if none broke it
  bool disproved = false;         ///< P < p is shown, at the same confidence
  double share = 0;               ///< of the runs that keep to it; NaN without runs
  double guaranteed_share = 0;    ///< the one-sided Clopper–Pearson bound of P
  /// Of the output, counting runs that break it as worse than any number; nothing where the value
  /// would be one of those, and of "deployed".
  std::optional<double> observed;   ///< the p quantile, from the side of the limit
  std::optional<double> guaranteed; ///< the one-sided tolerance limit, order allowed + 1
  /// From the guaranteed value to the limit, in the output's unit; of "deployed", from p to the
  /// guaranteed share. At least 0 for a pass, and for no other.
  std::optional<double> margin;
};

/// @param looks at how many numbers of runs the campaign could have stopped (stopping_rule.hpp)
/// @pre the draws of the runs are independent; the results have the output
[[nodiscard]] Verdict judge(const Requirement& requirement, const Results& results, long looks = 1);

/// Whether the runs have decided it: passed or disproved.
[[nodiscard]] bool is_decided(const Verdict& verdict);

/// At least the confidence with which whatever passes holds together, each verdict holding for itself:
/// every requirement had its chance of a false pass, those too that did not take it.
[[nodiscard]] double joint_confidence(std::span<const Verdict> verdicts);

/// Why it came out so: "25 of 10000 runs break it, and 19 may".
[[nodiscard]] std::string evidence(const Verdict& verdict);

/// "wingspread replay DIR --run 17".
[[nodiscard]] std::string replay_command(std::string_view folder, long run);

/// Tolerance limits of an output over all runs. Those that did not deploy, and those without a
/// value, rank above every number for an upper limit and two-sided ones, below for a lower one.
/// @pre as for judge
[[nodiscard]] Bounds output_limits(const Results& results, const Column& output,
                                   const ToleranceLimitSpec& spec, long looks = 1);

} // namespace wingspread
