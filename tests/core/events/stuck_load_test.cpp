// The bound on what a locked hinge bears inside a step, against loads found from positions alone.
#include "core/events/stuck_load.hpp"
#include "tests/core/dense/any_motion.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;

namespace {

using oracle::AnyMotion;

template <BaseMotion M> HeldLoadBound<double> bound_of(const AnyMotion<M>& motion) {
  HeldLoadBound<double> bound;
  bound.over_step(motion.system, motion.step);
  for (int i = 1; i <= motion.wing.size(); ++i) bound.narrow(motion.system, motion.step, i);
  return bound;
}

template <BaseMotion M> void check_random_wings() {
  const double most = oracle::most_taken_by_random_wings<M>(
      {900, 1700, 140}, [](const AnyMotion<M>& motion, double s) { return motion.loads(s); },
      bound_of<M>);
  CHECK(most > 0.05); // it is not twenty times too large everywhere
}

/// What the loops do at every hinge at s, by the oracle's law, N·m.
template <BaseMotion M> std::vector<double> by_loops(const AnyMotion<M>& motion, double s) {
  State<double> x(motion.system.layout().size());
  motion.step.interpolate(motion.system.layout(), s, x);
  const Layout& at = motion.system.layout();
  std::vector<double> result(motion.wing.size() + 1);
  std::vector<int> body(motion.scene.hinges.size());
  for (int i = 1; i <= motion.wing.size(); ++i) body[motion.wing.hinge_of[i]] = i;
  for (const Synchronisation& given : motion.scene.synchronisations) {
    const oracle::Loop<double> loop(given);
    const int a = body[given.first], b = body[given.second];
    const HingeTerms<double>&first = motion.wing.hinges[a], &second = motion.wing.hinges[b];
    const double way = first.sense * (x[at.angle(a)] - first.stowed), slope = loop.slope(way);
    const double e = loop.out_of_step(way, second.sense * (x[at.angle(b)] - second.stowed));
    const double rate = slope * first.sense * x[at.rate(a)] - second.sense * x[at.rate(b)];
    const double tau = loop.pull(e, rate);
    result[a] -= first.sense * slope * tau;
    result[b] += second.sense * tau;
  }
  return result;
}

/// The largest part of what the friction that holds a hinge may rise by that it does in [from, to].
template <BaseMotion M>
double part_of_friction(const AnyMotion<M>& motion, const HeldLoadBound<double>& bound, double from,
                        double to) {
  const auto friction = [&](double s, int i) {
    return std::abs(motion.moments(s)[i] - by_loops(motion, s)[i]);
  };
  double most = 0;
  for (int i = 1; i <= motion.wing.size(); ++i) {
    const double ends = std::max(friction(from, i), friction(to, i));
    for (int k = 1; k < 24; ++k)
      most = std::max(most, (friction(from + (to - from) * k / 24, i) - ends) /
                                bound.friction(i, from, to).most);
  }
  return most;
}

/// Factors by which one part of the friction outweighs the others, so that its bound is tested alone.
struct Emphasis {
  double air = 1;       ///< of its density
  double stiffness = 1; ///< of loops, and of their preloads
  double inertia = 1;   ///< of bodies about their own centres
  bool slackens =
      false; ///< loops go slack at deflections of up to 4 rad, as large as those of the steps
};

/// Random wings with these features, all hinges stuck as far as the bound is concerned.
template <BaseMotion M>
double most_of_friction(const oracle::RealFeatures& features, bool driven,
                        const Emphasis& emphasis = {}, int wings = 60) {
  double most = 0;
  for (int k = 0; k < wings; ++k) {
    oracle::Draws draws(2900 + k);
    oracle::RandomScene options;
    options.bodies = 2 + k % 5, options.branching = k % 2 == 0, options.motion = M;
    Scene scene = with_real_hinges(random_scene(3700 + k, options), 4700 + k, features);
    if (driven) scene.base = oracle::driven_by_table(scene, 5700 + k, 3).base;
    scene.environment.air_density *= emphasis.air;
    for (Body& body : scene.bodies) body.inertia *= emphasis.inertia;
    for (Synchronisation& loop : scene.synchronisations) {
      loop.stiffness *= emphasis.stiffness;
      if (loop.preload) *loop.preload *= emphasis.stiffness;
      if (emphasis.slackens) loop.preload = 0.5 * loop.stiffness * draws.uniform(0, 4);
    }
    AnyMotion<M> motion(scene, 6700 + k, draws.log_uniform(1e-3, 0.3), draws.log_uniform(0.01, 3));
    for (int i = 1; i <= motion.wing.size(); ++i) motion.system.set_contact(i, Contact::stuck);
    const HeldLoadBound<double> bound = bound_of(motion);
    CAPTURE(k);
    for (const double s : {0.0, 0.4, 1.0})
      for (int i = 1; i <= motion.wing.size(); ++i) // differences of positions have 1e-5 or so
        CHECK(bound.size(i) >= motion.loads(s)[i] * (1 - 1e-3));
    for (int i = 1; i <= motion.wing.size(); ++i) // the whole step is a part too
      CHECK(bound.friction(i, 0, 1).most == Approx(bound.most_friction(i)).epsilon(1e-9));
    for (const auto& [from, to] : {std::pair(0., 1.), {0., 0.5}, {0.75, 1.}, {0.4, 0.41}}) {
      const double taken = part_of_friction(motion, bound, from, to);
      CHECK(taken < 0.75 + 1e-5); // without the 4/3, and what is lean is half
      if (to - from == 1) most = std::max(most, taken);
    }
  }
  return most;
}

constexpr oracle::RealFeatures nothing{false, false, false, false, false, false,
                                       false, false, false, false, false};

} // namespace

TEST_CASE("what a locked hinge bears rises no more inside a step than the bound says") {
  SECTION("fixed base") { check_random_wings<BaseMotion::fixed>(); }
  SECTION("prescribed base") { check_random_wings<BaseMotion::prescribed>(); }
  SECTION("free base") { check_random_wings<BaseMotion::free>(); }
}

namespace {

/// Sets the step's relative angles to steady turns at these rates, at `middle` half-way through the step.
template <BaseMotion M>
void turn_steadily(oracle::AnyMotion<M>& motion, const std::vector<double>& middle,
                   const std::vector<double>& rates) {
  Step<double>& step = motion.step;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const std::size_t r = k + rates.size();
    step.x[k] = middle[k] - 0.5 * step.h * rates[k];
    step.x1[k] = middle[k] + 0.5 * step.h * rates[k];
    step.x[r] = step.x1[r] = step.dxdt[k] = step.dxdt1[k] = rates[k];
    step.dxdt[r] = step.dxdt1[r] = 0;
  }
}

/// The part of the bound that the load of hinge i takes in the middle of the step.
template <BaseMotion M> double part_in_middle(const oracle::AnyMotion<M>& motion, int i) {
  HeldLoadBound<double> bound;
  bound.over_step(motion.system, motion.step);
  const double ends = std::max(motion.loads(0)[i], motion.loads(1)[i]);
  return (motion.loads(0.5)[i] - ends) / bound.rise(i);
}

} // namespace

// Two cases in which the bound is three quarters taken, as it may be at most: of (2), one term alone each.
TEST_CASE("a panel that turns on a pushed base takes what the bound leaves it") {
  // its load, m c a sin of the angle between them, is at its crest in the middle of the step
  Scene scene = oracle::latching_panel();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.acceleration = {10, 0};
  oracle::AnyMotion<BaseMotion::prescribed> motion(scene, 1, 2, 0);
  const Vec2<double>& center = motion.wing.bodies[1].center;
  const double across = 0.5 * std::numbers::pi - std::atan2(center.y, center.x);
  turn_steadily(motion, {across}, {0.1});
  const double part = part_in_middle(motion, 1);
  CHECK(part < 0.75 + 1e-6);
  CHECK(part > 0.7); // the panel's own turn adds to the bound, and does nothing
}

// The air pushes the whole wing. Without air a free wing feels no acceleration of its common centre of mass.
TEST_CASE("a panel that turns on a free base in the air takes what the bound leaves it") {
  for (const double push : {1.0, 10.0, 300.0}) {
    Scene scene = oracle::latching_panel();
    scene.base.motion = BaseMotion::free, scene.base.mass = 3, scene.base.inertia = 2;
    scene.environment.air_density = 1e-12; // there is air, but its own load is none
    scene.bodies[0].plate = Plate{{-0.5, 0}, {0.5, 0}, 1, 1};
    oracle::AnyMotion<BaseMotion::free> motion(scene, 1, 2, 0);
    const Vec2<double>& center = motion.wing.bodies[1].center;
    const double across = 0.5 * std::numbers::pi - std::atan2(center.y, center.x);
    turn_steadily(motion, {0, 0, 0, across}, {0, 0, 0, 0.1});
    Step<double>& step = motion.step;
    const int rate = motion.system.layout().freedoms(); // of the base along x
    step.x1[0] = 0.5 * push * step.h * step.h;
    step.x1[rate] = step.dxdt1[0] = push * step.h;
    step.dxdt[rate] = step.dxdt1[rate] = push;
    const double part = part_in_middle(motion, 1);
    CAPTURE(push);
    CHECK(part < 0.75 + 1e-6);
    CHECK(part > 0.6);
  }
}

TEST_CASE("a panel that turns against its arm takes what the bound leaves it") {
  // the hinge at the end of an arm l turns at w, the panel there at −w: m c l w² sin 2wt
  Scene scene = oracle::latching_panel();
  const double l = 1, c = 0.01, w = 0.5;
  Body arm{"arm", 1e-9, 1e-9};
  scene.bodies = {arm, scene.bodies[0]};
  Hinge root = scene.hinges[0];
  root.name = "arm_root";
  root.child_point = {0, 0};
  scene.hinges[0].parent = 0, scene.hinges[0].child = 1;
  scene.hinges[0].parent_point = {l, 0}, scene.hinges[0].child_point = {-c, 0};
  scene.hinges.push_back(root);
  oracle::AnyMotion<BaseMotion::fixed> motion(scene, 1, 0.2, 0);
  turn_steadily(motion, {0, 0.5 * std::numbers::pi}, {w, -2 * w});
  const double part = part_in_middle(motion, 2);
  CHECK(part < 0.75 + 1e-6);
  CHECK(part > 0.7);
}

namespace {

/// The largest rise, in parts of the load's size, of wings whose hinges stick on a base that turns steadily.
template <BaseMotion M> double rise_of_rigid_wings() {
  double most = 0;
  for (int k = 0; k < 30; ++k) {
    oracle::RandomScene options;
    options.bodies = 1 + k % 6, options.motion = M;
    Scene scene = random_scene(800 + k, options);
    scene.base.acceleration = {0, 0}, scene.base.angular_acceleration = 0;
    if (k % 3 == 0 && M == BaseMotion::prescribed) {
      scene.environment.air_density = 1.2;
      for (Body& body : scene.bodies) body.plate = Plate{{-0.5, 0}, {1, 0}, 2, 1.5};
    }
    AnyMotion<M> motion(scene, 300 + k, 0.3, 0);
    Step<double>& step = motion.step;
    for (int i = 1; i <= motion.wing.size(); ++i) {
      const int a = motion.system.layout().angle(i), r = motion.system.layout().rate(i);
      step.x1[a] = step.x[a];
      for (State<double>* x : {&step.x, &step.x1, &step.dxdt, &step.dxdt1}) (*x)[r] = 0;
      step.dxdt[a] = step.dxdt1[a] = 0;
    }
    const HeldLoadBound<double> bound = bound_of(motion);
    for (int i = 1; i <= motion.wing.size(); ++i) {
      CHECK(bound.size(i) >= motion.loads(0.3)[i] * (1 - 1e-6));
      most = std::max(most, bound.rise(i) / bound.size(i));
    }
  }
  return most;
}

} // namespace

TEST_CASE("what a locked hinge bears does not rise on a wing that turns steadily as one body") {
  CHECK(rise_of_rigid_wings<BaseMotion::prescribed>() < 1e-10);
  CHECK(rise_of_rigid_wings<BaseMotion::free>() < 1e-10);
}

TEST_CASE("the bound on what holds a hinge knows bases that are driven by tables") {
  CHECK(most_of_friction<BaseMotion::prescribed>(nothing, true) > 0.05);
}

TEST_CASE("the bound on what holds a hinge knows its loops: taut, slack and by tables") {
  oracle::RealFeatures features = nothing;
  features.loops = true;
  CHECK(most_of_friction<BaseMotion::fixed>(features, false) > 0.05);
  features.preloads = true;
  CHECK(most_of_friction<BaseMotion::fixed>(features, false) > 0.05);
  features.tables = true;
  CHECK(most_of_friction<BaseMotion::free>(features, false) > 0.05);
}

TEST_CASE("the bound on what holds a hinge knows gravity and the air") {
  oracle::RealFeatures features = nothing;
  features.gravity = features.air = true;
  CHECK(most_of_friction<BaseMotion::prescribed>(features, false) > 0.02);
  CHECK(most_of_friction<BaseMotion::free>(features, false) > 0.02);
  CHECK(most_of_friction<BaseMotion::prescribed>(features, true) > 0.02);
}

TEST_CASE("the bound on what holds a hinge holds where one part of it outweighs the others") {
  oracle::RealFeatures air = nothing, loops = nothing;
  air.air = true, loops.loops = loops.preloads = true;
  CHECK(most_of_friction<BaseMotion::fixed>(air, false, {.air = 1e6}, 12) > 0.02);
  CHECK(most_of_friction<BaseMotion::free>(air, false, {.air = 1e6}, 12) > 0.02);
  CHECK(most_of_friction<BaseMotion::fixed>(loops, false, {.stiffness = 1e-6}, 12) > 0.05);
  CHECK(most_of_friction<BaseMotion::fixed>(loops, false, {.stiffness = 1e-6, .slackens = true},
                                            30) > 0.05);
  loops.tables = true;
  CHECK(most_of_friction<BaseMotion::fixed>(loops, false, {.stiffness = 1e-6}, 12) > 0.05);
  CHECK(most_of_friction<BaseMotion::prescribed>(nothing, true, {.inertia = 1e6}, 12) > 0.05);
}

// A motor's moment at rest is its gain times the commanded rate, which a table gives as any cubic of time.
TEST_CASE("the bound on what holds a hinge knows its motor's command") {
  oracle::Draws draws(8100);
  double most = 0;
  for (int k = 0; k < 200; ++k) {
    Scene scene = oracle::latching_panel();
    scene.hinges[0].motor =
        Motor{.rate = 1, .gain = draws.log_uniform(0.1, 10), .torque_limit = 1e9};
    AnyMotion<BaseMotion::fixed> motion(scene, 1, draws.log_uniform(0.01, 10), 0);
    turn_steadily(motion, {0.3}, {0.0});
    MotorPiece<double>& piece = motion.system.writable_workspace().motors[1];
    piece.runs = k % 8 == 0 ? 0 : 1;
    piece.from = motion.step.t - draws.uniform(0, 3);
    for (double& c : piece.rate) c = draws.uniform(-5, 5);
    HeldLoadBound<double> bound;
    bound.over_step(motion.system, motion.step);
    const auto friction = [&](double s) {
      const double u = motion.step.t + s * motion.step.h - piece.from;
      return piece.runs * motion.wing.motors[1].gain *
             std::abs(piece.rate[0] +
                      u * (piece.rate[1] + u * (piece.rate[2] + u * piece.rate[3])));
    };
    CAPTURE(k);
    for (const auto& [from, to] : {std::pair(0., 1.), {0., 0.5}, {0.75, 1.}, {0.4, 0.41}}) {
      const double ends = std::max(friction(from), friction(to));
      const double allowed = bound.friction(1, from, to).most;
      double rise = 0;
      for (int n = 1; n < 40; ++n)
        rise = std::max(rise, friction(from + (to - from) * n / 40) - ends);
      CHECK(rise <= allowed * (1 + 1e-9));
      if (piece.runs == 0)
        CHECK(allowed == 0);
      else
        most = std::max(most, rise / allowed);
    }
  }
  CHECK(most > 0.1); // it is not ten times too large everywhere
}
