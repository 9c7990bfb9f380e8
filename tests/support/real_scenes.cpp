#include "tests/support/real_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace wingspread::oracle {

using std::numbers::pi;

std::shared_ptr<const TorqueTable> torque_table(std::vector<double> angle,
                                                std::vector<double> torque, Interpolation how) {
  return std::make_shared<const TorqueTable>(std::move(angle), std::move(torque), how);
}

std::shared_ptr<const TorqueTable> torque_table(std::vector<double> angle,
                                                std::vector<double> deploying,
                                                std::vector<double> stowing, Interpolation how) {
  return std::make_shared<const TorqueTable>(std::move(angle), std::move(deploying),
                                             std::move(stowing), how);
}

void tabulate(Synchronisation& loop, std::vector<double> travel,
              std::vector<double> travel_of_second) {
  loop.travel = travel, loop.travel_of_second = travel_of_second;
  loop.table = std::make_shared<const Curve>(std::move(travel), std::move(travel_of_second),
                                             Interpolation::monotone, Beyond::straight);
}

namespace {

/// Knots from about the stowed to about the latched angle, in that order, uneven.
std::vector<double> knots(const Hinge& hinge, int count, Draws& draws) {
  const double step = (hinge.latched - hinge.stowed) / (count - 1);
  std::vector<double> angles;
  for (int k = 0; k < count; ++k)
    angles.push_back(hinge.stowed + step * (k + draws.uniform(-0.4, 0.4)));
  return angles;
}

std::vector<double> torques(int count, double lower, double upper, Draws& draws) {
  std::vector<double> result;
  for (int k = 0; k < count; ++k) result.push_back(draws.uniform(lower, upper));
  return result;
}

Interpolation interpolation(Draws& draws) {
  return draws.chance(0.7) ? Interpolation::monotone : Interpolation::linear;
}

/// Torques measured while stowing: at least 0.05 N·m above those measured while deploying, between the knots too.
std::vector<double> stowing_above(const std::vector<double>& angle,
                                  const std::vector<double>& deploying, Interpolation how,
                                  Draws& draws) {
  std::vector<double> stowing = deploying;
  for (double& torque : stowing) torque += draws.uniform(0, 0.3);
  const Table<double> out(angle, deploying, how, Beyond::constant);
  const Table<double> back(angle, stowing, how, Beyond::constant);
  double least = 1;
  for (int k = 0; k <= 1000; ++k) {
    const double x = angle.front() + (angle.back() - angle.front()) * k / 1000;
    least = std::min(least, back.value(x) - out.value(x));
  }
  for (double& torque : stowing) torque += 0.05 - std::min(least, 0.0);
  return stowing;
}

void draw_tables(Hinge& hinge, const RealFeatures& features, Draws& draws) {
  if (features.tables && draws.chance(0.5)) {
    const int count = 2 + draws.below(5);
    hinge.harness.table = torque_table(knots(hinge, count, draws), torques(count, 0, 0.4, draws),
                                       interpolation(draws));
  }
  const bool both_ways = features.measured && draws.chance(0.5);
  if (!both_ways && !(features.tables && draws.chance(0.5))) return;
  const int count = 2 + draws.below(5);
  const Interpolation how = interpolation(draws);
  const std::vector<double> angle = knots(hinge, count, draws);
  const std::vector<double> torque = torques(count, 0.5, 5, draws);
  hinge.spring.table =
      both_ways ? torque_table(angle, torque, stowing_above(angle, torque, how, draws), how)
                : torque_table(angle, torque, how);
}

void draw_scales(Hinge& hinge, Draws& draws) {
  for (HingeTorque* torque : {&hinge.spring, &hinge.harness}) {
    if (draws.chance(0.5)) torque->scale = draws.uniform(0.8, 1.2);
    if (draws.chance(0.5)) torque->offset = draws.uniform(-0.1, 0.1);
  }
  if (draws.chance(0.5)) hinge.friction.scale = draws.uniform(0.5, 2);
  if (hinge.damper && draws.chance(0.5)) hinge.damper->scale = draws.uniform(0.5, 2);
}

Damper random_damper(const Hinge& hinge, const RealFeatures& features, Draws& draws) {
  Damper damper;
  damper.law = static_cast<DamperLaw>(draws.below(3));
  damper.coefficient = draws.uniform(0.1, 2);
  damper.exponent = draws.uniform(0.4, 2);
  damper.regularization_rate = draws.log_uniform(1e-3, 1e-1);
  damper.peak_torque = draws.uniform(0.1, 2);
  damper.peak_rate = draws.uniform(0.1, 2);
  if (!features.windows || !draws.chance(0.5)) return damper;
  const double way = hinge.latched - hinge.stowed;
  const double from = hinge.stowed + way * draws.uniform(0, 0.4);
  const double to = hinge.stowed + way * draws.uniform(0.6, 1.1);
  damper.window = {from, to};
  if (draws.chance(0.5)) std::swap((*damper.window)[0], (*damper.window)[1]);
  return damper;
}

void draw_hinge(Hinge& hinge, const RealFeatures& features, Draws& draws) {
  draw_tables(hinge, features, draws);
  if (features.dampers && draws.chance(0.5)) hinge.damper = random_damper(hinge, features, draws);
  if (features.stops && draws.chance(0.5))
    hinge.stop = Stop{draws.log_uniform(features.softest, features.stiffest),
                      draws.chance(0.5) ? draws.uniform(0, 2) : 0,
                      draws.chance(0.5) ? draws.uniform(0, 0.1) : 0};
  if (features.backlash && hinge.latch && draws.chance(0.5))
    hinge.latch->backlash = draws.log_uniform(1e-3, 1e-1);
  if (features.scales) draw_scales(hinge, draws);
}

/// Draws a loop's table, which passes through (0, 0), where both hinges are stowed, and ends before they are latched.
void draw_table(Synchronisation& loop, Draws& draws) {
  std::vector<double> x{0}, y{0};
  const int count = 1 + draws.below(4);
  for (int k = 0; k < count; ++k) {
    x.push_back(x.back() + draws.uniform(0.2, 1));
    y.push_back(y.back() + loop.ratio * draws.uniform(0.1, 1));
  }
  tabulate(loop, x, y);
}

Synchronisation random_loop(int first, int second, const RealFeatures& features, Draws& draws) {
  Synchronisation loop;
  loop.name = "loop_" + std::to_string(first) + "_" + std::to_string(second);
  loop.first = first, loop.second = second;
  loop.ratio = draws.sign() * draws.uniform(0.5, 2);
  loop.stiffness = draws.log_uniform(features.softest, features.stiffest);
  if (draws.chance(0.7)) loop.damping = draws.log_uniform(1e-2, 10);
  if (features.preloads && draws.chance(0.5))
    loop.preload = loop.stiffness * draws.log_uniform(1e-3, 1);
  if (features.tables && draws.chance(0.5)) draw_table(loop, draws);
  return loop;
}

void draw_loops(Scene& scene, const RealFeatures& features, Draws& draws) {
  const int n = static_cast<int>(scene.hinges.size());
  for (int k = 0; n > 1 && k < n; ++k) {
    if (!draws.chance(0.5)) continue;
    const int first = draws.below(n), second = (first + 1 + draws.below(n - 1)) % n;
    scene.synchronisations.push_back(random_loop(first, second, features, draws));
  }
}

} // namespace

Scene with_real_hinges(Scene scene, std::uint64_t seed, const RealFeatures& features) {
  Draws draws(seed), of_latches(seed + 9000);
  scene.name += "_with_real_hinges_" + std::to_string(seed);
  for (Hinge& hinge : scene.hinges) draw_hinge(hinge, features, draws);
  for (Hinge& hinge : scene.hinges)
    if (hinge.latch && features.dissipation && of_latches.chance(0.5))
      hinge.latch->damping = 0, hinge.latch->dissipation = of_latches.log_uniform(0.1, 5);
  if (features.loops) draw_loops(scene, features, draws);
  if (features.gravity && draws.chance(0.5)) scene.environment.gravity = draws.vector(10);
  if (!features.air || !draws.chance(0.5)) return scene;
  scene.environment.air_density = draws.uniform(0.5, 1.5);
  for (Body& body : scene.bodies) {
    if (!draws.chance(0.7)) continue;
    const Eigen::Vector2d from = draws.vector(1);
    body.plate = Plate{from, draws.vector(1), draws.uniform(0.2, 2), draws.uniform(1, 2)};
  }
  return scene;
}

Scene driven_by_table(Scene scene, std::uint64_t seed, double t_end) {
  Draws draws(seed + 5000);
  const int count = 2 + draws.below(7);
  BaseTable::Columns columns;
  double at = t_end * draws.uniform(-0.2, 0.3);
  for (int k = 0; k < count; ++k, at += 2 * t_end / count * draws.uniform(0.1, 1))
    columns.time.push_back(at);
  const auto column = [&](double largest) { return torques(count, -largest, largest, draws); };
  const bool turns = draws.chance(0.7);
  if (!turns || draws.chance(0.6))
    for (int k = 0; k < count; ++k) columns.acceleration.push_back(draws.vector(3));
  if (turns) (draws.chance(0.5) ? columns.rate : columns.angular_acceleration) = column(1.5);
  Base base;
  base.motion = BaseMotion::prescribed;
  base.acceleration = draws.vector(1), base.angular_acceleration = draws.uniform(-0.3, 0.3);
  base.angle = draws.uniform(-3, 3), base.rate = draws.uniform(-0.5, 0.5);
  base.table_scale = draws.chance(0.5) ? draws.uniform(0.5, 1.5) : 1;
  const Interpolation how = draws.chance(0.5) ? Interpolation::monotone : Interpolation::linear;
  base.table = std::make_shared<const BaseTable>(std::move(columns), how);
  scene.base = base;
  return scene;
}

namespace {

/// A uniform panel's hinge: from its parent's outer end to its own inner one.
Hinge end_hinge(std::string name, int number, double parents_length, double length) {
  Hinge hinge;
  hinge.name = std::move(name);
  hinge.parent = number == 0 ? base_index : number - 1;
  hinge.child = number;
  if (number > 0) hinge.parent_point = {parents_length / 2, 0};
  hinge.child_point = {-length / 2, 0};
  return hinge;
}

} // namespace

Scene EqualPanels::scene() const {
  Scene scene;
  scene.name = "equal_panels";
  for (int i = 0; i < panels; ++i) {
    const std::string number = std::to_string(i + 1);
    scene.bodies.push_back({"panel_" + number, mass, mass * length * length / 12, {}});
    Hinge hinge = end_hinge("hinge_" + number, i, length, length);
    // folded at 0: every other panel lies the other way in its own frame
    if (i % 2) hinge.child_point.x() *= -1;
    if (i > 0 && i % 2 == 0) hinge.parent_point.x() *= -1;
    hinge.latched = i == 0 ? pi / 2 : i % 2 ? -pi : pi;
    const double level = i == 0 ? 0.1 : 0.05, end = i == 0 ? pi : 1.5 * pi;
    const double way = std::abs(hinge.latched);
    hinge.spring.torque_stowed = level * end;
    hinge.spring.torque_latched = level * (end - way);
    if (i == 0) hinge.latch = Latch{};
    scene.hinges.push_back(hinge);
    if (i == 0) continue;
    Synchronisation loop;
    loop.name = "loop_" + number;
    loop.first = i - 1, loop.second = i;
    loop.ratio = i == 1 ? 2 : 1;
    loop.stiffness = stiffness, loop.damping = damping;
    scene.synchronisations.push_back(loop);
  }
  return scene;
}

Scene free_panel(double stowed, double initial_rate) {
  Scene scene = latching_panel();
  scene.name = "free_panel";
  Hinge& hinge = scene.hinges[0];
  hinge.stowed = stowed, hinge.latched = stowed + 1, hinge.initial_rate = initial_rate;
  hinge.spring = {};
  hinge.latch.reset();
  return scene;
}

Scene yoke_wing() {
  constexpr double lengths[] = {0.8, 1.8, 1.8, 1.8, 1.8}, masses[] = {2, 8, 8, 8, 8};
  Scene scene;
  scene.name = "yoke_wing";
  for (int i = 0; i < 5; ++i) {
    const std::string name = i == 0 ? "yoke" : "panel_" + std::to_string(i);
    scene.bodies.push_back({name, masses[i], masses[i] * lengths[i] * lengths[i] / 12, {}});
    Hinge hinge =
        end_hinge(i == 0 ? "root" : "h" + std::to_string(i), i, i ? lengths[i - 1] : 0, lengths[i]);
    hinge.stowed = i == 0 ? pi / 2 : i % 2 ? -pi : pi;
    hinge.spring.torque_stowed = i == 0 ? 3 : 1.5;
    hinge.spring.torque_latched = i == 0 ? 1.5 : 0.5;
    hinge.harness.torque_stowed = 0.05, hinge.harness.torque_latched = 0.15;
    hinge.friction.viscous = 0.2;
    hinge.latch = Latch{2e4, 100, 0};
    scene.hinges.push_back(hinge);
  }
  return scene;
}

Scene yoke_wing_with_stops() {
  Scene scene = yoke_wing();
  scene.name = "yoke_wing_with_stops";
  for (Hinge& hinge : scene.hinges) hinge.stop = Stop{5e3, 0.5, 0};
  return scene;
}

} // namespace wingspread::oracle
