// Mirrored wings, where large terms cancel: what stuck and held hinges bear is rounding.
#include "tests/core/deployment/held_hinges.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// The scene with mirror images, left and right of the base's y axis, of all its bodies and hinges.
Scene on_both_sides(Scene scene) {
  const int n = static_cast<int>(scene.hinges.size());
  for (int i = 0; i < n; ++i) scene.bodies.push_back(scene.bodies[i]);
  for (int i = 0; i < n; ++i) {
    Hinge image = scene.hinges[i];
    image.child += n;
    if (image.parent != base_index) image.parent += n;
    image.stowed *= -1, image.latched *= -1;
    image.parent_point.x() *= -1, image.child_point.x() *= -1;
    scene.hinges.push_back(image);
  }
  return scene;
}

/// A free base with a panel that deploys, and beside it one without a spring. This one sticks `tilt` off the line along
/// which the mirrored wings push the base.
Scene moving_and_stuck(double tilt) {
  Scene scene;
  scene.base.motion = BaseMotion::free;
  scene.base.mass = 50, scene.base.inertia = 40;
  scene.bodies = {{"moving", 9.6, 3.2}, {"stuck", 5.1, 1.3}};
  scene.hinges.resize(2);
  for (int i = 0; i < 2; ++i) {
    Hinge& hinge = scene.hinges[i];
    hinge.name = scene.bodies[i].name, hinge.child = i;
    hinge.stowed = pi / 2, hinge.latch = Latch{1000, 20};
  }
  scene.hinges[0].parent_point = {0.5, 0}, scene.hinges[0].child_point = {-1, 0};
  scene.hinges[1].parent_point = {-0.5, 0}, scene.hinges[1].child_point = {-0.5, 0};
  scene.hinges[0].spring = {3, -0.3};
  scene.hinges[1].stowed += tilt;
  rub(scene.hinges[1], 30);
  return scene;
}

/// The same with random numbers, and perhaps with more panels that stick, are held, or deploy.
Scene random_wing(std::uint64_t seed) {
  Draws draws(seed);
  Scene scene = moving_and_stuck(0);
  scene.base.mass = draws.log_uniform(10, 200), scene.base.inertia = draws.log_uniform(5, 100);
  const int more = draws.below(3);
  for (int k = 0; k < more; ++k) {
    const int i = static_cast<int>(scene.bodies.size());
    scene.bodies.push_back(scene.bodies[draws.below(2)]);
    Hinge hinge = scene.hinges[draws.below(2)];
    hinge.name = hinge.name + std::to_string(i), hinge.child = i;
    const int parent = draws.below(i + 1) - 1;
    if (parent >= 0) hinge.parent = parent, hinge.parent_point = {0.5, 0}, hinge.stowed = 0.7;
    scene.hinges.push_back(hinge);
  }
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    Body& body = scene.bodies[i];
    body.mass *= draws.log_uniform(0.3, 3), body.inertia *= draws.log_uniform(0.3, 3);
    Hinge& hinge = scene.hinges[i];
    hinge.child_point.x() *= draws.log_uniform(0.5, 2);
    hinge.latch->stiffness *= draws.log_uniform(0.3, 30);
    if (hinge.friction.model == FrictionModel::exact) {
      rub(hinge, draws.log_uniform(1e-6, 100));
      if (draws.chance(0.3)) hinge.friction = {}, hinge.release = at_time(100);
    } else if (draws.chance(0.3))
      hinge.release = at_time(draws.uniform(0, 2));
  }
  return scene;
}

} // namespace

TEST_CASE("stuck hinges that bear only rounding cost no more than those that bear a load") {
  const Integration how = within(1e-8, 6);
  const Goal goal{.audit = false, .to_t_end = true};
  const auto a_step = [](const Outcome& out) {
    return static_cast<double>(out.work.rhs_evaluations) /
           static_cast<double>(out.work.steps + out.work.rejected);
  };
  int without_load = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const Scene one = random_wing(seed), two = on_both_sides(one);
    const Outcome alone = Deployment().run(one, how, goal);
    const Outcome both = Deployment().run(two, how, goal);
    REQUIRE(finite(both));
    CHECK(a_step(both) <= 10 * a_step(alone)); // without the floor 1e3 times and more
    const double moment = both.peak_moment[1].value, force = both.peak_force[1].value;
    without_load += moment < 1e-13 * force && force > 0;
    if (seed % 6 == 0) require_equal_bits({two, two, two}, how, goal);
  }
  CHECK(without_load > 10);
}

// The base moves along y and does not turn. The stuck panel's moment is therefore sin(tilt) times its arm and its force.
TEST_CASE("the peak of a small load is wrong by no more than the rounding of its terms") {
  constexpr double arm = 0.5;
  for (double tilt = 0.1; tilt > 1e-18; tilt /= 10) {
    CAPTURE(tilt);
    const Outcome out =
        Deployment().run(on_both_sides(moving_and_stuck(tilt)), within(1e-8, 6), every_peak);
    const double terms = arm * out.peak_force[1].value, load = std::sin(tilt) * terms;
    CHECK(terms > 1);
    for (const int i : {1, 3})
      CHECK(std::abs(out.peak_moment[i].value - load) <= 1e-9 * load + 1e-14 * terms);
  }
}
