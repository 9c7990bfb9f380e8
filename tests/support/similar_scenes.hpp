/// Scenes that are similar in the sense of dimensional analysis: the same wing in other units of mass, length and time.
#pragma once

#include "core/scene/scene.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace wingspread::oracle {

/// How many of the new units make one of the old. Powers of 2 lose nothing to rounding; the mass should be one of 4, so
/// that the root of an energy loses nothing either.
struct Units {
  double mass = 1, length = 1, time = 1;

  [[nodiscard]] double inertia() const { return mass * length * length; }
  [[nodiscard]] double acceleration() const { return length / (time * time); }
  [[nodiscard]] double force() const { return mass * acceleration(); }
  [[nodiscard]] double moment() const {
    return length * force();
  } ///< also a stiffness and an energy
  [[nodiscard]] double damping() const { return moment() * time; }
};

inline void convert(HingeTorque& torque, const Units& units) {
  const double by = units.moment();
  torque.torque_stowed *= by, torque.torque_latched *= by, torque.offset *= by;
  if (!torque.table) return;
  const auto converted = [by](std::vector<double> all) {
    for (double& each : all) each *= by;
    return all;
  };
  const TorqueTable& old = *torque.table;
  torque.table = std::make_shared<const TorqueTable>(
      old.both_ways() ? TorqueTable(old.angle(), converted(old.deploying()),
                                    converted(old.stowing()), old.interpolation())
                      : TorqueTable(old.angle(), converted(old.deploying()), old.interpolation()));
}

inline void convert(Hinge& hinge, const Units& units) {
  const double moment = units.moment(), damping = units.damping(), time = units.time;
  hinge.parent_point *= units.length, hinge.child_point *= units.length;
  hinge.initial_rate /= time;
  convert(hinge.spring, units), convert(hinge.harness, units);
  Friction& friction = hinge.friction;
  friction.coulomb *= moment, friction.viscous *= damping, friction.regularization_rate /= time;
  if (friction.static_level) *friction.static_level *= moment;
  if (hinge.damper) {
    Damper& damper = *hinge.damper;
    damper.coefficient *=
        damper.law == DamperLaw::power ? moment * std::pow(time, damper.exponent) : damping;
    damper.regularization_rate /= time, damper.peak_rate /= time, damper.peak_torque *= moment;
  }
  for (std::optional<Stop>* stop : {&hinge.stop, &hinge.far_stop})
    if (*stop) (*stop)->stiffness *= moment, (*stop)->dissipation *= time;
  if (hinge.latch) {
    Latch& latch = *hinge.latch;
    latch.stiffness *= moment, latch.damping *= damping;
    if (latch.dissipation) *latch.dissipation *= time;
    if (latch.capture_rate) *latch.capture_rate /= time;
    if (latch.holding_moment) *latch.holding_moment *= moment;
  }
  if (hinge.release) hinge.release->time *= time, hinge.release->delay *= time;
  if (hinge.hold) hinge.hold->stiffness *= moment, hinge.hold->damping *= damping;
  if (hinge.motor) { // a table over time stays as it is: its campaign's time is the old one
    hinge.motor->rate /= time;
    hinge.motor->gain *= damping, hinge.motor->torque_limit *= moment;
  }
  if (hinge.joint) hinge.joint->stiffness *= moment, hinge.joint->damping *= damping;
}

/// The scene in other units. @pre no table over time unless only the mass has another unit
inline Scene in_units(Scene scene, const Units& units) {
  for (Body& body : scene.bodies) {
    body.mass *= units.mass, body.inertia *= units.inertia();
    if (body.plate) {
      body.plate->from *= units.length, body.plate->to *= units.length;
      body.plate->width *= units.length;
    }
    if (!body.flexible) continue;
    if (body.flexible->bending_stiffness)
      *body.flexible->bending_stiffness *= units.moment() * units.length;
    if (body.flexible->frequency) *body.flexible->frequency /= units.time;
  }
  for (Hinge& hinge : scene.hinges) convert(hinge, units);
  for (Synchronisation& loop : scene.synchronisations) {
    loop.stiffness *= units.moment(), loop.damping *= units.damping();
    if (loop.preload) *loop.preload *= units.moment();
  }
  scene.environment.gravity *= units.acceleration();
  scene.environment.air_density *= units.mass / (units.length * units.length * units.length);
  Base& base = scene.base;
  base.acceleration *= units.acceleration();
  base.angular_acceleration /= units.time * units.time;
  base.rate /= units.time;
  base.mass *= units.mass, base.inertia *= units.inertia();
  base.position *= units.length, base.velocity *= units.length / units.time;
  return scene;
}

} // namespace wingspread::oracle
