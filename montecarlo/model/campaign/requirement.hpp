/// The campaign's key `requirements`: at least a share of all wings has to keep to a limit.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/static_margins/required_margin.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// The output for the wing's deployment itself; it has no limit.
inline constexpr std::string_view deployed_output = "deployed";

/// P(the run deploys and its output keeps to the limit) ≥ probability, to be shown with the confidence.
struct Requirement {
  std::string name;               ///< for reports; may be empty
  std::string output;             ///< a column of the results, "deployed" or name_of(static_margin)
  std::optional<double> max, min; ///< exactly one; none for "deployed"
  double probability = 0, confidence = 0; ///< each in (0, 1); the confidence is one-sided
  bool absolute = false;                  ///< "abs": limits the output's magnitude
  /// Present if the output is a static margin, which is computed from a run's draws.
  std::optional<RequiredMargin> static_margin{};
  std::string group{}; ///< requirements of a group hold jointly at their confidence; empty: none
  // for the report's reader; each may be empty
  std::string id{};        ///< of the document that states it, e.g. "SYS-0421"
  std::string source{};    ///< that document
  std::string rationale{}; ///< why it is required
};

/// The confidence at which a requirement is judged: 1 − (1 − c)/m in a group of m members (Bonferroni), so that the
/// group holds jointly at c; else c.
[[nodiscard]] double confidence_alone(std::span<const Requirement> all,
                                      const Requirement& requirement);

/// The name for stopping rules: the requirement's name, or its output if it has none.
[[nodiscard]] const std::string& name_of(const Requirement& requirement);

/// Where a run without the output ranks in all quantiles of the output: at the end that breaks its requirements. Above
/// every value without a requirement and for a `max`; below every value for a `min`; either where requirements
/// limit the output on both sides, as a `min` and a `max` do, or `abs` of an output that has a sign.
[[nodiscard]] MissingRank missing_rank(std::span<const Requirement> requirements,
                                       const std::string& output);

/// Whether requirements may have verdicts, as those of a summary.json have.
enum class Judged { no, may_be };

/// Reads an array of requirements and notes problems.
/// @param outputs     the campaign's columns; null if scene or outputs have problems: then names are not looked up
/// @param all_outputs the columns of all families, for the message
/// @param scene       for the hinges of static margins; null: hinges are not looked up
/// @param judged      may_be: of a requirement with a "verdict", unknown keys are results, and are passed over
void read_requirements(const JsonCursor& at, const std::vector<std::string>* outputs,
                       std::span<const std::string> all_outputs,
                       std::vector<Requirement>& requirements, const Scene* scene = nullptr,
                       Judged judged = Judged::no);

/// Whether a limit of the output is a time that no run reaches: what has not latched by t_end has no time.
[[nodiscard]] bool is_late_limit(const std::string& output, double limit, double t_end);

/// Notes each limit on a time beyond t_end.
void refuse_late_limits(const JsonCursor& at, std::span<const Requirement> requirements,
                        double t_end);

[[nodiscard]] Json write_requirements(std::span<const Requirement> requirements);

/// "root.peak_moment ≤ 400 N·m, 99.73 % at 90 %"; with a name, "NAME: …".
[[nodiscard]] std::string to_string(const Requirement& requirement);

/// A value of the output, in SI, in the unit in which to_string states the limit: a rate in deg/s beside "≤ 60 deg/s".
[[nodiscard]] double in_unit_of_limit(const Requirement& requirement, double value);
/// That unit: "deg" where the limit is written in degrees, though the output is in radians; may be empty.
[[nodiscard]] std::string unit_of_limit(const Requirement& requirement);

} // namespace wingspread
