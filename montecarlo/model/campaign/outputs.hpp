/// What is kept of a run: the families of outputs that a campaign asks for, the columns they come to
/// on its scene, and how a column is taken from the outcome of a run.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Every status, in the order in which it is reported.
inline constexpr std::array statuses{Status::deployed, Status::stalled, Status::timed_out,
                                     Status::invalid, Status::failed};

/// The status of that name, as it is written.
[[nodiscard]] std::optional<Status> status_named(std::string_view name);

/// `peaks_final` is no number, but whether those of the peaks are proven: a column of its own (results.hpp).
enum class OutputFamily {
  latch_time,
  latch_rate,
  peak_moment,
  peak_force,
  rate_at,
  overtravel,
  peaks_final,
  base_motion ///< of a free base: asked for by name, for runs go to t_end for it
};
inline constexpr std::array<std::string_view, 8> output_family_names{
    "latch_time", "latch_rate", "peak_moment", "peak_force",
    "rate_at",    "overtravel", "peaks_final", "base_motion"};
using Outputs = std::set<OutputFamily>;

/// All but `rate_at`, whose number grows with the square of the hinges', and `base_motion`.
[[nodiscard]] Outputs default_outputs();

/// Whether a family is of peaks, which t_end may cut.
[[nodiscard]] bool has_peaks(const Outputs& outputs);

/// Whether an output is a peak: of those t_end may cut, and then nothing is known of the largest value.
[[nodiscard]] bool is_peak(std::string_view output);

/// Adds `peaks_final` where there are peaks, and takes it away where there are none: asked for or not.
void match_peaks_final(Outputs& outputs);

/// Every family there is.
[[nodiscard]] Outputs all_outputs();

/// Reads an array of families over what is already there, and notes what is wrong.
void read_outputs(const JsonCursor& at, Outputs& outputs);
[[nodiscard]] Json write_outputs(const Outputs& outputs);

/// A column of outputs: which quantity of which hinge.
struct OutputColumn {
  std::string name; ///< "root.latch_time"
  enum class Quantity {
    latch_time,
    latch_rate,
    peak_moment,
    peak_force,
    rate_at,
    overtravel,
    base_peak_angle,
    base_peak_rate,
    deployment_time
  } quantity;
  int hinge = -1; ///< index into Scene::hinges; none for what is the wing's or the base's
  int other = -1; ///< of `rate_at`: the hinge that latches
};

/// The columns that a campaign's families of outputs come to: hinge by hinge in the scene's order,
/// then those of a free base, then `deployment_time`, which is always there. A hinge without a latch has no latch time and
/// rate, but rates at the latching of others; a hinge's rate at its own latching is its
/// `latch_rate`, and no `rate_at`.
[[nodiscard]] std::vector<OutputColumn> output_columns(const Scene& scene, const Outputs& outputs);

/// What the families need of a run: without peaks it ends at the last latch, with the base's motion at t_end.
[[nodiscard]] Goal goal_of(const Outputs& outputs);

/// A number as results hold it: NaN where it is not finite.
[[nodiscard]] double finite_or_none(double value);

/// The number in the column; NaN when it did not happen.
///
/// A latch that happened counts in whatever became of the run afterwards. A peak, and overtravel, need a run whose
/// end is known: not one that failed, where a larger one may have been to come. Of a run that timed
/// out it is the peak up to t_end. `deployment_time` exists only when all hinges with a latch have
/// latched.
[[nodiscard]] double output_of(const OutputColumn& column, const Outcome& outcome);

/// The names of the hinges that latched, in order of time: "root>mid>tip".
[[nodiscard]] std::string latch_order(const Scene& scene, const Outcome& outcome);

} // namespace wingspread
