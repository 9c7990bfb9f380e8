/// Whether the runs show what is required of them, and on what evidence.
///
/// A run breaks a requirement when it did not deploy, when the output did not happen in it, or when
/// its value is beyond the limit. So a run that stalled, timed out, failed or whose draw was
/// unphysical ranks above every finite value of a `max` and below every one of a `min`: leaving it
/// out would flatter the result. A peak that t_end cut is as bad, whatever it had come to: it may still rise.
///
/// Symbols as in wilks.hpp: n runs, k of them break the requirement P ≥ p at confidence c.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/model/campaign/requirement.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

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
  long runs = 0;               ///< n
  double confidence_alone = 0; ///< c, or more where a group shares it
  double confidence =
      0; ///< what has to be shown at: the same, or more when there were several looks
  std::optional<long> allowed;    ///< most runs that may break it; nothing when n decides nothing
  Spilled<long> broken;           ///< numbers of the runs that do, the worst first
  long not_listed = 0;            ///< runs that do and are not among those: where rows are not kept
  std::optional<long> least_runs; ///< that could show it, if none broke it
  bool disproved = false;         ///< P < p is shown, at the same confidence
  long cut = 0;                   ///< of those that break it, deployed runs whose peak t_end cut
  /// The least and the largest value there is, where the limit lies on the other side of zero from all of them.
  std::optional<std::array<double, 2>> beyond_zero{};
  double share = 0;            ///< of the runs that keep to it; NaN without runs
  double guaranteed_share = 0; ///< the one-sided Clopper–Pearson bound of P
  /// Of the output, counting runs that break it as worse than any number; nothing where the value
  /// would be one of those, and of "deployed".
  std::optional<double> observed;   ///< the p quantile, from the side of the limit
  std::optional<double> guaranteed; ///< the one-sided tolerance limit, order allowed + 1
  /// From the guaranteed value to the limit, in the output's unit; of "deployed", from p to the
  /// guaranteed share. At least 0 for a pass, and for no other.
  std::optional<double> margin;

  /// How many runs break it.
  [[nodiscard]] long failures() const { return static_cast<long>(broken.size()) + not_listed; }
};

/// A run breaks a requirement if sign_of · value > limit_of: sign −1 for a `min`, whose limit is negated too.
[[nodiscard]] double sign_of(const Requirement& requirement);
[[nodiscard]] double limit_of(const Requirement& requirement);

/// Concludes from the runs that break it: all of a verdict but what is said of values.
/// @param confidence to be shown at by itself, were there one look
/// @pre requirement, runs, broken, not_listed and cut are known
void conclude(double confidence, long looks, Verdict& verdict);

/// The ends of the values, where the limit lies on the other side of zero from all of them.
[[nodiscard]] std::optional<std::array<double, 2>> beyond_zero(double least, double largest,
                                                               const Requirement& requirement);

/// An output's values over all runs, sorted once for all that is required of it. A run that did not deploy, and
/// one without a value, is worse than any number: at whichever end is the wrong one.
class RankedOutput {
public:
  /// Cost O(n log n), and 8 bytes a run; 16 for one that is worse than any number.
  /// @param absolute of magnitudes
  RankedOutput(const Results& results, const Column& output, bool absolute = false);

  /// Those that are numbers, smallest first.
  [[nodiscard]] std::span<const double> numbers() const {
    return std::span(values_).subspan(worse_, values_.size() - 2 * worse_);
  }

  /// Smallest first, with +∞ for what is worse than any number.
  [[nodiscard]] std::span<const double> worst_above() const {
    return std::span(values_).subspan(worse_);
  }
  /// The same with −∞, at the beginning.
  [[nodiscard]] std::span<const double> worst_below() const {
    return std::span(values_).first(values_.size() - worse_);
  }

private:
  std::vector<double> values_; ///< −∞, the numbers, +∞
  std::size_t worse_ = 0;      ///< how many runs are worse than any number
};

/// @param looks at how many numbers of runs the campaign could have stopped (stopping_rule.hpp)
/// @pre the draws of the runs are independent; the results have the output
[[nodiscard]] Verdict judge(const Requirement& requirement, const Results& results, long looks = 1);

/// Of each of the requirements; those of a group share a confidence. Every output is sorted once, however many there are on it.
/// @param besides columns that requirements are on and the results do not have: what is worked out of the draws
[[nodiscard]] std::vector<Verdict> judge_all(std::span<const Requirement> requirements,
                                             const Results& results, long looks = 1,
                                             std::span<const Column> besides = {});

/// Whether the runs have decided it: passed or disproved.
[[nodiscard]] bool is_decided(const Verdict& verdict);

/// At least the confidence with which whatever passes holds together, each verdict holding for itself:
/// every requirement had its chance of a false pass, those too that did not take it.
[[nodiscard]] double joint_confidence(std::span<const Verdict> verdicts);

/// The requirements of a group, and whether they hold together.
struct GroupVerdict {
  std::string name;
  double confidence = 0; ///< of all of them together
  long members = 0, passed = 0;
  Decision decision = Decision::undecided; ///< pass: all do; fail: one fails
};
/// In order of their first mention.
[[nodiscard]] std::vector<GroupVerdict> judge_groups(std::span<const Verdict> verdicts);

/// Why it came out so: "25 of 10000 runs break it, and 19 may".
[[nodiscard]] std::string evidence(const Verdict& verdict);

/// "wingspread replay DIR --run 17".
[[nodiscard]] std::string replay_command(std::string_view folder, long run);

/// Tolerance limits of an output over all runs. Those that did not deploy, and those without a
/// value, rank above every number for an upper limit and two-sided ones, below for a lower one.
/// @pre as for judge
[[nodiscard]] Bounds output_limits(const RankedOutput& output, const ToleranceLimitSpec& spec,
                                   long looks = 1);

} // namespace wingspread
