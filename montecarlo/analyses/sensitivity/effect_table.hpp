/// Shared parts of both analyses' reports: effects of dispersions with bounds, in JSON and in tables.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The width of a dispersion's name in a table.
inline constexpr std::size_t name_width = 30;

/// {"value", "lower", "upper"}.
[[nodiscard]] Json value_json(double value, const Bounds& bounds);
/// "    0.123      0.056 … 0.345", 30 columns wide.
[[nodiscard]] std::string value_text(double value, const Bounds& bounds);

/// The heading line of an output's table with the names of its two values.
[[nodiscard]] std::string column_names(std::string_view first, std::string_view second,
                                       double confidence);

/// "root.latch_time, s · 90 runs · 10 without a value"; the last part only if `missing` is above 0.
[[nodiscard]] std::string heading_of(const std::string& output, long count,
                                     std::string_view counted, long missing,
                                     std::string_view what_of_them);

/// " · 12 cut by t_end"; empty for none.
[[nodiscard]] std::string cut_heading(long cut);

/// One output's table, the largest effects first.
/// @param size sort key of each of `count` dispersions; NaN comes last
/// @param line text of each dispersion, with its line feed
[[nodiscard]] std::string effect_block(const std::string& heading, const std::string& columns,
                                       std::size_t count,
                                       const std::function<double(std::size_t)>& size,
                                       const std::function<std::string(std::size_t)>& line);

/// Heuristics of the short tables, which the commands' help states: the smallest effect that is shown, as the magnitude
/// of a rank correlation (4 % of the ranks' variance) and as a share of the variance; the smallest one beside the
/// largest of the same output; and how many an output shows.
inline constexpr double least_shown_correlation = 0.2, least_shown_share = 0.02,
                        least_beside_largest = 0.25;
inline constexpr std::size_t most_shown_effects = 5;

/// The effects of all dispersions on one output, by index.
struct EffectsOnOutput {
  const std::vector<std::string>& dispersions;
  std::function<double(std::size_t)> value; ///< signed; NaN: none
  double least;                             ///< smallest magnitude that is shown
  std::function<bool(std::size_t)> visible; ///< whether its bounds show that there is an effect
  std::function<std::string(double)> text;  ///< "−0.81"
};

/// The outputs of a short table, each with the few dispersions that move it.
class MovedBy {
public:
  /// Adds an output with its largest effects, and the number of visible ones that are left out.
  void add(const std::string& output, const EffectsOnOutput& effects);

  /// Adds an output whose effects are unknown, because some rows lack it.
  void add_unknown(const std::string& output) { unknown_.push_back(output); }

  /// A line for each output, then one with all outputs that nothing moves. @param heading of the second column
  /// @param limits what the method cannot see, after the names of these outputs
  [[nodiscard]] std::string table(std::string_view heading, std::string_view limits = "") const;

private:
  std::string lines_;
  std::vector<std::string> unmoved_, unknown_;
};

/// An output with cut peaks (finality.hpp).
struct CutOutput {
  std::string name;
  long cut = 0; ///< runs
};
/// Adds the warnings about t_end: peaks that it cut, and latches that may let go after it.
/// @param outputs     all; those without cut peaks are left out
/// @param never_final as for advice_on_t_end
void warn_of_t_end(const std::vector<CutOutput>& outputs, long open_latches, long runs,
                   std::string_view never_final, std::vector<std::string>& warnings);

/// `"a", "b"`.
[[nodiscard]] std::string quoted(const std::vector<std::string>& names);

} // namespace wingspread
