#include "tests/support/bending_scenes.hpp"

#include "tests/support/random_scenes.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace wingspread::oracle {

namespace {

/// One body's parts along its plate, by coordinates from the centre of mass.
struct Strip {
  Eigen::Vector2d along;
  double length;
  std::vector<double> stations; ///< where parts end and begin, the plate's ends first and last

  explicit Strip(const Body& body)
      : along(body.plate->to - body.plate->from), length(along.norm()) {
    along /= length;
    const int n = body.flexible->joints;
    stations.push_back(-length / 2);
    for (int k = 1; k <= n; ++k) stations.push_back(length * ((2 * k - 1) / (2.0 * n) - 0.5));
    stations.push_back(length / 2);
  }

  [[nodiscard]] int parts() const { return static_cast<int>(stations.size()) - 1; }
  [[nodiscard]] double middle(int k) const { return (stations[k] + stations[k + 1]) / 2; }
  [[nodiscard]] double share(int k) const { return (stations[k + 1] - stations[k]) / length; }
  [[nodiscard]] int part_at(const Eigen::Vector2d& point) const {
    int k = 0;
    while (k + 1 < parts() && along.dot(point) >= stations[k + 1]) ++k;
    return k;
  }
  [[nodiscard]] Eigen::Vector2d in_part(int k, const Eigen::Vector2d& point) const {
    return point - middle(k) * along;
  }
};

double stiffness_of(const Body& body, double length) {
  const Flexible& flexible = *body.flexible;
  if (flexible.bending_stiffness) return *flexible.bending_stiffness;
  const double wave = std::pow(cantilever_roots[0], 2);
  return std::pow(2 * std::numbers::pi * *flexible.frequency / wave, 2) * body.mass *
         std::pow(length, 3);
}

void cut(Segmented& made, const Scene& given, int b) {
  const Body& body = given.bodies[b];
  const Strip strip(body);
  // a part's own inertia as a rod's; what the body has beyond a rod goes by mass. No less than a rod
  double points = 0, rods = 0;
  const auto rod = [&](int k) {
    return body.mass * std::pow(strip.share(k), 3) * std::pow(strip.length, 2) / 12;
  };
  for (int k = 0; k < strip.parts(); ++k) {
    points += body.mass * strip.share(k) * std::pow(strip.middle(k), 2);
    rods += rod(k);
  }
  const double beyond = body.inertia - points - rods;
  int carrier = 0; // the part on the body's own hinge
  for (const Hinge& hinge : given.hinges)
    if (hinge.child == b) carrier = strip.part_at(hinge.child_point);
  std::vector<int> index;
  for (int k = 0; k < strip.parts(); ++k) {
    const Body part{body.name + std::to_string(k), body.mass * strip.share(k),
                    rod(k) + beyond * strip.share(k)};
    index.push_back(k == carrier ? b : static_cast<int>(made.scene.bodies.size()));
    if (k == carrier)
      made.scene.bodies[b] = part;
    else
      made.scene.bodies.push_back(part);
  }
  for (Hinge& hinge : made.scene.hinges) {
    if (hinge.child == b) hinge.child_point = strip.in_part(carrier, hinge.child_point);
    if (hinge.parent != b) continue;
    const int k = strip.part_at(hinge.parent_point);
    hinge.parent_point = strip.in_part(k, hinge.parent_point);
    hinge.parent = index[k];
  }
  const double EI = stiffness_of(body, strip.length);
  const double omega =
      std::pow(cantilever_roots[0], 2) * std::sqrt(EI / (body.mass * std::pow(strip.length, 3)));
  const double k = (strip.parts() - 1) * EI / strip.length;
  for (int j = 1; j < strip.parts(); ++j) {
    const Eigen::Vector2d place = strip.stations[j] * strip.along;
    const int outer = j > carrier ? j : j - 1, inner = j > carrier ? j - 1 : j;
    Hinge hinge;
    hinge.name = body.name + " bends " + std::to_string(j);
    hinge.parent = index[inner], hinge.child = index[outer];
    hinge.parent_point = strip.in_part(inner, place);
    hinge.child_point = strip.in_part(outer, place);
    hinge.joint = Joint{k, 2 * body.flexible->damping_ratio * k / omega};
    made.joints[b].push_back(static_cast<int>(made.scene.hinges.size()));
    made.scene.hinges.push_back(hinge);
  }
}

} // namespace

Segmented in_segments(const Scene& scene) {
  Segmented made{scene, std::vector<std::vector<int>>(scene.bodies.size())};
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b)
    if (scene.bodies[b].flexible) cut(made, scene, b);
  return made;
}

Scene with_bending(Scene scene, std::uint64_t seed) {
  Draws draws(seed ^ 0xbe7dU);
  for (std::size_t h = 1; h < scene.hinges.size(); ++h) {
    if (!draws.chance(1.0 / 3)) continue;
    Hinge& hinge = scene.hinges[h];
    hinge.spring = hinge.harness = {};
    hinge.friction = {};
    hinge.damper.reset(), hinge.stop.reset(), hinge.latch.reset();
    hinge.latched = hinge.stowed;
    hinge.joint = Joint{draws.log_uniform(10, 1e3), draws.log_uniform(1e-2, 1)};
  }
  for (Body& body : scene.bodies) {
    if (!draws.chance(0.5)) continue;
    const double angle = draws.uniform(0, 2 * std::numbers::pi);
    const double length = std::sqrt(12 * body.inertia / body.mass) * draws.uniform(0.3, 0.95);
    body.plate.emplace();
    body.plate->from = draws.vector(1);
    body.plate->to = body.plate->from + length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    Flexible& flexible = body.flexible.emplace();
    flexible.joints = 1 + draws.below(2);
    flexible.damping_ratio = draws.uniform(0, 0.05);
    const double frequency = draws.log_uniform(2, 6);
    if (draws.chance(0.5))
      flexible.frequency = frequency;
    else
      flexible.bending_stiffness =
          std::pow(2 * std::numbers::pi * frequency / 3.516, 2) * body.mass * std::pow(length, 3);
  }
  return scene;
}

Scene bending_rod(int joints, double latch_stiffness, double rate) {
  Scene scene;
  scene.name = "bending_rod";
  Body rod{"rod", 1, 1.0 / 12};
  rod.plate = Plate{{-0.5, 0}, {0.5, 0}};
  rod.flexible = Flexible{joints, 1.0};
  scene.bodies = {rod};
  Hinge hinge;
  hinge.name = "root";
  hinge.child_point = {-0.5, 0};
  hinge.stowed = -1e-9, hinge.latched = 0;
  hinge.initial_rate = rate;
  hinge.latch = Latch{latch_stiffness, 0};
  scene.hinges = {hinge};
  return scene;
}

} // namespace wingspread::oracle
