// The limits of every parameter of a scene (scene.hpp states them): the last value refused and the first one accepted.
#include "core/scene/scene.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

constexpr double least = std::numeric_limits<double>::denorm_min();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// A free base, a plain hinge with every part of one, and an elastic joint; a panel that bends; a loop.
Scene with_every_part() {
  Scene scene;
  scene.base.motion = BaseMotion::free;
  scene.base.mass = scene.base.inertia = 1;
  Body bending{.name = "panel", .mass = 12, .inertia = 1};
  bending.plate = Plate{{-0.5, 0}, {0.5, 0}, 1, 1};
  bending.flexible = Flexible{1, 1.0, {}, 0.01};
  scene.bodies = {bending, Body{.name = "tip", .mass = 1, .inertia = 1}};
  Hinge hinge, joint;
  hinge.name = "root", hinge.stowed = 1;
  hinge.damper.emplace(), hinge.stop.emplace(), hinge.far_stop.emplace(), hinge.latch.emplace();
  hinge.release.emplace(), hinge.motor.emplace(), hinge.hold = Hold{1, 0};
  joint.name = "joint", joint.parent = 0, joint.child = 1, joint.joint = Joint{1, 0};
  scene.hinges = {hinge, joint};
  Synchronisation& loop = scene.synchronisations.emplace_back();
  loop.name = "loop", loop.second = 1, loop.preload = 1;
  return scene;
}

enum class Range { finite, not_negative, positive };
struct Limited {
  std::string path;
  Range range;
  double& (*field)(Scene& scene); ///< may give the scene what the field needs
};

Hinge& root(Scene& scene) { return scene.hinges[0]; }
Damper& power_damper(Scene& scene) {
  scene.hinges[0].damper->law = DamperLaw::power;
  return *scene.hinges[0].damper;
}
Damper& eddy_currents(Scene& scene) {
  scene.hinges[0].damper->law = DamperLaw::eddy_current;
  return *scene.hinges[0].damper;
}
Base& driven(Scene& scene) {
  scene.base.motion = BaseMotion::prescribed;
  return scene.base;
}

const std::vector<Limited>& limited() {
  using enum Range;
  using S = Scene&;
  static const std::vector<Limited> all{
      {"base.angle", finite, [](S s) -> double& { return s.base.angle; }},
      {"base.rate", finite, [](S s) -> double& { return s.base.rate; }},
      {"base.mass", positive, [](S s) -> double& { return s.base.mass; }},
      {"base.inertia", positive, [](S s) -> double& { return s.base.inertia; }},
      {"base.position.0", finite, [](S s) -> double& { return s.base.position.x(); }},
      {"base.position.1", finite, [](S s) -> double& { return s.base.position.y(); }},
      {"base.velocity.0", finite, [](S s) -> double& { return s.base.velocity.x(); }},
      {"base.velocity.1", finite, [](S s) -> double& { return s.base.velocity.y(); }},
      {"base.acceleration.0", finite, [](S s) -> double& { return driven(s).acceleration.x(); }},
      {"base.acceleration.1", finite, [](S s) -> double& { return driven(s).acceleration.y(); }},
      {"base.angular_acceleration", finite,
       [](S s) -> double& { return driven(s).angular_acceleration; }},
      {"base.table.scale", finite, [](S s) -> double& { return driven(s).table_scale; }},
      {"bodies.panel.mass", positive, [](S s) -> double& { return s.bodies[0].mass; }},
      {"bodies.tip.inertia", positive, [](S s) -> double& { return s.bodies[1].inertia; }},
      {"bodies.panel.plate.from.0", finite,
       [](S s) -> double& { return s.bodies[0].plate->from.x(); }},
      {"bodies.panel.plate.from.1", finite,
       [](S s) -> double& { return s.bodies[0].plate->from.y(); }},
      {"bodies.panel.plate.to.0", finite, [](S s) -> double& { return s.bodies[0].plate->to.x(); }},
      {"bodies.panel.plate.to.1", finite, [](S s) -> double& { return s.bodies[0].plate->to.y(); }},
      {"bodies.panel.plate.width", not_negative,
       [](S s) -> double& { return s.bodies[0].plate->width; }},
      {"bodies.panel.plate.drag_coefficient", not_negative,
       [](S s) -> double& { return s.bodies[0].plate->drag_coefficient; }},
      {"bodies.panel.flexible.bending_stiffness", positive,
       [](S s) -> double& { return *s.bodies[0].flexible->bending_stiffness; }},
      {"bodies.panel.flexible.frequency", positive,
       [](S s) -> double& { return s.bodies[0].flexible->frequency.emplace(); }},
      {"bodies.panel.flexible.damping_ratio", not_negative,
       [](S s) -> double& { return s.bodies[0].flexible->damping_ratio; }},
      {"hinges.root.parent_point.0", finite,
       [](S s) -> double& { return root(s).parent_point.x(); }},
      {"hinges.root.parent_point.1", finite,
       [](S s) -> double& { return root(s).parent_point.y(); }},
      {"hinges.root.child_point.0", finite, [](S s) -> double& { return root(s).child_point.x(); }},
      {"hinges.root.child_point.1", finite, [](S s) -> double& { return root(s).child_point.y(); }},
      {"hinges.root.angle.stowed", finite, [](S s) -> double& { return root(s).stowed; }},
      {"hinges.joint.angle", finite, [](S s) -> double& { return s.hinges[1].stowed; }},
      {"hinges.joint.initial_rate", finite,
       [](S s) -> double& { return s.hinges[1].initial_rate; }},
      {"hinges.joint.joint.stiffness", positive,
       [](S s) -> double& { return s.hinges[1].joint->stiffness; }},
      {"hinges.joint.joint.damping", not_negative,
       [](S s) -> double& { return s.hinges[1].joint->damping; }},
      {"hinges.root.spring.torque_stowed", finite,
       [](S s) -> double& { return root(s).spring.torque_stowed; }},
      {"hinges.root.spring.torque_latched", finite,
       [](S s) -> double& { return root(s).spring.torque_latched; }},
      {"hinges.root.spring.scale", finite, [](S s) -> double& { return root(s).spring.scale; }},
      {"hinges.root.spring.offset", finite, [](S s) -> double& { return root(s).spring.offset; }},
      {"hinges.root.harness.torque_stowed", finite,
       [](S s) -> double& { return root(s).harness.torque_stowed; }},
      {"hinges.root.harness.torque_latched", finite,
       [](S s) -> double& { return root(s).harness.torque_latched; }},
      {"hinges.root.harness.scale", finite, [](S s) -> double& { return root(s).harness.scale; }},
      {"hinges.root.harness.offset", finite, [](S s) -> double& { return root(s).harness.offset; }},
      {"hinges.root.friction.coulomb", not_negative,
       [](S s) -> double& { return root(s).friction.coulomb; }},
      {"hinges.root.friction.viscous", not_negative,
       [](S s) -> double& { return root(s).friction.viscous; }},
      {"hinges.root.friction.scale", not_negative,
       [](S s) -> double& { return root(s).friction.scale; }},
      {"hinges.root.friction.static", not_negative, // its level is at least the kinetic one: 0
       [](S s) -> double& { return root(s).friction.static_level.emplace(); }},
      {"hinges.root.damper.coefficient", not_negative,
       [](S s) -> double& { return root(s).damper->coefficient; }},
      {"hinges.root.damper.scale", not_negative,
       [](S s) -> double& { return root(s).damper->scale; }},
      {"hinges.root.damper.coefficient", not_negative,
       [](S s) -> double& { return power_damper(s).coefficient; }},
      {"hinges.root.damper.exponent", positive,
       [](S s) -> double& { return power_damper(s).exponent; }},
      {"hinges.root.damper.peak_torque", not_negative,
       [](S s) -> double& { return eddy_currents(s).peak_torque; }},
      {"hinges.root.damper.window.0", finite,
       [](S s) -> double& {
         return root(s).damper->window.emplace(std::array{0., 9.})[0];
       }},
      {"hinges.root.damper.window.1", finite,
       [](S s) -> double& {
         return root(s).damper->window.emplace(std::array{9., 0.})[1];
       }},
      {"hinges.root.stop.stiffness", not_negative,
       [](S s) -> double& { return root(s).stop->stiffness; }},
      {"hinges.root.stop.dissipation", not_negative,
       [](S s) -> double& { return root(s).stop->dissipation; }},
      {"hinges.root.stop.gap", not_negative, [](S s) -> double& { return root(s).stop->gap; }},
      {"hinges.root.far_stop.stiffness", not_negative,
       [](S s) -> double& { return root(s).far_stop->stiffness; }},
      {"hinges.root.far_stop.dissipation", not_negative,
       [](S s) -> double& { return root(s).far_stop->dissipation; }},
      {"hinges.root.far_stop.gap", not_negative,
       [](S s) -> double& { return root(s).far_stop->gap; }},
      {"hinges.root.latch.stiffness", not_negative,
       [](S s) -> double& { return root(s).latch->stiffness; }},
      {"hinges.root.latch.damping", not_negative,
       [](S s) -> double& { return root(s).latch->damping; }},
      {"hinges.root.latch.backlash", not_negative,
       [](S s) -> double& { return root(s).latch->backlash; }},
      {"hinges.root.latch.dissipation", not_negative,
       [](S s) -> double& { return root(s).latch->dissipation.emplace(); }},
      {"hinges.root.latch.capture_rate", not_negative,
       [](S s) -> double& { return root(s).latch->capture_rate.emplace(); }},
      {"hinges.root.latch.holding_moment", positive,
       [](S s) -> double& { return root(s).latch->holding_moment.emplace(); }},
      {"hinges.root.release.time", not_negative,
       [](S s) -> double& { return root(s).release->time; }},
      {"hinges.root.release.delay", not_negative,
       [](S s) -> double& { return root(s).release->delay; }},
      {"hinges.root.release.event.angle", positive,
       [](S s) -> double& {
         root(s).release->event = Release::Event::passed;
         return root(s).release->angle;
       }},
      {"hinges.root.hold.stiffness", positive,
       [](S s) -> double& { return root(s).hold->stiffness; }},
      {"hinges.root.hold.damping", not_negative,
       [](S s) -> double& { return root(s).hold->damping; }},
      {"hinges.root.motor.rate", finite, [](S s) -> double& { return root(s).motor->rate; }},
      {"hinges.root.motor.gain", not_negative, [](S s) -> double& { return root(s).motor->gain; }},
      {"hinges.root.motor.torque_limit", not_negative,
       [](S s) -> double& { return root(s).motor->torque_limit; }},
      {"synchronisations.loop.stiffness", not_negative,
       [](S s) -> double& { return s.synchronisations[0].stiffness; }},
      {"synchronisations.loop.damping", not_negative,
       [](S s) -> double& { return s.synchronisations[0].damping; }},
      {"synchronisations.loop.preload", positive,
       [](S s) -> double& { return *s.synchronisations[0].preload; }},
      {"environment.gravity.0", finite, [](S s) -> double& { return s.environment.gravity.x(); }},
      {"environment.gravity.1", finite, [](S s) -> double& { return s.environment.gravity.y(); }},
      {"environment.air_density", not_negative,
       [](S s) -> double& { return s.environment.air_density; }},
  };
  return all;
}

/// What the scene's fault of this path expects; empty without one.
std::string expected_of(const Scene& scene, const std::string& path) {
  const std::vector<Fault> faults = unphysical(scene);
  const auto found = std::ranges::find(faults, path, &Fault::path);
  return found == faults.end() ? "" : found->expected;
}

} // namespace

TEST_CASE("a parameter is refused up to its limit and accepted from there on") {
  CHECK(unphysical(with_every_part()).empty());
  for (const auto& [path, range, field] : limited()) {
    CAPTURE(path);
    const auto expected = [&path = path, &field = field](double value) {
      Scene scene = with_every_part();
      field(scene) = value;
      return expected_of(scene, path);
    };
    for (const double value : {undefined, infinity, -infinity})
      CHECK(expected(value) == "a finite number");
    CHECK(expected(least).empty());
    CHECK(expected(0.25).empty());
    CHECK(expected(0).empty() == (range != Range::positive));
    CHECK(expected(-least).empty() == (range == Range::finite));
    CHECK(expected(-0.25).empty() == (range == Range::finite));
    if (range == Range::positive) CHECK(expected(0) == "> 0");
    if (range == Range::not_negative && !path.ends_with("static"))
      CHECK(expected(-least) == ">= 0");
  }
}

TEST_CASE("rates that are squared lie between 1e-150 and 1e150") {
  const auto expected = [](double value, double& (*field)(Scene & scene), const char* path) {
    Scene scene = with_every_part();
    field(scene) = value;
    return expected_of(scene, std::string("hinges.root.") + path);
  };
  struct Rate {
    const char* path;
    double& (*field)(Scene& scene);
    bool bounded;
  };
  for (const auto& [path, field, bounded] :
       {Rate{"friction.regularization_rate",
             [](Scene& s) -> double& { return root(s).friction.regularization_rate; }, true},
        {"damper.regularization_rate",
         [](Scene& s) -> double& { return power_damper(s).regularization_rate; }, false},
        {"damper.peak_rate", [](Scene& s) -> double& { return eddy_currents(s).peak_rate; },
         false}}) {
    CAPTURE(path);
    CHECK(expected(1e-150, field, path).empty());
    CHECK(expected(0.25, field, path).empty());
    CHECK(expected(1e150, field, path).empty());
    CHECK(expected(std::nextafter(1e-150, 0), field, path) == ">= 1e-150");
    CHECK(expected(0, field, path) == "> 0");
    CHECK(expected(-1, field, path) == "> 0");
    CHECK(expected(std::nextafter(1e150, 1e151), field, path) == (bounded ? "<= 1e150" : ""));
    CHECK(expected(undefined, field, path) == "a finite number");
  }
}

TEST_CASE("parameters that limit each other") {
  const auto with = [](const auto& change) {
    Scene scene = with_every_part();
    change(scene);
    return unphysical(scene);
  };
  const auto refused = [&](const char* path, const auto& change) {
    const std::vector<Fault> faults = with(change);
    CAPTURE(path);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].path == path);
  };
  const auto accepted = [&](const auto& change) { CHECK(with(change).empty()); };
  const auto levels = [](double kinetic, double at_rest) {
    return [=](Scene& s) {
      root(s).friction.coulomb = kinetic;
      root(s).friction.static_level = at_rest;
    };
  };
  accepted(levels(0.5, 0.5));
  refused("hinges.root.friction.static", levels(0.5, std::nextafter(0.5, 0)));
  refused("hinges.root.angle.latched", [](Scene& s) { root(s).latched = root(s).stowed; });
  accepted([](Scene& s) { root(s).latched = std::nextafter(root(s).stowed, 0); });
  refused("hinges.root.damper.window.1", [](Scene& s) { root(s).damper->window = {0.5, 0.5}; });
  refused("hinges.root.latch.damping", [](Scene& s) {
    root(s).latch->damping = least;
    root(s).latch->dissipation = 0;
  });
  refused("hinges.root.initial_rate", [](Scene& s) { root(s).initial_rate = least; });
  refused("hinges.root.release", [](Scene& s) { root(s).release.reset(); });
  for (const double fails : {0., 1.}) accepted([&](Scene& s) { root(s).release->fails = fails; });
  refused("hinges.root.release.fails", [](Scene& s) { root(s).release->fails = 0.5; });
  refused("bodies.panel.plate.to", [](Scene& s) { s.bodies[0].plate->to = {-0.5, 0}; });
  accepted([](Scene& s) { s.bodies[0].plate->to = {-0.5, 1}; }); // of the same length, along y
  refused("bodies.panel.plate", [](Scene& s) { s.bodies[0].plate.reset(); });
  refused("synchronisations.loop.ratio", [](Scene& s) { s.synchronisations[0].ratio = 0; });
  accepted([](Scene& s) { s.synchronisations[0].ratio = -least; });
}

TEST_CASE("a hinge opens the way that the tables of its spring and harness go") {
  for (HingeTorque Hinge::*torque : {&Hinge::spring, &Hinge::harness})
    for (const double stowed : {1.5, -1.5}) {
      Scene scene = with_every_part();
      Hinge& hinge = scene.hinges[0];
      hinge.stowed = stowed, hinge.latched = 0;
      (hinge.*torque).table = std::make_shared<const TorqueTable>(
          std::vector<double>{1.01 * stowed, 0}, std::vector<double>{2, 1}, Interpolation::linear);
      CHECK(unphysical(scene).empty());
      hinge.stowed = -stowed;
      const std::vector<Fault> faults = unphysical(scene);
      REQUIRE(faults.size() == 1);
      CHECK(faults[0].path == "hinges.root.angle.latched");
    }
}
