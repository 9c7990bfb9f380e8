/// The campaign's key `until`: stop as soon as confidence intervals are narrow enough or requirements are decided.
/// results/summary/stopping.hpp evaluates the goals.
///
/// Goals are evaluated only at interim analyses, after fixed numbers of runs, from the rows up to there: where a
/// campaign stops does not depend on threads or interruptions. Each of the K analyses may err, so every bound and
/// verdict uses α/K (at_each_of in bonferroni.hpp) and holds wherever the campaign stops. Adding runs to a failed
/// campaign without this correction would inflate the risk of a false pass.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wingspread {

/// A goal for the width of a confidence interval: of an output's quantile, or of a share of runs.
struct WidthGoal {
  std::string output;             ///< a column of the results, or a status
  std::optional<double> quantile; ///< in (0, 1); nothing for a share of runs
  double width = 0;               ///< upper less lower bound, > 0, in the output's unit
  bool relative = false;          ///< the width is a share of the quantile's magnitude
};

/// A goal for a requirement: passed or disproved.
struct DecisionGoal {
  std::string requirement; ///< as name_of() gives it; all requirements with this name
};

using StoppingGoal = std::variant<WidthGoal, DecisionGoal>;

/// All goals have to be met. Without goals the campaign makes all runs.
using StoppingRule = std::vector<StoppingGoal>;

/// Whether the name means a share of runs: a status, or an output that is 1 or 0 (HINGE.held).
[[nodiscard]] bool is_share(std::string_view output);

/// Reads an array of goals and notes problems.
/// @param outputs      the campaign's columns; null if scene or outputs have problems: then names are not looked up
/// @param requirements the requirements' names; null if they have problems
void read_stopping_rule(const JsonCursor& at, const std::vector<std::string>* outputs,
                        const std::vector<std::string>* requirements, StoppingRule& rule);

[[nodiscard]] Json write_stopping_rule(const StoppingRule& rule);

/// Parses "root.peak_moment@0.99 5", "root.peak_moment@0.99 5 N*m", "root.peak_moment@0.99 2%", "deployed 0.01",
/// "deployed 1 %" (the same) or "requirement deployed" into the goal's JSON; nothing for other text.
[[nodiscard]] std::optional<Json> parse_stopping_goal(std::string_view text);
[[nodiscard]] std::string to_string(const StoppingGoal& goal);

/// The number of runs at the first interim analysis after `done` of `runs`. They are at 1000, 2000, 4000, … and `runs`.
[[nodiscard]] long next_interim_analysis(long done, long runs);
/// The number of interim analyses, the last included; 1 without a rule.
[[nodiscard]] long count_interim_analyses(const StoppingRule& rule, long runs);
[[nodiscard]] bool is_interim_analysis(long done, long runs);

} // namespace wingspread
