#include "tests/support/random_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace wingspread::oracle {

using std::numbers::pi;

double Draws::uniform(double lower, double upper) {
  return lower + (upper - lower) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
}

double Draws::log_uniform(double lower, double upper) {
  return std::exp(uniform(std::log(lower), std::log(upper)));
}

double Draws::sign() { return chance(0.5) ? 1 : -1; }

bool Draws::chance(double probability) { return uniform(0, 1) < probability; }

int Draws::below(int count) { return static_cast<int>(uniform(0, count)); }

Eigen::Vector2d Draws::vector(double reach) {
  const double x = uniform(-reach, reach);
  return {x, uniform(-reach, reach)};
}

namespace {

std::vector<int> permutation(int count, Draws& draws) {
  std::vector<int> order(count);
  for (int i = 0; i < count; ++i) {
    order[i] = i;
    std::swap(order[i], order[draws.below(i + 1)]);
  }
  return order;
}

Base random_base(const RandomScene& options, Draws& draws) {
  constexpr std::array all{BaseMotion::fixed, BaseMotion::prescribed, BaseMotion::free};
  Base base;
  base.motion = options.motion ? *options.motion : all[draws.below(3)];
  base.acceleration = draws.vector(1);
  base.angular_acceleration = draws.uniform(-0.5, 0.5);
  base.angle = draws.uniform(-pi, pi);
  base.rate = draws.uniform(-0.5, 0.5);
  base.mass = draws.log_uniform(10, 1000);
  base.inertia = base.mass * draws.log_uniform(0.1, 1);
  base.position = draws.vector(2);
  base.velocity = draws.vector(1);
  return base;
}

Hinge random_hinge(const RandomScene& options, Draws& draws) {
  Hinge hinge;
  hinge.parent_point = draws.vector(options.reach);
  hinge.child_point = draws.vector(options.reach);
  hinge.stowed = draws.sign() * draws.uniform(0.5, pi);
  hinge.latched = draws.uniform(-0.3, 0.3);
  hinge.initial_rate = draws.uniform(-0.1, 0.1);
  if (options.springs) hinge.spring = {draws.uniform(1, 5), draws.uniform(0.5, 2)};
  if (options.harness) hinge.harness = {draws.uniform(0, 0.1), draws.uniform(0, 0.4)};
  if (options.friction) {
    hinge.friction.coulomb = draws.uniform(0, 0.2);
    hinge.friction.viscous = draws.uniform(0, 0.5);
    hinge.friction.regularization_rate = draws.log_uniform(1e-3, 1e-1);
  }
  if (options.latches) hinge.latch = {draws.log_uniform(1e2, 1e5), draws.log_uniform(1, 200)};
  return hinge;
}

/// A panel hinge of the seed scene, which latches at 0.
Hinge panel_hinge(std::string name, int parent, int child, double stowed, HingeTorque spring) {
  Hinge hinge;
  hinge.name = std::move(name);
  hinge.parent = parent;
  hinge.child = child;
  hinge.stowed = stowed;
  hinge.spring = spring;
  hinge.latch = Latch{1e4, 100};
  return hinge;
}

/// The mirror image of a hinge: x → −x, and angles change sign. `offset` is added to the numbers of its bodies.
Hinge mirrored(Hinge hinge, int offset, const std::string& prefix) {
  hinge.name = prefix + hinge.name;
  if (hinge.parent != base_index) hinge.parent += offset;
  hinge.child += offset;
  hinge.parent_point.x() *= -1;
  hinge.child_point.x() *= -1;
  hinge.stowed *= -1;
  hinge.latched *= -1;
  hinge.initial_rate *= -1;
  return hinge;
}

/// A spacecraft with the first `panels` panels of the seed scene on its right,
/// and mirrored on its left.
Scene two_wings(std::string name, int panels) {
  const Scene wing = seed_scene();
  Scene scene;
  scene.name = std::move(name);
  scene.base.motion = BaseMotion::free;
  scene.base.mass = 200;
  scene.base.inertia = 80;
  for (int i = 0; i < 2 * panels; ++i)
    scene.bodies.push_back({"panel_" + std::to_string(i + 1), 10, 0.5});
  for (int i = 0; i < panels; ++i) {
    Hinge hinge = wing.hinges[i];
    if (hinge.parent == base_index) hinge.parent_point = {0.5, 0.1};
    scene.hinges.push_back(hinge);
  }
  for (int i = 0; i < panels; ++i)
    scene.hinges.push_back(mirrored(scene.hinges[i], panels, "left_"));
  return scene;
}

} // namespace

Scene random_scene(std::uint64_t seed, const RandomScene& options) {
  Draws draws(seed);
  const int n = options.bodies;
  Scene scene;
  scene.name = "random_" + std::to_string(seed);
  scene.base = random_base(options, draws);
  const std::vector<int> body_at = permutation(n, draws);
  const std::vector<int> hinge_at = permutation(n, draws);
  scene.bodies.resize(n);
  scene.hinges.resize(n);
  for (int i = 0; i < n; ++i) {
    Body& body = scene.bodies[body_at[i]];
    body.name = "body_" + std::to_string(i + 1);
    body.mass = draws.log_uniform(options.mass_lower, options.mass_upper);
    body.inertia = body.mass * options.reach * options.reach * draws.log_uniform(0.02, 0.5);
    Hinge hinge = random_hinge(options, draws);
    hinge.name = "hinge_" + std::to_string(i + 1);
    const int parent = options.branching ? draws.below(i + 1) - 1 : i - 1;
    hinge.parent = parent < 0 ? base_index : body_at[parent];
    hinge.child = body_at[i];
    scene.hinges[hinge_at[i]] = hinge;
  }
  return scene;
}

WingState<double> random_state(std::uint64_t seed, const Scene& scene) {
  Draws draws(seed);
  const int n = static_cast<int>(scene.hinges.size());
  WingState<double> state;
  state.angles.resize(n);
  state.rates.resize(n);
  state.engagement.resize(n);
  for (int i = 0; i < n; ++i) {
    state.angles(i) = draws.uniform(-pi, pi);
    state.rates(i) = draws.uniform(-2, 2);
    const bool engaged = draws.chance(0.5);
    state.engagement(i) = engaged && scene.hinges[i].latch ? 1 : 0;
  }
  if (scene.base.motion == BaseMotion::fixed) return state;
  state.base_angle = draws.uniform(-pi, pi);
  state.base_rate = draws.uniform(-1, 1);
  if (scene.base.motion == BaseMotion::prescribed) return state;
  state.base_position = draws.vector(3);
  state.base_velocity = draws.vector(1);
  return state;
}

Scene seed_scene() {
  Scene scene;
  scene.name = "three_panel";
  for (const char* name : {"panel_1", "panel_2", "panel_3"})
    scene.bodies.push_back({name, 10, 0.5});
  scene.hinges = {panel_hinge("root", base_index, 0, 1.5707963267948966, {2.0, 1.4}),
                  panel_hinge("mid", 0, 1, -3.141592653589793, {1.5, 0.5}),
                  panel_hinge("tip", 1, 2, 3.141592653589793, {0.75, 0.1})};
  scene.hinges[0].child_point = {-0.505, 0.02};
  scene.hinges[1].parent_point = {0.505, -0.02};
  scene.hinges[1].child_point = {-0.505, -0.02};
  scene.hinges[2].parent_point = {0.505, 0.02};
  scene.hinges[2].child_point = {-0.505, 0.02};
  return scene;
}

Scene two_wing_free_spacecraft() {
  Scene scene = two_wings("two_wing_free_spacecraft", 3);
  scene.base.position = {1, -2};
  scene.base.velocity = {0.03, 0.02};
  scene.base.angle = 0.3;
  scene.base.rate = 0.05;
  for (Hinge& hinge : scene.hinges) {
    if (!hinge.name.starts_with("left_")) continue;
    hinge.spring.torque_stowed *= 1.03;
    hinge.spring.torque_latched *= 1.03;
  }
  return scene;
}

Scene symmetric_tree() { return two_wings("symmetric_tree", 2); }

Scene harmonic_panel() {
  Scene scene;
  scene.name = "harmonic_panel";
  scene.bodies = {{"panel", 10, 0.5}};
  scene.hinges = {panel_hinge("root", base_index, 0, pi / 2, {2, 0})};
  scene.hinges[0].child_point = {-0.5, 0};
  scene.hinges[0].latch.reset();
  return scene;
}

Scene latching_panel() {
  Scene scene = harmonic_panel();
  scene.name = "latching_panel";
  scene.hinges[0].spring = {2, 2};
  scene.hinges[0].latch = Latch{1e4, 100};
  return scene;
}

} // namespace wingspread::oracle
