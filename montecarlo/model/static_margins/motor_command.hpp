/// A motor's command over time and along the travel, and the moment that the motor exerts at rest under it.
///
/// | symbol   | meaning                                                          | unit  |
/// |----------|------------------------------------------------------------------|-------|
/// | r(t)     | commanded rate, t since the hinge's release; positive deploys    | rad/s |
/// | w(t)     | the way of the command, ∫ r from 0 to t                          | rad   |
/// | c, T     | gain, torque limit                                               | N·m·s/rad, N·m |
///
/// At rest the motor exerts clamp(c r, −T, T). A hinge at rest at an angle waits for the fastest command that is still to
/// come. A hinge that follows the command is there at the first t with w(t) = the angle's travel. So at this travel the
/// motor counts with the fastest command from that t on: with 0 where its table has come down to 0, which is how the
/// motor brakes. Where w never reaches the travel only the table's last rate counts. A hinge that lags behind its command
/// comes later, and one that its spring drives faster comes earlier: no static margin knows that, the runs show it.
#pragma once

#include "core/scene/scene.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// w(t), rad. @param time s, ≥ 0
[[nodiscard]] double commanded_way(const Motor& motor, double time);

/// The first t with w(t) ≥ way, s; nothing if the command never goes that far. @param way rad, ≥ 0
[[nodiscard]] std::optional<double> time_of_way(const Motor& motor, double way);

/// The ways at which the command turns back, rad: w(t) where r(t) falls to 0 or below. Beyond such a way a hinge that
/// follows the command waits for a later one, so the moment that counts may jump there.
[[nodiscard]] std::vector<double> turning_ways(const Motor& motor);

/// The moments that a motor exerts at rest under its slowest and its fastest command, N·m along the travel.
struct StallTorques {
  double least, most;
};
/// @param from s since the release: of the commands from then on; infinite: of the last one
[[nodiscard]] StallTorques stall_torques(const Motor& motor, double from = 0);

/// The moment at rest that counts at x of the hinge's travel (0 stowed … 1 latched), N·m along the travel.
/// @pre the hinge has a motor
[[nodiscard]] double stall_torque_at(const Hinge& hinge, double x);

} // namespace wingspread
