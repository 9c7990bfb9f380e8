#include "montecarlo/model/input_checks/motor_checks.hpp"

#include "montecarlo/model/static_margins/motor_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wingspread {
namespace {

constexpr double implausible_rate =
    1; // rad/s; heuristic: deployment motors turn some degrees a second
// Share of the fastest command. Heuristic: no drive keeps its rate so well, and such stiffness costs steps.
constexpr double needless_precision = 1e-9;
constexpr double much_deflection = 0.0175; // rad, 1°; heuristic: latches hold panels to far less

/// The largest magnitude of the command, rad/s.
double fastest(const Motor& motor) {
  if (!motor.table) return std::abs(motor.rate);
  double most = 0;
  for (const double rate : motor.rates) most = std::max(most, std::abs(motor.scale * rate));
  return most;
}

void check_command(const std::string& at, const Hinge& hinge, double time, bool latched,
                   InputWarnings& warnings) {
  const Motor& motor = *hinge.motor;
  if (fastest(motor) > implausible_rate)
    warnings.add(
        at + "/rate", fmt::format("up to {:.4g} rad/s", fastest(motor)),
        fmt::format("up to {} rad/s (write other units as \"2 deg/s\")", implausible_rate));
  const bool no_spring = hinge.spring.torque_stowed == 0 && hinge.spring.torque_latched == 0 &&
                         hinge.spring.offset == 0 && !hinge.spring.table;
  const double travel = std::abs(hinge.latched - hinge.stowed), way = commanded_way(motor, time);
  if (hinge.latch && no_spring && !latched && way > 0 && way < travel)
    warnings.add(at + "/rate",
                 fmt::format("a command that turns the hinge by {:.4g} of its {:.4g} rad of travel "
                             "in the {:.4g} s of the run",
                             way, travel, time),
                 "a faster command, or a later t_end");
}

/// A gain so large that the torque limit is reached next to the command itself.
void check_gain(const std::string& at, const Motor& motor, InputWarnings& warnings) {
  const double slip = motor.torque_limit / motor.gain, rate = fastest(motor);
  if (rate > 0 && slip < needless_precision * rate)
    warnings.add(at + "/gain",
                 fmt::format("{:.4g} N·m·s/rad: the motor exerts its torque limit {:.2g} rad/s off "
                             "a command of {:.4g} rad/s, and such stiffness costs many steps",
                             motor.gain, slip, rate),
                 fmt::format("{:.1g} N·m·s/rad keeps the rate to a millionth",
                             1e6 * motor.torque_limit / rate));
}

/// @param stall of the commands while the latch is engaged
void check_latch(const std::string& at, const Hinge& hinge, const StallTorques& stall,
                 InputWarnings& warnings) {
  const Latch& latch = *hinge.latch;
  if (latch.holding_moment && -stall.least >= *latch.holding_moment)
    warnings.add(at,
                 fmt::format("a motor that pulls the engaged hinge back with {:.4g} N·m; its "
                             "latch lets go from {:.4g} N·m on",
                             -stall.least, *latch.holding_moment),
                 "a torque_limit below the latch's holding_moment");
  const double most = std::max(std::abs(stall.least), std::abs(stall.most));
  if (latch.stiffness > 0 && most / latch.stiffness > much_deflection)
    warnings.add(at + "/torque_limit",
                 fmt::format("a motor that bends its engaged latch by {:.4g} rad: {:.4g} N·m "
                             "against {:.4g} N·m/rad",
                             most / latch.stiffness, most, latch.stiffness),
                 "a limit that a latch of that stiffness holds within 1°, or a table whose rate "
                 "ends at 0");
}

void check_motor(const Scene& scene, int h, double t_end, const Outcome& nominal,
                 InputWarnings& warnings) {
  const std::string at = fmt::format("/hinges/{}/motor", h);
  const Hinge& hinge = scene.hinges[h];
  const Motor& motor = *hinge.motor;
  const bool zero_gain = motor.gain == 0;
  if (zero_gain || motor.torque_limit == 0)
    return warnings.add(at + (zero_gain ? "/gain" : "/torque_limit"), "0: the motor exerts nothing",
                        "> 0");
  check_gain(at, motor, warnings);
  const StallTorques stall = stall_torques(motor);
  if (!(stall.most > 0) && stall.least < 0)
    warnings.add(at + "/rate", "never towards the latch",
                 "a rate > 0: positive deploys, in whichever sense the hinge turns");
  double released = 0;
  for (const HingeEvent& event : nominal.releases)
    if (event.hinge == h) released = event.time;
  const LatchEvent* latched = holding_latch(nominal, h);
  check_command(at, hinge, t_end - released, latched != nullptr, warnings);
  const double engaged =
      latched ? latched->time - released : std::numeric_limits<double>::infinity();
  if (hinge.latch) check_latch(at, hinge, stall_torques(motor, engaged), warnings);
}

} // namespace

void check_motors(const Scene& scene, const Integration& integration, const Outcome& nominal,
                  InputWarnings& warnings) {
  for (int h = 0; h < std::ssize(scene.hinges); ++h)
    if (scene.hinges[h].motor) check_motor(scene, h, integration.t_end, nominal, warnings);
}

} // namespace wingspread
