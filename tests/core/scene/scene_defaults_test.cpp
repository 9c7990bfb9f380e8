// What a scene, a run's settings and its results have where nothing is said: readers of files leave it so.
#include "core/outcome.hpp"
#include "core/scene/scene.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

template <class... Numbers> bool all_zero(const Numbers&... numbers) {
  return ((numbers == 0) && ...);
}
bool is_zero(const Eigen::Vector2d& v) { return v.x() == 0 && v.y() == 0; }

} // namespace

TEST_CASE("a hinge of which nothing is said hangs on the base, free of any moment") {
  const Hinge hinge;
  CHECK((hinge.parent == base_index && hinge.child == 0));
  CHECK((is_zero(hinge.parent_point) && is_zero(hinge.child_point)));
  CHECK(all_zero(hinge.stowed, hinge.latched, hinge.initial_rate));
  for (const HingeTorque& torque : {hinge.spring, hinge.harness}) {
    CHECK(all_zero(torque.torque_stowed, torque.torque_latched, torque.offset));
    CHECK((torque.scale == 1 && !torque.table));
  }
  CHECK(all_zero(hinge.friction.coulomb, hinge.friction.viscous));
  CHECK((hinge.friction.regularization_rate == 1e-3 && hinge.friction.scale == 1));
  CHECK((!hinge.friction.static_level && hinge.friction.model == FrictionModel::regularized));
  CHECK_FALSE((hinge.damper || hinge.stop || hinge.far_stop || hinge.latch || hinge.release));
  CHECK_FALSE((hinge.hold || hinge.motor || hinge.joint));
}

TEST_CASE("what a hinge may have exerts nothing before it is given numbers") {
  const Damper damper;
  CHECK((damper.law == DamperLaw::viscous && damper.exponent == 1 && damper.peak_rate == 1));
  CHECK((all_zero(damper.coefficient, damper.peak_torque) && damper.scale == 1));
  CHECK((damper.regularization_rate == 1e-6 && !damper.window));
  const Stop stop;
  CHECK(all_zero(stop.stiffness, stop.dissipation, stop.gap));
  const Latch latch;
  CHECK(all_zero(latch.stiffness, latch.damping, latch.backlash));
  CHECK_FALSE((latch.dissipation || latch.can_miss()));
  const Release release;
  CHECK((release.event == Release::Event::time && release.after == -1));
  CHECK(all_zero(release.time, release.angle, release.delay, release.fails));
  const Hold hold;
  const Joint joint;
  CHECK(all_zero(hold.stiffness, hold.damping, joint.stiffness, joint.damping));
  const Motor motor;
  CHECK(all_zero(motor.rate, motor.gain, motor.torque_limit));
  CHECK((motor.scale == 1 && !motor.table && motor.interpolation == Interpolation::monotone));
}

TEST_CASE("the rest of a scene of which nothing is said is at rest in empty space") {
  const Scene scene;
  CHECK((scene.bodies.empty() && scene.hinges.empty() && scene.synchronisations.empty()));
  CHECK((is_zero(scene.environment.gravity) && scene.environment.air_density == 0));
  const Base& base = scene.base;
  CHECK((base.motion == BaseMotion::fixed && !base.table && base.table_scale == 1));
  CHECK((is_zero(base.acceleration) && is_zero(base.position) && is_zero(base.velocity)));
  CHECK(all_zero(base.angular_acceleration, base.angle, base.rate, base.mass, base.inertia));
  const Synchronisation loop;
  CHECK((all_zero(loop.first, loop.second, loop.stiffness, loop.damping) && loop.ratio == 1));
  CHECK_FALSE((loop.table || loop.preload));
  const Body body;
  CHECK((all_zero(body.mass, body.inertia) && !body.plate && !body.flexible));
  const Plate plate;
  CHECK(
      (is_zero(plate.from) && is_zero(plate.to) && all_zero(plate.width, plate.drag_coefficient)));
  const Flexible flexible;
  CHECK((flexible.joints == 1 && flexible.damping_ratio == 0));
  CHECK_FALSE((flexible.bending_stiffness || flexible.frequency));
  const BaseTable::Piece piece;
  CHECK((is_zero(piece.velocity) && all_zero(piece.from, piece.rate, piece.angle)));
  for (const auto& c : {piece.x, piece.y, piece.turning}) CHECK(all_zero(c[0], c[1], c[2], c[3]));
  const Curve::Piece part;
  CHECK(all_zero(part.from, part.integral, part.c[0], part.c[1], part.c[2], part.c[3]));
}

TEST_CASE("a run of which nothing is said has the settings that its documentation tells") {
  const Integration how;
  CHECK((how.method == "auto" && how.rtol == 1e-8 && how.atol == 1e-10 && !how.smoothing));
  CHECK((how.t_end == 60 && how.max_steps == 1000000 && how.step == 1e-4));
  const Goal goal;
  CHECK((goal.peak_moment && goal.peak_force && goal.overtravel && goal.hold_moment));
  CHECK((goal.motor_energy && goal.audit && goal.end_state && goal.final_angle));
  CHECK_FALSE((goal.base_motion || goal.to_rest || goal.to_t_end || goal.first_latch_only));
  CHECK_FALSE((goal.mode_frequencies || goal.sample_motion_only));
  CHECK(goal.sample_interval == 0);
}

TEST_CASE("an outcome of which nothing is known claims nothing") {
  const Outcome out;
  CHECK((out.status == Status::failed && out.t_end == 0 && !out.base_peaks));
  CHECK_FALSE((out.peaks_final || out.moments_final || out.forces_final));
  CHECK(out.latches_final); // without such latches it stands
  CHECK((is_zero(out.final.base_position) && is_zero(out.final.base_velocity)));
  CHECK(all_zero(out.final.base_angle, out.final.base_rate, out.energy.initial, out.energy.final,
                 out.energy.drift_before_first_latch));
  CHECK(all_zero(out.work.steps, out.work.rejected, out.work.rhs_evaluations));
  const Finality final;
  CHECK_FALSE((final.peaks || final.moments || final.forces));
  CHECK(final.latches);
  const HingeEvent event;
  const Peak peak;
  const BasePeaks base;
  const Phase phase;
  CHECK(
      all_zero(event.hinge, event.time, event.rate, peak.value, peak.time, base.angle, base.rate));
  CHECK(all_zero(phase.from, phase.to, phase.steps));
  const Sample sample;
  CHECK(all_zero(sample.t, sample.kinetic, sample.potential, sample.base_angle, sample.base_rate));
  CHECK(is_zero(sample.base_position));
}
