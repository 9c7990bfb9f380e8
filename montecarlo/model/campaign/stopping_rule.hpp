/// When a campaign has made runs enough: as soon as confidence intervals are narrow enough, or
/// requirements decided. Here is what is asked for; how far it is reached is found in
/// summary/stopping.hpp.
///
/// Goals are looked at only at checkpoints, fixed numbers of runs, and depend on nothing but the
/// rows up to there: where a campaign stops does not depend on threads or interruptions. Each of the
/// K looks is a chance to be misled, so every bound and verdict that such a campaign gives shares its
/// α out among them (at_each_of in bonferroni.hpp): it holds wherever the campaign stopped. That is
/// how runs may be made until a requirement is shown: one that failed, and is looked at again with
/// more runs of the same draws, passes by chance more often than it says.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wingspread {

/// How narrow one interval has to be:
/// that of a quantile of an output, or of the share of runs of a status.
struct WidthGoal {
  std::string output;             ///< a column of the results, or a status
  std::optional<double> quantile; ///< in (0, 1); none of a status
  double width = 0;               ///< upper less lower bound, > 0; in the output's unit, or …
  bool relative = false;          ///< … as a share of the quantile's magnitude
};

/// A requirement that has to be decided: passed or disproved.
struct DecisionGoal {
  std::string requirement; ///< by name (name_of()); if several have it, all of them
};

using StoppingGoal = std::variant<WidthGoal, DecisionGoal>;

/// All of them have to be met; none: the campaign makes all of its runs.
using StoppingRule = std::vector<StoppingGoal>;

/// Reads an array of goals, and notes what is wrong.
/// @param outputs the campaign's columns; nothing when they are not known, for a scene or a
///   list of outputs that is wrong itself: then no name is missed
/// @param requirements the names of the campaign's requirements; nothing as above
void read_stopping_rule(const JsonCursor& at, const std::vector<std::string>* outputs,
                        const std::vector<std::string>* requirements, StoppingRule& rule);

[[nodiscard]] Json write_stopping_rule(const StoppingRule& rule);

/// "root.peak_moment@0.99 5", "root.peak_moment@0.99 2%", "deployed 0.01" or "requirement deployed":
/// the goal as a campaign has it; nothing when the text is none of those.
[[nodiscard]] std::optional<Json> parse_stopping_goal(std::string_view text);
[[nodiscard]] std::string to_string(const StoppingGoal& goal);

/// The first checkpoint beyond so many runs, of a campaign of at most `runs`: 1000, 2000, 4000, …,
/// and `runs` itself.
[[nodiscard]] long next_checkpoint(long done, long runs);
/// How many checkpoints there are; 1 without a rule.
[[nodiscard]] long count_looks(const StoppingRule& rule, long runs);
[[nodiscard]] bool is_checkpoint(long done, long runs);

} // namespace wingspread
