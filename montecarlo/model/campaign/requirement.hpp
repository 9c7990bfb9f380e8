/// What a campaign has to show: "at least this share of all wings keeps to this limit".
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/static_margins/required_margin.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// The output that stands for the wing's deployment itself; has no limit.
inline constexpr std::string_view deployed_output = "deployed";

/// P(the run deploys, and its output keeps to the limit) ≥ probability, shown with confidence.
struct Requirement {
  std::string name;               ///< what a report calls it; may be empty
  std::string output;             ///< a column of the results, "deployed" or name_of(static_margin)
  std::optional<double> max, min; ///< one of them; none of "deployed"
  double probability = 0, confidence = 0; ///< each in (0, 1); the confidence is one-sided
  bool absolute = false;                  ///< "abs": the limit is on the output's magnitude
  /// Where the output is a static margin: nothing that a run records, but of its draw.
  std::optional<RequiredMargin> static_margin{};
  std::string group{}; ///< those of one group hold together at their confidence; empty: alone
};

/// What each requirement is to be shown at by itself, for its group to hold together at the confidence that all of it
/// states: 1 − (1 − c)/m of m members (Bonferroni). Its own confidence outside of groups.
[[nodiscard]] double confidence_alone(std::span<const Requirement> all,
                                      const Requirement& requirement);

/// By what a stopping rule knows it: its name or, of one without, its output.
[[nodiscard]] const std::string& name_of(const Requirement& requirement);

/// Reads an array of them, and notes what is wrong.
/// @param outputs the campaign's columns; nothing when they are not known, for a scene or a
///   list of outputs that is wrong itself: then no name is missed
/// @param all_outputs those that other families would add, for the message
/// @param scene       whose hinges static margins may be of; null: then no hinge is looked up
void read_requirements(const JsonCursor& at, const std::vector<std::string>* outputs,
                       std::span<const std::string> all_outputs,
                       std::vector<Requirement>& requirements, const Scene* scene = nullptr);

/// Notes each limit on a time that lies beyond the end of every run.
void refuse_late_limits(const JsonCursor& at, std::span<const Requirement> requirements,
                        double t_end);

[[nodiscard]] Json write_requirements(std::span<const Requirement> requirements);

/// "root.peak_moment ≤ 400 N·m, 99.73 % at 90 %", "NASA margin of root ≥ 0, 99 % at 90 %", after its name if it has one.
[[nodiscard]] std::string to_string(const Requirement& requirement);

} // namespace wingspread
