/// Verdicts: do the runs show what a requirement asks? Every verdict, from rows and from streaming statistics, is
/// decided in decide().
///
/// A run breaks a requirement if it did not deploy, if the output did not happen, or if its value is beyond the limit.
/// A run that stalled, timed out, failed or was invalid is "worse than any number": for a `max` it ranks above every
/// value, for a `min` below. Leaving such runs out would make the result look better than it is. A run whose peak was
/// cut by t_end (finality.hpp) breaks a `max` on that peak too, because the peak might have risen. It disproves
/// none, unless its value is beyond the limit already: where the cut peaks alone stand against a pass, the verdict is
/// `undecided`, and a longer t_end decides it, if any does. The peak is at least its value so far: from there on it
/// meets a `min`, and below it breaks one, but may still rise and disproves nothing.
///
/// Symbols as in wilks.hpp: n runs, k of them break the requirement P ≥ p at confidence c.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/interim_analyses.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/model/campaign/requirement.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace wingspread {

enum class Decision {
  pass,     ///< the runs show P ≥ p
  fail,     ///< they do not, though n runs are enough to show it; or they disprove it
  undecided ///< n runs are too few to show it, or t_end cut their peaks; and they do not disprove it
};
[[nodiscard]] std::string_view to_string(Decision decision);

struct Verdict {
  Requirement requirement;
  Decision decision = Decision::undecided;
  long runs = 0;               ///< n
  double confidence_alone = 0; ///< for one analysis: c, or more if a group shares c
  /// The confidence used for the decision: confidence_alone, or more if several interim analyses share the risk.
  double confidence = 0;
  InterimAnalyses interim{}; ///< that share the risk
  std::optional<PassingRule::Joint>
      joint{};                 ///< after an extension: the risk of all analyses together
  std::optional<long> allowed; ///< most runs that may break it; nothing if n runs are too few
  /// Runs that break it among those of each analysis in interim.before; and without those that are `open`.
  std::vector<long> failed_before{}, surely_before{};
  Spilled<long> broken; ///< runs that break it, the worst first
  long not_listed = 0;  ///< runs that break it and are not in `broken`: with --no-rows
  std::optional<long>
      least_runs; ///< fewest runs that could show it, if none broke it; none where only earlier
                  ///< analyses stand against it
  bool disproved = false; ///< P < p is shown at the same confidence
  bool one_run = false;   ///< all runs are the same run and show no probability
  bool of_part = false;   ///< of a shard, a preview or an unfinished folder, which are not judged
  long cut = 0;           ///< deployed runs that break it because t_end cut their peak
  long open = 0; ///< those among them that may meet it: whose cut peak is not above a `max`
  std::string_view never_final{}; ///< why no t_end proves peaks final (explain_cuts)
  long absent = 0; ///< runs that break a limit because they did not deploy or lack the output
  /// Least and largest value, if the limit lies on the other side of zero from all values; not of static
  /// margins.
  std::optional<std::array<double, 2>> beyond_zero{};
  double share = 0;            ///< share of the runs that meet it; NaN without runs
  double guaranteed_share = 0; ///< one-sided Clopper–Pearson bound of P
  /// Values of the output at a rank over all runs. Nothing if a run worse than any number is at that rank, and for
  /// "deployed".
  std::optional<double> observed;   ///< the p quantile, counted from the side opposite to the limit
  std::optional<double> guaranteed; ///< one-sided tolerance limit of order allowed + 1
  /// Distance from the guaranteed value to the limit, in the output's unit; for "deployed" the guaranteed share less p.
  /// At least 0 if and only if the requirement passes.
  std::optional<double> margin;

  /// Number of runs that break it.
  [[nodiscard]] long failures() const { return static_cast<long>(broken.size()) + not_listed; }
};

/// A run breaks a requirement if sign_of · value > limit_of: sign −1 for a `min`, whose limit is negated too.
[[nodiscard]] double sign_of(const Requirement& requirement);
[[nodiscard]] double limit_of(const Requirement& requirement);

/// Whether a run whose peak t_end cut at this value may meet the requirement: the peak is at least the value.
[[nodiscard]] bool may_meet(const Requirement& requirement, double cut_peak);

/// Decides a verdict: sets everything except the values of the output.
/// @param confidence at which the requirement would be judged in a single analysis
/// @param interim    the interim analyses that share the risk
/// @pre requirement, runs, broken, not_listed, cut, open and the failures before are set
void decide(double confidence, const InterimAnalyses& interim, Verdict& verdict);

/// Least and largest value, if the limit lies on the other side of zero from both; nothing for a static margin.
[[nodiscard]] std::optional<std::array<double, 2>> beyond_zero(double least, double largest,
                                                               const Requirement& requirement);

/// An output's values over all runs, sorted once for all its requirements. A run that did not deploy or has no value
/// is worse than any number, at either end.
class RankedOutput {
public:
  /// Cost O(n log n), and 8 bytes per run; 16 for a run worse than any number; 16 for each run if t_end cut a peak.
  /// @param absolute use magnitudes
  RankedOutput(const Results& results, const Column& output, bool absolute = false);

  /// The numbers, smallest first.
  [[nodiscard]] std::span<const double> numbers() const {
    return std::span(values_).subspan(worse_, values_.size() - 2 * worse_);
  }

  /// Number of runs worse than any number for a limit on that side; cut peaks are for an upper or two-sided one.
  [[nodiscard]] long beyond(Side side = Side::upper) const {
    return static_cast<long>(side == Side::lower ? worse_ - cut_ : worse_);
  }

  /// Smallest first, with +∞ at the end for runs worse than any number.
  [[nodiscard]] std::span<const double> worst_above() const {
    return std::span(values_).subspan(worse_);
  }
  /// Smallest first, with −∞ at the beginning for runs worse than any number; a cut peak has its value, its least.
  [[nodiscard]] std::span<const double> worst_below() const {
    if (!below_.empty()) return below_;
    return std::span(values_).first(values_.size() - worse_);
  }

private:
  std::vector<double> values_; ///< −∞, the numbers, +∞
  std::vector<double> below_;  ///< with cut peaks at their values; empty without any
  std::size_t worse_ = 0;      ///< runs worse than any number from above
  std::size_t cut_ = 0;        ///< cut peaks among them
};

/// Judges one requirement.
/// @param interim the interim analyses that share the risk
/// @pre draws of runs are independent; the results have the output
[[nodiscard]] Verdict judge(const Requirement& requirement, const Results& results,
                            const InterimAnalyses& interim = {});

/// Verdicts on all requirements; those of a group share a confidence. Sorts every output once.
/// @param besides columns that are not in the results: static margins
[[nodiscard]] std::vector<Verdict> judge_all(std::span<const Requirement> requirements,
                                             const Results& results,
                                             const InterimAnalyses& interim = {},
                                             std::span<const Column> besides = {});

/// Whether the requirement would pass if the cut peaks did not break it.
[[nodiscard]] bool rests_on_cut_peaks(const Verdict& verdict);

/// Whether the requirement is passed or disproved, so that more runs need not be made for it.
[[nodiscard]] bool is_decided(const Verdict& verdict);

/// A lower bound of the confidence with which all passed requirements hold together. Failed requirements count too,
/// because each requirement might have passed falsely.
[[nodiscard]] double joint_confidence(std::span<const Verdict> verdicts);

/// A group of requirements, and whether they hold together.
struct GroupVerdict {
  std::string name;
  double confidence = 0; ///< of all of them together
  long members = 0, passed = 0;
  Decision decision = Decision::undecided; ///< pass: all do; fail: one fails
};
/// In order of first mention.
[[nodiscard]] std::vector<GroupVerdict> judge_groups(std::span<const Verdict> verdicts);

/// The observed share of runs that meet it, or the observed value of the output.
[[nodiscard]] std::string observed_text(const Verdict& verdict);
/// The guaranteed share or value, rounded to the side on which it is still guaranteed, with as many digits as show
/// whether it keeps to the limit.
[[nodiscard]] std::string guaranteed_text(const Verdict& verdict);

/// The reason for the verdict: "25 of 10000 runs break it; at most 19 may".
[[nodiscard]] std::string evidence(const Verdict& verdict);

/// "wingspread replay DIR --run 17", ready for a shell.
[[nodiscard]] std::string replay_command(std::string_view folder, long run);

/// Tolerance limits of an output over all runs. Runs that did not deploy or have no value rank above every number for an
/// upper and a two-sided limit, below for a lower one; those with a peak that t_end cut above for the first two. So a requirement passes if and
/// only if the limit of its probability and confidence keeps within its own.
/// @pre as for judge
[[nodiscard]] Bounds output_limits(const RankedOutput& output, const ToleranceLimitSpec& spec,
                                   const InterimAnalyses& interim = {});

} // namespace wingspread
