/// The terms of a hinge's static margin at a place of its travel, and where along it the margin may have
/// its least. Kinetic energy is not counted, nor what stops, gravity and air do. A torque test both ways
/// (`measured`) has its mean in the spring's torque and half its difference in the friction.
///
/// Dampers and viscous friction do nothing at rest. Where a rate is stated they resist as they would at
/// that rate, beside the friction that holds at rest: the drive has torque to spare while it moves.
///
/// Every term is linear in the travel x but where a torque changes its sense, and margins are quotients
/// of them: between such places they are monotone, so the worst is at one of them or at an end, and is
/// found exactly. A table's margins are looked at in eight parts of each of its pieces.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/static_margins/motorization_factors.hpp"

#include <vector>

namespace wingspread {

/// What a hinge's terms have beside the scene.
struct HingeExtras {
  MotorizationTerms other{}; ///< torques that the scene does not know, N·m
  double rate = 0;           ///< at which dampers are counted, rad/s, ≥ 0
};

/// The hinge's terms at x of its travel, 0 stowed … 1 latched, on top of what the scene does not know. A
/// torque that changes its sense changes its side: a spring that pulls back is S. A harness that helps is
/// not counted on. FR is the level that holds at rest: `static` of the exact friction, else `coulomb`,
/// and what a torque test both ways adds.
[[nodiscard]] MotorizationTerms terms_at(const Hinge& hinge, double x,
                                         const HingeExtras& extras = {});

/// Adds the hinge's terms as they are for another that turns once while this turns `gear` times: all
/// torques times the gear; below 0 it turns backwards, and its spring resists.
void add_terms(const Hinge& hinge, double x, double gear, const HingeExtras& extras,
               MotorizationTerms& terms);

/// Both ends of the travel, and where spring or harness changes its sense; ascending.
[[nodiscard]] std::vector<double> turning_points(const Hinge& hinge);

/// Where the margins may have their least: the turning points, places along every table, and the edges of a
/// damper's window; ascending.
[[nodiscard]] std::vector<double> places_of_least(const Hinge& hinge);

/// 0, and every piece between knots and 1 in eight parts. @param knots within (0, 1), in any order
[[nodiscard]] std::vector<double> parts_between(std::vector<double> knots);

} // namespace wingspread
