/// The torque terms of one hinge at a place of its travel, and the places where a static margin can have its minimum.
/// Kinetic energy, stops, gravity and air are not counted. A torque test both ways (`measured`) gives its mean to the
/// spring and half its difference to the friction.
///
/// A motor counts with its moment at rest under the fastest command that is still to come at the place (motor_command.hpp).
/// One whose commands to come all lead away from the latch resists.
///
/// Dampers and viscous friction vanish at rest. With a stated rate they resist as at that rate, in addition to the
/// friction at rest.
///
/// Without tables every term is linear in the travel x between the places where a torque changes sign. A margin is a
/// quotient of such terms, hence monotone between these places: its minimum lies at one of them or at an end, and is
/// exact. Between the knots of a table a term is a cubic, and the least quotient is computed (least_quotient.hpp).
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/static_margins/torque_factors.hpp"

#include <vector>

namespace wingspread {

/// A hinge's data from the campaign's `motorization`.
struct HingeExtras {
  TorqueTerms other{}; ///< terms that a scene cannot hold, N·m
  double rate = 0;     ///< rate for the dampers' torque, rad/s, ≥ 0; 0: dampers are not counted
};

/// The hinge's terms at x of its travel (0 stowed … 1 latched), the extras included. A spring that pulls back counts as
/// resistance S; a harness that helps counts as 0. FR is the friction level at rest: `static` of the exact model, else
/// `coulomb`, plus half the difference of a torque test both ways.
[[nodiscard]] TorqueTerms terms_at(const Hinge& hinge, double x, const HingeExtras& extras = {});

/// Adds the hinge's terms, referred to a leading hinge: all torques times `gear`, the turns of this hinge per turn of
/// the leader. With a negative gear the hinge turns backwards and its spring resists. Returns the part of T from the
/// hinge's spring.
double add_terms(const Hinge& hinge, double x, double gear, const HingeExtras& extras,
                 TorqueTerms& terms);

/// Both ends of the travel, and where spring or harness changes sign; x, ascending.
[[nodiscard]] std::vector<double> turning_points(const Hinge& hinge);

/// The places between which every term is a cubic of x: the turning points, the knots of spring and harness, and the edges
/// of the damper's window; and places along the table of a motor's command, between which its torque is nearly one. x,
/// ascending.
[[nodiscard]] std::vector<double> places_of_least(const Hinge& hinge);

/// Divides each piece between 0, the knots and 1 into eight equal parts. Returns all ends of parts, ascending.
/// @param knots within (0, 1), in any order
[[nodiscard]] std::vector<double> parts_between(std::vector<double> knots);

} // namespace wingspread
