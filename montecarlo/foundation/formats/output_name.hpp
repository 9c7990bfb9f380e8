/// The outputs and their names: "root.latch_time", "root.rate_at.tip", "deployment_time".
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace wingspread {

/// The quantities of outputs, in the order of columns.
enum class OutputQuantity {
  latch_time,
  latch_rate,
  peak_moment,
  peak_force,
  overtravel,
  hold_moment,
  captures,
  held,
  motor_energy,
  final_angle,
  rate_at,
  peak_bending_moment,
  base_peak_angle,
  base_peak_rate,
  frequency,
  deployment_time
};

/// The owner of an output. The name begins with the owner's; an output of the wing has no owner.
enum class OutputOwner { hinge, two_hinges, body, base, mode, wing };

/// t_end may cut a peak; its largest value is then unknown. Moments include those in flexible bodies.
enum class PeakKind { none, moment, force };

/// Properties of all outputs of a quantity.
struct OutputKind {
  OutputQuantity quantity;
  std::string_view name; ///< the part after the owner's name
  OutputOwner owner;
  const char* unit; ///< "" of a number
  bool has_sign;    ///< false: no value is below 0
  PeakKind peak;
  const char* meaning; ///< {0}: the owner, {1}: of a rate_at, the hinge that latches
};

/// All kinds, in the order of OutputQuantity.
inline constexpr std::array output_kinds{
    OutputKind{OutputQuantity::latch_time, "latch_time", OutputOwner::hinge, "s", false,
               PeakKind::none,
               "when {0} reaches its latched angle for the first time; of a latch that may miss or "
               "let go, when it engaged for good"},
    OutputKind{OutputQuantity::latch_rate, "latch_rate", OutputOwner::hinge, "rad/s", true,
               PeakKind::none,
               "relative rate of {0} when it latches; the sign is the sense of rotation, "
               "counter-clockwise positive"},
    OutputKind{OutputQuantity::peak_moment, "peak_moment", OutputOwner::hinge, "N·m", false,
               PeakKind::moment,
               "largest |moment| that {0} transmits about its axis in the whole run: springs, "
               "harness, friction, dampers, motor, stops, loops and latch together"},
    OutputKind{OutputQuantity::peak_force, "peak_force", OutputOwner::hinge, "N", false,
               PeakKind::force, "largest force across {0} over the whole run"},
    OutputKind{OutputQuantity::overtravel, "overtravel", OutputOwner::hinge, "rad", false,
               PeakKind::none,
               "largest rotation of {0} beyond its stowed angle, away from the latch; in a stalled "
               "run up to its end"},
    OutputKind{OutputQuantity::hold_moment, "hold_moment", OutputOwner::hinge, "N·m", false,
               PeakKind::none, "largest |moment| that the hold of {0} bore before it let go"},
    OutputKind{OutputQuantity::captures, "captures", OutputOwner::hinge, "", false, PeakKind::none,
               "how many times the latch of {0} engaged"},
    OutputKind{OutputQuantity::held, "held", OutputOwner::hinge, "", false, PeakKind::none,
               "1 if the latch of {0} holds at the end of the run, else 0"},
    OutputKind{OutputQuantity::motor_energy, "motor_energy", OutputOwner::hinge, "J", true,
               PeakKind::none,
               "work of the motor of {0} on the wing while no latch of {0} is engaged; below 0 if "
               "the motor brakes"},
    OutputKind{OutputQuantity::final_angle, "final_angle", OutputOwner::hinge, "rad", true,
               PeakKind::none, "angle of {0} at t_end, from its latched angle"},
    OutputKind{OutputQuantity::rate_at, "rate_at", OutputOwner::two_hinges, "rad/s", true,
               PeakKind::none, "relative rate of {0} when {1} latches, signed"},
    OutputKind{OutputQuantity::peak_bending_moment, "peak_bending_moment", OutputOwner::body, "N·m",
               false, PeakKind::moment,
               "largest |moment| in {0} over the whole run: in its joints, and in the hinges at "
               "its ends"},
    OutputKind{OutputQuantity::base_peak_angle, "peak_angle", OutputOwner::base, "rad", false,
               PeakKind::none, "largest change of the free base's angle from the start"},
    OutputKind{OutputQuantity::base_peak_rate, "peak_rate", OutputOwner::base, "rad/s", false,
               PeakKind::none, "largest change of the free base's rate from the start"},
    OutputKind{OutputQuantity::frequency, "frequency", OutputOwner::mode, "Hz", false,
               PeakKind::none,
               "natural frequency {0} of the draw's wing with every latch engaged, mode_1 the "
               "lowest; without damping"},
    OutputKind{OutputQuantity::deployment_time, "deployment_time", OutputOwner::wing, "s", false,
               PeakKind::none, "latch time of the last hinge with a latch"}};

[[nodiscard]] constexpr const OutputKind& kind_of(OutputQuantity quantity) {
  return output_kinds[static_cast<std::size_t>(quantity)];
}

struct OutputName {
  std::string hinge;    ///< or the body, the mode, "base"; empty for an output of the whole wing
  std::string quantity; ///< "latch_time"; the whole name if unknown
  std::string other;    ///< of a `rate_at`, the hinge that latches; else empty
  const char* unit;     ///< SI unit; "" of a number or an unknown output
  const OutputKind* kind = nullptr; ///< null when unknown
};

/// Splits a name. A hinge's name may contain dots.
[[nodiscard]] OutputName parse_output_name(std::string_view name);

/// Puts the name together, for instance "root.rate_at.tip".
/// @param owner the hinge, body or mode; the base and the wing need none
[[nodiscard]] std::string output_name(OutputQuantity quantity, const std::string& owner = "",
                                      const std::string& other = "");

/// The kind's meaning in words.
[[nodiscard]] std::string meaning_of(const OutputKind& kind, std::string_view owner,
                                     std::string_view other = "");

/// The peak that the output is.
[[nodiscard]] PeakKind peak_kind(std::string_view output);

} // namespace wingspread
