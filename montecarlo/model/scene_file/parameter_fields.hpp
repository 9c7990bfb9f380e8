/// The tables of all numbers of a scene that a path can name.
#pragma once

#include "core/scene/scene.hpp"

#include <array>
#include <string_view>

namespace wingspread::parameter_fields {

/// One number of a base, body, hinge, synchronisation or environment. The tables below list all of them.
template <class Owner> struct Field {
  template <class Get>
  constexpr Field(std::string_view field_path, std::string_view field_unit, Get get,
                  bool (*is_there)(const Owner&) = nullptr, std::string_view field_needs = "")
      : path(field_path), unit(field_unit), read(get), write(get), exists(is_there),
        needs(field_needs) {}

  std::string_view path; ///< after the owner's name
  std::string_view unit;
  const double& (*read)(const Owner&);
  double& (*write)(Owner&);
  bool (*exists)(const Owner&); ///< null: always
  std::string_view needs;       ///< what has the field, for a message

  [[nodiscard]] bool in(const Owner& owner) const { return !exists || exists(owner); }
};

inline bool is_free(const Base& base) { return base.motion == BaseMotion::free; }
inline bool is_prescribed(const Base& base) { return base.motion == BaseMotion::prescribed; }
inline bool is_moving(const Base& base) { return base.motion != BaseMotion::fixed; }
inline bool has_table(const Base& base) { return is_prescribed(base) && base.table; }
inline bool has_acceleration(const Base& base) {
  return is_prescribed(base) && !(base.table && base.table->gives_acceleration());
}
inline bool has_angular_acceleration(const Base& base) {
  return is_prescribed(base) && !(base.table && base.table->gives_turning());
}
inline bool has_rate(const Base& base) {
  return is_moving(base) && !(has_table(base) && base.table->gives_rate());
}
inline bool has_plate(const Body& body) { return body.plate.has_value(); }
inline bool has_stiffness(const Body& body) {
  return body.flexible && body.flexible->bending_stiffness;
}
inline bool has_frequency(const Body& body) { return body.flexible && body.flexible->frequency; }
inline bool is_flexible(const Body& body) { return body.flexible.has_value(); }
inline bool has_joint(const Hinge& hinge) { return hinge.joint.has_value(); }
inline bool has_laws(const Hinge& hinge) { return !hinge.joint; }
inline bool has_spring_line(const Hinge& hinge) { return !hinge.joint && !hinge.spring.table; }
inline bool has_harness_line(const Hinge& hinge) { return !hinge.joint && !hinge.harness.table; }
inline bool has_damper(const Hinge& hinge) { return hinge.damper.has_value(); }
inline bool has_law(const Hinge& hinge, DamperLaw law) {
  return hinge.damper && hinge.damper->law == law;
}
inline bool has_eddy_current(const Hinge& hinge) { return has_law(hinge, DamperLaw::eddy_current); }
inline bool has_power_law(const Hinge& hinge) { return has_law(hinge, DamperLaw::power); }
inline bool has_viscous_damper(const Hinge& hinge) { return has_law(hinge, DamperLaw::viscous); }
inline bool has_window(const Hinge& hinge) { return hinge.damper && hinge.damper->window; }
inline bool has_stop(const Hinge& hinge) { return hinge.stop.has_value(); }
inline bool has_far_stop(const Hinge& hinge) { return hinge.far_stop.has_value(); }
inline bool has_capture_rate(const Hinge& hinge) {
  return hinge.latch && hinge.latch->capture_rate;
}
inline bool has_holding_moment(const Hinge& hinge) {
  return hinge.latch && hinge.latch->holding_moment;
}
inline bool has_release(const Hinge& hinge) { return hinge.release.has_value(); }
inline bool has_event(const Hinge& hinge, Release::Event event) {
  return hinge.release && hinge.release->event == event;
}
inline bool has_release_time(const Hinge& hinge) { return has_event(hinge, Release::Event::time); }
inline bool has_release_angle(const Hinge& hinge) {
  return has_event(hinge, Release::Event::passed);
}
inline bool has_hold(const Hinge& hinge) { return hinge.hold.has_value(); }
inline bool has_motor(const Hinge& hinge) { return hinge.motor.has_value(); }
inline bool has_motor_rate(const Hinge& hinge) { return hinge.motor && !hinge.motor->table; }
inline bool has_motor_table(const Hinge& hinge) { return hinge.motor && hinge.motor->table; }
inline bool has_ratio(const Synchronisation& loop) { return !loop.table; }
inline bool has_preload(const Synchronisation& loop) { return loop.preload.has_value(); }
inline bool has_latch(const Hinge& hinge) { return hinge.latch.has_value(); }
inline bool has_dissipation(const Hinge& hinge) { return hinge.latch && hinge.latch->dissipation; }
inline bool has_damping(const Hinge& hinge) { return hinge.latch && !hinge.latch->dissipation; }
inline bool has_static(const Hinge& hinge) { return hinge.friction.static_level.has_value(); }
inline bool is_regularized(const Hinge& hinge) {
  return !hinge.joint && hinge.friction.model == FrictionModel::regularized;
}

inline constexpr std::string_view needs_free = "a base whose motion is \"free\"";
inline constexpr std::string_view needs_acceleration =
    "a base whose motion is \"prescribed\", with no table of it (table.scale disperses one)";
inline constexpr std::string_view needs_table = "a base whose motion is prescribed by a table";
inline constexpr std::string_view needs_motion = "a base that is not fixed";
inline constexpr std::string_view needs_rate =
    "a base that is not fixed, with no table of its rate";
inline constexpr std::string_view needs_plate = "a body that has a plate";
inline constexpr std::string_view needs_flexible = "a body that is flexible";
inline constexpr std::string_view needs_stiffness = "a flexible body with a bending_stiffness";
inline constexpr std::string_view needs_frequency = "a flexible body with a frequency";
inline constexpr std::string_view needs_joint = "a hinge that is an elastic joint";
inline constexpr std::string_view needs_laws = "a hinge that is no elastic joint";
inline constexpr std::string_view needs_spring_line =
    "a hinge whose spring has no table (scale and offset disperse one)";
inline constexpr std::string_view needs_harness_line =
    "a hinge whose harness has no table (scale and offset disperse one)";
inline constexpr std::string_view needs_damper = "a hinge that has a damper";
inline constexpr std::string_view needs_coefficient =
    "a hinge with a viscous or a power-law damper";
inline constexpr std::string_view needs_power_law = "a hinge with a power-law damper";
inline constexpr std::string_view needs_eddy_current = "a hinge with an eddy-current damper";
inline constexpr std::string_view needs_window = "a hinge whose damper has a window";
inline constexpr std::string_view needs_stop = "a hinge that has a stop at its stowed side";
inline constexpr std::string_view needs_far_stop = "a hinge that has a stop at its latched side";
inline constexpr std::string_view needs_capture_rate = "a hinge whose latch has a capture_rate";
inline constexpr std::string_view needs_holding_moment = "a hinge whose latch has a holding_moment";
inline constexpr std::string_view needs_release = "a hinge that has a release";
inline constexpr std::string_view needs_release_time = "a hinge with a release at a time";
inline constexpr std::string_view needs_release_angle =
    "a hinge with a release after another hinge's angle";
inline constexpr std::string_view needs_hold = "a hinge that has an elastic hold";
inline constexpr std::string_view needs_motor = "a hinge that has a motor";
inline constexpr std::string_view needs_motor_rate =
    "a hinge whose motor has one rate (rate.scale disperses a table)";
inline constexpr std::string_view needs_motor_table = "a hinge whose motor has a table of its rate";
inline constexpr std::string_view needs_ratio = "a synchronisation whose ratio is a number";
inline constexpr std::string_view needs_preload = "a synchronisation that has a preload";
inline constexpr std::string_view needs_latch = "a hinge that has a latch";
inline constexpr std::string_view needs_damping = "a hinge whose latch has a damping";
inline constexpr std::string_view needs_dissipation = "a hinge whose latch has a dissipation";
inline constexpr std::string_view needs_regularized = "a hinge with the regularized friction model";
inline constexpr std::string_view needs_static = "a hinge whose friction has a static level";

// clang-format off
inline constexpr std::array base_fields{
    Field<Base>{"mass", "kg", [](auto& b) -> auto& { return b.mass; }, is_free, needs_free},
    Field<Base>{"inertia", "kg·m²", [](auto& b) -> auto& { return b.inertia; }, is_free, needs_free},
    Field<Base>{"position.0", "m", [](auto& b) -> auto& { return b.position[0]; }, is_free, needs_free},
    Field<Base>{"position.1", "m", [](auto& b) -> auto& { return b.position[1]; }, is_free, needs_free},
    Field<Base>{"velocity.0", "m/s", [](auto& b) -> auto& { return b.velocity[0]; }, is_free, needs_free},
    Field<Base>{"velocity.1", "m/s", [](auto& b) -> auto& { return b.velocity[1]; }, is_free, needs_free},
    Field<Base>{"acceleration.0", "m/s²", [](auto& b) -> auto& { return b.acceleration[0]; }, has_acceleration, needs_acceleration},
    Field<Base>{"acceleration.1", "m/s²", [](auto& b) -> auto& { return b.acceleration[1]; }, has_acceleration, needs_acceleration},
    Field<Base>{"angular_acceleration", "rad/s²", [](auto& b) -> auto& { return b.angular_acceleration; }, has_angular_acceleration, needs_acceleration},
    Field<Base>{"table.scale", "", [](auto& b) -> auto& { return b.table_scale; }, has_table, needs_table},
    Field<Base>{"angle", "rad", [](auto& b) -> auto& { return b.angle; }, is_moving, needs_motion},
    Field<Base>{"rate", "rad/s", [](auto& b) -> auto& { return b.rate; }, has_rate, needs_rate}};

inline constexpr std::array body_fields{
    Field<Body>{"mass", "kg", [](auto& b) -> auto& { return b.mass; }},
    Field<Body>{"inertia", "kg·m²", [](auto& b) -> auto& { return b.inertia; }},
    Field<Body>{"plate.width", "m", [](auto& b) -> auto& { return b.plate->width; }, has_plate, needs_plate},
    Field<Body>{"plate.drag_coefficient", "", [](auto& b) -> auto& { return b.plate->drag_coefficient; }, has_plate, needs_plate},
    Field<Body>{"flexible.bending_stiffness", "N·m²", [](auto& b) -> auto& { return *b.flexible->bending_stiffness; }, has_stiffness, needs_stiffness},
    Field<Body>{"flexible.frequency", "Hz", [](auto& b) -> auto& { return *b.flexible->frequency; }, has_frequency, needs_frequency},
    Field<Body>{"flexible.damping_ratio", "", [](auto& b) -> auto& { return b.flexible->damping_ratio; }, is_flexible, needs_flexible}};

inline constexpr std::array hinge_fields{
    Field<Hinge>{"parent_point.0", "m", [](auto& h) -> auto& { return h.parent_point[0]; }},
    Field<Hinge>{"parent_point.1", "m", [](auto& h) -> auto& { return h.parent_point[1]; }},
    Field<Hinge>{"child_point.0", "m", [](auto& h) -> auto& { return h.child_point[0]; }},
    Field<Hinge>{"child_point.1", "m", [](auto& h) -> auto& { return h.child_point[1]; }},
    Field<Hinge>{"angle.stowed", "rad", [](auto& h) -> auto& { return h.stowed; }, has_laws, needs_laws},
    Field<Hinge>{"angle.latched", "rad", [](auto& h) -> auto& { return h.latched; }, has_laws, needs_laws},
    Field<Hinge>{"initial_rate", "rad/s", [](auto& h) -> auto& { return h.initial_rate; }},
    Field<Hinge>{"spring.torque_stowed", "N·m", [](auto& h) -> auto& { return h.spring.torque_stowed; }, has_spring_line, needs_spring_line},
    Field<Hinge>{"spring.torque_latched", "N·m", [](auto& h) -> auto& { return h.spring.torque_latched; }, has_spring_line, needs_spring_line},
    Field<Hinge>{"spring.scale", "", [](auto& h) -> auto& { return h.spring.scale; }, has_laws, needs_laws},
    Field<Hinge>{"spring.offset", "N·m", [](auto& h) -> auto& { return h.spring.offset; }, has_laws, needs_laws},
    Field<Hinge>{"harness.torque_stowed", "N·m", [](auto& h) -> auto& { return h.harness.torque_stowed; }, has_harness_line, needs_harness_line},
    Field<Hinge>{"harness.torque_latched", "N·m", [](auto& h) -> auto& { return h.harness.torque_latched; }, has_harness_line, needs_harness_line},
    Field<Hinge>{"harness.scale", "", [](auto& h) -> auto& { return h.harness.scale; }, has_laws, needs_laws},
    Field<Hinge>{"harness.offset", "N·m", [](auto& h) -> auto& { return h.harness.offset; }, has_laws, needs_laws},
    Field<Hinge>{"friction.coulomb", "N·m", [](auto& h) -> auto& { return h.friction.coulomb; }, has_laws, needs_laws},
    Field<Hinge>{"friction.viscous", "N·m·s/rad", [](auto& h) -> auto& { return h.friction.viscous; }, has_laws, needs_laws},
    Field<Hinge>{"friction.regularization_rate", "rad/s", [](auto& h) -> auto& { return h.friction.regularization_rate; }, is_regularized, needs_regularized},
    Field<Hinge>{"friction.static", "N·m", [](auto& h) -> auto& { return *h.friction.static_level; }, has_static, needs_static},
    Field<Hinge>{"friction.scale", "", [](auto& h) -> auto& { return h.friction.scale; }, has_laws, needs_laws},
    Field<Hinge>{"damper.coefficient", "N·m·s/rad", [](auto& h) -> auto& { return h.damper->coefficient; }, has_viscous_damper, needs_coefficient},
    Field<Hinge>{"damper.coefficient", "N·m·(s/rad)^p", [](auto& h) -> auto& { return h.damper->coefficient; }, has_power_law, needs_coefficient},
    Field<Hinge>{"damper.exponent", "", [](auto& h) -> auto& { return h.damper->exponent; }, has_power_law, needs_power_law},
    Field<Hinge>{"damper.regularization_rate", "rad/s", [](auto& h) -> auto& { return h.damper->regularization_rate; }, has_power_law, needs_power_law},
    Field<Hinge>{"damper.peak_torque", "N·m", [](auto& h) -> auto& { return h.damper->peak_torque; }, has_eddy_current, needs_eddy_current},
    Field<Hinge>{"damper.peak_rate", "rad/s", [](auto& h) -> auto& { return h.damper->peak_rate; }, has_eddy_current, needs_eddy_current},
    Field<Hinge>{"damper.window.0", "rad", [](auto& h) -> auto& { return (*h.damper->window)[0]; }, has_window, needs_window},
    Field<Hinge>{"damper.window.1", "rad", [](auto& h) -> auto& { return (*h.damper->window)[1]; }, has_window, needs_window},
    Field<Hinge>{"damper.scale", "", [](auto& h) -> auto& { return h.damper->scale; }, has_damper, needs_damper},
    Field<Hinge>{"stop.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.stop->stiffness; }, has_stop, needs_stop},
    Field<Hinge>{"stop.dissipation", "s/rad", [](auto& h) -> auto& { return h.stop->dissipation; }, has_stop, needs_stop},
    Field<Hinge>{"stop.gap", "rad", [](auto& h) -> auto& { return h.stop->gap; }, has_stop, needs_stop},
    Field<Hinge>{"far_stop.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.far_stop->stiffness; }, has_far_stop, needs_far_stop},
    Field<Hinge>{"far_stop.dissipation", "s/rad", [](auto& h) -> auto& { return h.far_stop->dissipation; }, has_far_stop, needs_far_stop},
    Field<Hinge>{"far_stop.gap", "rad", [](auto& h) -> auto& { return h.far_stop->gap; }, has_far_stop, needs_far_stop},
    Field<Hinge>{"release.time", "s", [](auto& h) -> auto& { return h.release->time; }, has_release_time, needs_release_time},
    Field<Hinge>{"release.event.angle", "rad", [](auto& h) -> auto& { return h.release->angle; }, has_release_angle, needs_release_angle},
    Field<Hinge>{"release.delay", "s", [](auto& h) -> auto& { return h.release->delay; }, has_release, needs_release},
    Field<Hinge>{"release.fails", "", [](auto& h) -> auto& { return h.release->fails; }, has_release, needs_release},
    Field<Hinge>{"hold.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.hold->stiffness; }, has_hold, needs_hold},
    Field<Hinge>{"hold.damping", "N·m·s/rad", [](auto& h) -> auto& { return h.hold->damping; }, has_hold, needs_hold},
    Field<Hinge>{"motor.rate", "rad/s", [](auto& h) -> auto& { return h.motor->rate; }, has_motor_rate, needs_motor_rate},
    Field<Hinge>{"motor.rate.scale", "", [](auto& h) -> auto& { return h.motor->scale; }, has_motor_table, needs_motor_table},
    Field<Hinge>{"motor.gain", "N·m·s/rad", [](auto& h) -> auto& { return h.motor->gain; }, has_motor, needs_motor},
    Field<Hinge>{"motor.torque_limit", "N·m", [](auto& h) -> auto& { return h.motor->torque_limit; }, has_motor, needs_motor},
    Field<Hinge>{"latch.capture_rate", "rad/s", [](auto& h) -> auto& { return *h.latch->capture_rate; }, has_capture_rate, needs_capture_rate},
    Field<Hinge>{"latch.holding_moment", "N·m", [](auto& h) -> auto& { return *h.latch->holding_moment; }, has_holding_moment, needs_holding_moment},
    Field<Hinge>{"latch.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.latch->stiffness; }, has_latch, needs_latch},
    Field<Hinge>{"latch.damping", "N·m·s/rad", [](auto& h) -> auto& { return h.latch->damping; }, has_damping, needs_damping},
    Field<Hinge>{"latch.dissipation", "s/rad", [](auto& h) -> auto& { return *h.latch->dissipation; }, has_dissipation, needs_dissipation},
    Field<Hinge>{"latch.backlash", "rad", [](auto& h) -> auto& { return h.latch->backlash; }, has_latch, needs_latch},
    Field<Hinge>{"angle", "rad", [](auto& h) -> auto& { return h.stowed; }, has_joint, needs_joint},
    Field<Hinge>{"joint.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.joint->stiffness; }, has_joint, needs_joint},
    Field<Hinge>{"joint.damping", "N·m·s/rad", [](auto& h) -> auto& { return h.joint->damping; }, has_joint, needs_joint}};

inline constexpr std::array synchronisation_fields{
    Field<Synchronisation>{"ratio", "", [](auto& s) -> auto& { return s.ratio; }, has_ratio, needs_ratio},
    Field<Synchronisation>{"stiffness", "N·m/rad", [](auto& s) -> auto& { return s.stiffness; }},
    Field<Synchronisation>{"damping", "N·m·s/rad", [](auto& s) -> auto& { return s.damping; }},
    Field<Synchronisation>{"preload", "N·m", [](auto& s) -> auto& { return *s.preload; }, has_preload, needs_preload}};

inline constexpr std::array environment_fields{
    Field<Environment>{"gravity.0", "m/s²", [](auto& e) -> auto& { return e.gravity[0]; }},
    Field<Environment>{"gravity.1", "m/s²", [](auto& e) -> auto& { return e.gravity[1]; }},
    Field<Environment>{"air_density", "kg/m³", [](auto& e) -> auto& { return e.air_density; }}};
// clang-format on

} // namespace wingspread::parameter_fields
