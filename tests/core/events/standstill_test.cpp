// Whether the loads on a wing that sticks are constant: held against the loads at later times.
#include "core/events/standstill.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The values of a table's column: several are as the one before, some are 0.
std::vector<double> steps_of_table(std::size_t count, Draws& draws) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    const bool as_before = k > 0 && draws.chance(0.7);
    values.push_back(as_before ? values.back() : draws.chance(0.4) ? 0 : draws.uniform(-1, 1));
  }
  if (draws.chance(0.4)) values.back() = 0;
  return values;
}

/// Drives a base by a table whose values often stay as they are from knot to knot; constant from last_knot on.
void drive_by_steps(Base& base, Draws& draws) {
  BaseTable::Columns columns;
  for (double t = draws.uniform(-0.5, 0.5); columns.time.size() < 4; t += draws.uniform(0.2, 1))
    columns.time.push_back(t);
  if (draws.chance(0.5)) {
    const bool coasts = draws.chance(0.5); // at a velocity, after the table
    std::vector<double> x = steps_of_table(4, draws), y = steps_of_table(4, draws);
    if (coasts) x.back() = y.back() = 0;
    for (int k = 0; k < 4; ++k) columns.acceleration.emplace_back(x[k], y[k]);
  }
  (draws.chance(0.5) ? columns.rate : columns.angular_acceleration) = steps_of_table(4, draws);
  base.table = std::make_shared<const BaseTable>(std::move(columns), Interpolation::linear);
}

constexpr double last_knot = 4; ///< of all tables, s, at the latest

/// A wing at rest in its hinges, all of which stick.
template <BaseMotion M> struct StuckWing {
  StuckWing(std::uint64_t seed, double t) : draws(seed), now(t) {
    RandomScene options;
    options.bodies = 1 + draws.below(3), options.motion = M;
    scene = random_scene(seed, options);
    scene.base.acceleration = draws.chance(0.5) ? draws.vector(3) : Eigen::Vector2d{0, 0};
    scene.base.angular_acceleration = draws.chance(0.3) ? draws.uniform(-1, 1) : 0;
    if (draws.chance(0.5)) scene.base.rate = 0;
    if (M == BaseMotion::prescribed && draws.chance(0.6)) drive_by_steps(scene.base, draws);
    if (M != BaseMotion::free && draws.chance(0.3)) scene.environment.gravity = draws.vector(3);
    if (draws.chance(0.4)) {
      scene.environment.air_density = 1.2;
      for (Body& body : scene.bodies) body.plate = Plate{{-0.5, 0.1}, {1, 0}, 2, 1.5};
    }
    if (draws.chance(0.3)) drive_hinge(scene.hinges[0]);
    wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    const std::optional<double> width = draws.chance(0.5) ? std::optional(0.5) : std::nullopt;
    system.emplace(wing, width, work);
    start();
  }

  [[nodiscard]] bool claims() const { return loads_are_constant(*system, x); }
  [[nodiscard]] bool in_air() const { return !wing.plates.empty(); }

  /// The largest change of a load up to 5 s from now, as a part of the loads.
  [[nodiscard]] double change() {
    const std::vector<double> before = loads(now);
    double most = 0, size = 1e-3;
    for (int k = 1; k <= 40; ++k) {
      const std::vector<double> later = loads(now + k / 8.0);
      for (std::size_t i = 0; i < later.size(); ++i) {
        most = std::max(most, std::abs(later[i] - before[i]));
        size = std::max(size, std::abs(later[i]));
      }
    }
    return most / size;
  }

private:
  void drive_hinge(Hinge& hinge) {
    Motor motor{.rate = 0.2, .gain = 3, .torque_limit = 2};
    if (draws.chance(0.7)) {
      motor.time = {0, 1, 2}, motor.rates = steps_of_table(3, draws);
      motor.interpolation = Interpolation::linear;
      motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
    }
    hinge.motor = motor;
  }

  void start() {
    system->start(x);
    const Layout& at = system->layout();
    for (int i = 1; i <= at.bodies; ++i) {
      const HingeTerms<double>& hinge = wing.hinges[i];
      x[at.angle(i)] = hinge.latched + hinge.sense * draws.uniform(-1, 0.7);
      x[at.rate(i)] = 0;
      if (at.smoothed) x[at.latch(i)] = draws.chance(0.5) ? 0 : draws.uniform(0, 1);
      system->set_contact(i, Contact::stuck);
    }
    system->enter_piece(now);
  }

  /// What locks the hinges at t, N·m. Forwards in time only.
  [[nodiscard]] std::vector<double> loads(double t) {
    const Layout& at = system->layout();
    State<double> there = x, dxdt = x;
    system->enter_piece(t);
    if (M == BaseMotion::free) there[2] += (t - now) * x[2 + at.freedoms()];
    for (int i = 1; at.smoothed && i <= at.bodies; ++i)
      there[at.latch(i)] +=
          (t - now) * engagement_rate(wing.hinges[i], x[at.angle(i)], system->epsilon());
    (*system)(there, dxdt, t);
    std::vector<double> found;
    for (int i = 1; i <= at.bodies; ++i) found.push_back(system->locking_moment(there, i));
    return found;
  }

  Draws draws;
  double now;
  Scene scene; ///< the wing refers to its tables
  Wing<double> wing;
  Workspace<double> work;
  std::optional<System<double, Tree, M>> system;
  State<double> x;
};

/// @return how often the loads were said to be constant, and how often not
template <BaseMotion M> std::pair<int, int> claims_of_random_wings() {
  int constant = 0, changing = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const double t = seed % 2 == 0 ? last_knot : Draws(seed + 7).uniform(0, last_knot);
    StuckWing<M> stuck(seed, t);
    const bool claims = stuck.claims();
    CAPTURE(seed, t);
    if (M == BaseMotion::free && stuck.in_air()) {
      CHECK_FALSE(claims); // the air brakes the base
      continue;
    }
    const double change = stuck.change();
    CAPTURE(change);
    if (claims) CHECK(change < 1e-9);
    if (t == last_knot && change < 1e-12) CHECK(claims); // and a run may end
    ++(claims ? constant : changing);
  }
  return {constant, changing};
}

} // namespace

TEST_CASE("loads on a wing that sticks are said to be constant where they are, and nowhere else") {
  for (const auto& [constant, changing] : {claims_of_random_wings<BaseMotion::fixed>(),
                                           claims_of_random_wings<BaseMotion::prescribed>(),
                                           claims_of_random_wings<BaseMotion::free>()}) {
    CHECK(constant > 200);
    CHECK(changing > 200);
  }
}
