/// The campaign's key `outputs`: families of outputs, their columns for a scene, and a column's value in a run's
/// outcome.
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

/// All statuses, in the order of reports.
inline constexpr std::array statuses{Status::deployed, Status::stalled, Status::timed_out,
                                     Status::invalid, Status::failed};

/// The status with this name; nothing if there is none.
[[nodiscard]] std::optional<Status> status_named(std::string_view name);

/// `peaks_final` is no number but a column of its own: whether all peaks are proven final (results.hpp).
enum class OutputFamily {
  latch_time,
  latch_rate,
  peak_moment,
  peak_force,
  rate_at,
  overtravel,
  peaks_final,
  base_motion, ///< of a free base; not a default: runs then last longer
  frequency,   ///< of the deployed wing's modes; not a default, because each costs a decomposition
  hold_moment, ///< of hinges that are held
  captures,    ///< of latches that may miss or let go
  held,        ///< of the same latches
  final_angle, ///< not a default: runs then go to t_end
  motor_energy ///< of hinges with motors
};
inline constexpr std::array<std::string_view, 14> output_family_names{
    "latch_time", "latch_rate",  "peak_moment", "peak_force",  "rate_at",
    "overtravel", "peaks_final", "base_motion", "frequency",   "hold_moment",
    "captures",   "held",        "final_angle", "motor_energy"};
inline constexpr int most_mode_outputs = 10; ///< mode_1.frequency … mode_10.frequency
using Outputs = std::set<OutputFamily>;

/// All families except `rate_at` (quadratic in the number of hinges), `base_motion`, `frequency` and `final_angle`, and
/// those of features that a scene may lack.
[[nodiscard]] Outputs default_outputs();
/// default_outputs, and the families of the scene's holds, motors and latches that may miss.
[[nodiscard]] Outputs default_outputs(const Scene& scene);

/// Whether the outputs include peaks, which t_end may cut.
[[nodiscard]] bool has_peaks(const Outputs& outputs);

/// Whether an output is a peak. t_end may cut a peak; its largest value is then unknown.
[[nodiscard]] bool is_peak(std::string_view output);
/// The family of an output that is a peak: of moments, those in flexible bodies included, or of forces.
enum class PeakKind { none, moment, force };
[[nodiscard]] PeakKind peak_kind(std::string_view output);

/// Adds `peaks_final` if the outputs include peaks, else removes it.
void match_peaks_final(Outputs& outputs);

/// All families.
[[nodiscard]] Outputs all_outputs();

/// Replaces the outputs by the array of families; notes problems.
void read_outputs(const JsonCursor& at, Outputs& outputs);
[[nodiscard]] Json write_outputs(const Outputs& outputs);

/// A column of outputs: a quantity of a hinge, of the base or of the wing.
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
    bending_moment,
    frequency,
    deployment_time,
    hold_moment,
    captures,
    held,
    final_angle,
    motor_energy
  } quantity;
  /// Index into Scene::hinges; of a bending moment into Scene::bodies; of a frequency the mode, from 0; else −1.
  int hinge = -1;
  int other = -1; ///< of `rate_at`: the hinge that latches
};

/// The columns of the families for a scene: hinge by hinge in the scene's order, then flexible bodies' bending moments
/// (with the peak moments), a free base's, the modes', then `deployment_time`, which is always present. An elastic
/// joint has peaks only. A hinge without a latch has no latch_time and latch_rate, but rate_at other hinges' latching.
/// A hinge has no rate_at its own latching: that is its latch_rate.
[[nodiscard]] std::vector<OutputColumn> output_columns(const Scene& scene, const Outputs& outputs);

/// The goal of a run that has these outputs. Without peaks a run ends at the last latch. With final_angle it ends at
/// t_end, or when all hinges are stuck for good.
[[nodiscard]] Goal goal_of(const Outputs& outputs);

/// The number; NaN if it is not finite.
[[nodiscard]] double finite_or_none(double value);

/// The column's value in a run; NaN if it did not happen.
///
/// Latch times and rates are given whatever the run's status. If a latch let go, they are those of the engagement that
/// holds at the end of the run. Peaks and overtravel are NaN in a failed run, because later values are unknown; in a
/// timed-out run they are those up to t_end. `deployment_time` needs all latches.
[[nodiscard]] double output_of(const OutputColumn& column, const Outcome& outcome);

/// The names of the latched hinges in order of time: "root>mid>tip".
[[nodiscard]] std::string latch_order(const Scene& scene, const Outcome& outcome);

} // namespace wingspread
