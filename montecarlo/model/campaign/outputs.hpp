/// The campaign's key `outputs`: families of outputs, their columns for a scene, and a column's value in a run's
/// outcome.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"

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

/// A family of outputs, which a campaign asks for by name. `peaks_final` is no number but a column of its own: whether
/// all peaks are proven final (results.hpp).
enum class OutputFamily {
  latch_time,
  latch_rate,
  peak_moment,
  peak_force,
  rate_at,
  overtravel,
  peaks_final,
  base_motion,
  frequency,
  hold_moment,
  captures,
  held,
  final_angle,
  motor_energy
};

/// Whether a campaign that names no families has one.
enum class ByDefault {
  yes,
  with_its_feature, ///< if a hinge of the scene has it
  no ///< longer runs, a decomposition, many columns; and peaks_final, which follows the peaks
};

struct OutputFamilyInfo {
  OutputFamily family;
  std::string_view name;
  ByDefault by_default;
  std::string_view wings; ///< which wings have such outputs, for the input check; "": no check
};

/// All families, in the order of OutputFamily.
inline constexpr std::array output_families{
    OutputFamilyInfo{OutputFamily::latch_time, "latch_time", ByDefault::yes, ""},
    OutputFamilyInfo{OutputFamily::latch_rate, "latch_rate", ByDefault::yes, ""},
    OutputFamilyInfo{OutputFamily::peak_moment, "peak_moment", ByDefault::yes, ""},
    OutputFamilyInfo{OutputFamily::peak_force, "peak_force", ByDefault::yes, ""},
    OutputFamilyInfo{OutputFamily::rate_at, "rate_at", ByDefault::no,
                     "a wing of two hinges or more, with latches"},
    OutputFamilyInfo{OutputFamily::overtravel, "overtravel", ByDefault::yes, ""},
    OutputFamilyInfo{OutputFamily::peaks_final, "peaks_final", ByDefault::no, ""},
    OutputFamilyInfo{OutputFamily::base_motion, "base_motion", ByDefault::no,
                     "a wing on a free base"},
    OutputFamilyInfo{OutputFamily::frequency, "frequency", ByDefault::no, ""},
    OutputFamilyInfo{OutputFamily::hold_moment, "hold_moment", ByDefault::with_its_feature,
                     "a wing with a hinge that has a \"release\""},
    OutputFamilyInfo{OutputFamily::captures, "captures", ByDefault::with_its_feature,
                     "a wing with a latch that has a \"capture_rate\" or a \"holding_moment\""},
    OutputFamilyInfo{OutputFamily::held, "held", ByDefault::with_its_feature,
                     "a wing with a latch that has a \"capture_rate\" or a \"holding_moment\""},
    OutputFamilyInfo{OutputFamily::final_angle, "final_angle", ByDefault::no, ""},
    OutputFamilyInfo{OutputFamily::motor_energy, "motor_energy", ByDefault::with_its_feature,
                     "a wing with a hinge that has a \"motor\""}};
inline constexpr auto output_family_names = [] {
  std::array<std::string_view, output_families.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = output_families[i].name;
  return names;
}();
inline constexpr int most_mode_outputs = 10; ///< mode_1.frequency … mode_10.frequency
using Outputs = std::set<OutputFamily>;

[[nodiscard]] constexpr const OutputFamilyInfo& about(OutputFamily family) {
  return output_families[static_cast<std::size_t>(family)];
}

/// The family that has the quantity; nothing of deployment_time, which is always there.
[[nodiscard]] std::optional<OutputFamily> family_of(OutputQuantity quantity);
/// The same by the output's name; nothing if there is no such output.
[[nodiscard]] std::optional<OutputFamily> family_of(std::string_view output);

/// The families that are there by default in any scene.
[[nodiscard]] Outputs default_outputs();
/// The same, and those of the scene's holds, motors and latches that may miss.
[[nodiscard]] Outputs default_outputs(const Scene& scene);

/// Whether the outputs include peaks, which t_end may cut.
[[nodiscard]] bool has_peaks(const Outputs& outputs);

/// Adds `peaks_final` if the outputs include peaks, else removes it.
void match_peaks_final(Outputs& outputs);

/// All families but peaks_final.
[[nodiscard]] Outputs all_outputs();

/// Replaces the outputs by the array of families; notes problems.
void read_outputs(const JsonCursor& at, Outputs& outputs);
[[nodiscard]] Json write_outputs(const Outputs& outputs);

/// A column of outputs: a quantity of a hinge, of a body, of a mode, of the base or of the wing.
struct OutputColumn {
  std::string name; ///< "root.latch_time"
  OutputQuantity quantity;
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
