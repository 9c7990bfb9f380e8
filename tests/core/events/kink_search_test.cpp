// Which kinks end a step: those whose impulse, by (1) of kinks.hpp, is beyond the tolerance, and no others.
#include "core/events/kink_search.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A panel in a step of h in which its acceleration is constant.
struct PanelInStep {
  PanelInStep(const Scene& scene, double h, double angle, double rate, double acceleration)
      : wing(make_wing<double>(scene, outward_order(scene))), system(with_parameters(scene)) {
    step.t = 0.25, step.h = h;
    system.reset();
    system.start_motor(1, 0.0);
    const auto state = [&](double u, State<double>& x, State<double>& dxdt) {
      x = {angle + u * (rate + 0.5 * acceleration * u), rate + acceleration * u};
      dxdt = {x[1], acceleration};
    };
    state(0, step.x, step.dxdt), state(h, step.x1, step.dxdt1);
    system.find_sides(step.x);
  }

  /// Checks at which relative tolerance the only kink stops to matter. @param impulse N·m·s
  void check(double s, double at, double impulse, bool with_twist = false) {
    const double rate = std::max(std::abs(step.x[1]), std::abs(step.x1[1]));
    const double limit = impulse / wing.bodies[1].central_inertia / rate;
    CAPTURE(s, at, impulse, limit, with_twist);
    const auto search = [&](double rtol) {
      return KinkSearch<double, decltype(system)>(system, step, {rtol, 0});
    };
    if (with_twist) {
      CHECK(search(limit * 0.999).first_of_hinges().value_or(-1) == Approx(s).margin(1e-9));
      CHECK_FALSE(search(limit * 1.001).first_of_hinges());
      return;
    }
    const auto found = search(limit * 0.999).first();
    REQUIRE(found);
    CHECK(found->s == Approx(s).margin(1e-9));
    CHECK(found->kink.at == Approx(at).epsilon(1e-14));
    CHECK_FALSE(search(limit * 1.001).first());
  }

  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system;
  Step<double> step;

private:
  System<double, Tree, BaseMotion::fixed> with_parameters(const Scene& scene) {
    set_parameters(wing, scene);
    return {wing, std::nullopt, work};
  }
};

/// A panel of which the hinge has no law yet.
Scene lawless_panel() {
  Scene scene = latching_panel();
  scene.hinges[0].spring = {}, scene.hinges[0].latch.reset();
  scene.hinges[0].friction = {};
  return scene;
}

/// The sense in which the hinge deploys.
double way_of(const Scene& scene) {
  return scene.hinges[0].latched > scene.hinges[0].stowed ? 1 : -1;
}

} // namespace

TEST_CASE("a step ends at a knot of a table where the slope's or the curvature's jump matters") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Draws draws(seed);
    std::vector<double> x{0}, y;
    for (int k = 0; k < 4; ++k) x.push_back(x.back() + draws.uniform(0.2, 0.5));
    for (std::size_t k = 0; k < x.size(); ++k) y.push_back(draws.uniform(-1, 1));
    const bool linear = seed % 2 == 0, harness = seed % 3 == 0;
    Scene scene = lawless_panel();
    HingeTorque& torque = harness ? scene.hinges[0].harness : scene.hinges[0].spring;
    torque.table = torque_table(x, y, linear ? Interpolation::linear : Interpolation::monotone);
    torque.scale = draws.uniform(0.5, 2);
    const Curve& curve = torque.table->drive();
    const int knot = 1 + static_cast<int>(seed % 3);
    const double at = x[knot], h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double v = draws.sign() * 0.1 / h; // no other knot within the step
    // its derivatives on both sides, from slopes
    const double d = 0.02, slope = curve.slope_at(at);
    const double low[] = {curve.slope_at(at - d), curve.slope_at(at - 2 * d)};
    const double high[] = {curve.slope_at(at + d), curve.slope_at(at + 2 * d)};
    // a slope is a parabola beside a knot: extrapolated to it, from either side
    const double below = curve.slope_at(at - 1e-13), above = slope;
    const auto second = [d](double a, double b, double c) {
      return (-3 * a + 4 * b - c) / (2 * d);
    };
    const double bend_below = -second(below, low[0], low[1]);
    const double bend_above = second(above, high[0], high[1]);
    const double third_below = (below - 2 * low[0] + low[1]) / (d * d);
    const double third_above = (above - 2 * high[0] + high[1]) / (d * d);
    const double turn = linear ? std::abs(above - below) : 0;
    const double bend = 0.5 * std::abs(bend_above - bend_below);
    const double twist = std::abs(third_above - third_below) / 6;
    const double tau = h * std::min(s, 1 - s), way = std::abs(v) * tau;
    const double impulse = torque.scale * tau * way * (turn / 2 + bend * way / 3);
    CAPTURE(seed, linear, harness, turn, bend, twist);
    PanelInStep panel(scene, h, at - v * s * h, v, 0);
    panel.check(s, at, impulse);
    panel.check(s, at, impulse + torque.scale * tau * way * way * way * twist / 4, true);
  }
}

TEST_CASE("a step ends where a damper's power law begins, if its slope's jump matters") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Draws draws(seed);
    Scene scene = lawless_panel();
    Damper damper;
    damper.law = DamperLaw::power, damper.coefficient = draws.log_uniform(0.1, 10);
    damper.exponent = draws.uniform(0.3, 2.5), damper.regularization_rate = 0.2;
    damper.scale = draws.uniform(0.5, 2);
    scene.hinges[0].damper = damper;
    const double h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double sense = draws.sign(), way = draws.sign(), a = way * 0.1 / h; // rad/s²
    PanelInStep panel(scene, h, 0.3, sense * 0.2 - a * s * h, a);
    const double steep = damper.scale * damper.coefficient * std::pow(0.2, damper.exponent - 1);
    const double tau = h * std::min(s, 1 - s);
    CAPTURE(seed, sense, way);
    panel.check(s, sense * 0.2,
                0.5 * std::abs(a) * tau * tau * steep * std::abs(1 - damper.exponent));
  }
}

TEST_CASE("a step ends where a motor reaches its limit, if its gain matters") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Draws draws(seed);
    Scene scene = lawless_panel();
    Motor motor{.rate = draws.uniform(-1, 1), .gain = draws.log_uniform(0.1, 10)};
    motor.torque_limit = motor.gain * 0.2;
    scene.hinges[0].motor = motor;
    const double h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double sense = draws.sign(), way = draws.sign(), a = way * 0.1 / h;
    PanelInStep panel(scene, h, 0.3, way_of(scene) * motor.rate - sense * 0.2 - a * s * h,
                      a); // w − φ̇ = ±T/c
    const double tau = h * std::min(s, 1 - s);
    CAPTURE(seed, sense, way);
    panel.check(s, sense * 0.2, 0.5 * std::abs(a) * tau * tau * motor.gain);
  }
}

TEST_CASE(
    "a step ends where a stop lets go of a hinge that leaves it fast, if its damping matters") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Draws draws(seed);
    const bool far = seed % 2 == 0;
    Scene scene = lawless_panel();
    Hinge& hinge = scene.hinges[0];
    const Stop stop{.stiffness = draws.log_uniform(1, 100), .dissipation = 5, .gap = 0.1};
    (far ? hinge.far_stop : hinge.stop) = stop;
    const double outward = far ? way_of(scene) : -way_of(scene); // into the stop
    const double contact = (far ? hinge.latched : hinge.stowed) + outward * stop.gap;
    const double h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double there = -outward / stop.dissipation, a = draws.sign() * 0.1 / h;
    PanelInStep panel(scene, h, contact + outward * 0.5, there - a * s * h, a);
    const double deepest = outward > 0 ? std::max(panel.step.x[0], panel.step.x1[0]) - contact
                                       : contact - std::min(panel.step.x[0], panel.step.x1[0]);
    const double tau = h * std::min(s, 1 - s);
    CAPTURE(seed, far, a, deepest);
    panel.check(s, there,
                0.5 * std::abs(a) * tau * tau * stop.stiffness * stop.dissipation * deepest);
  }
}

namespace {

/// The panel with a smoothed latch in a step in which its angle and S change uniformly.
struct SmoothedStep {
  static constexpr double epsilon = 0.1;

  SmoothedStep(const Scene& scene, double h, std::array<double, 2> angle, std::array<double, 2> S)
      : wing(make_wing<double>(scene, outward_order(scene))),
        system((set_parameters(wing, scene), wing), epsilon, work) {
    const double rate = (angle[1] - angle[0]) / h, of_latch = (S[1] - S[0]) / h;
    step.t = 0.25, step.h = h;
    step.x = {angle[0], rate, S[0]}, step.x1 = {angle[1], rate, S[1]};
    step.dxdt = step.dxdt1 = {rate, 0, of_latch};
  }

  /// Checks at which relative tolerance the only kink stops to matter.
  void check(double s, double at, double limit) {
    const auto search = [&](double rtol) {
      return KinkSearch<double, decltype(system)>(system, step, {rtol, 0}).first();
    };
    CAPTURE(s, at, limit);
    const auto found = search(limit * 0.999);
    REQUIRE(found);
    CHECK(found->s == Approx(s).margin(1e-9));
    CHECK(found->kink.at == Approx(at).margin(1e-14));
    CHECK_FALSE(search(limit * 1.001));
  }

  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system;
  Step<double> step;
};

} // namespace

// Ṡ = h(u) and the latch's share is h(S/ε): h'' jumps by 6 at either end of a step of h, its half by 3/ε² of the argument.
TEST_CASE(
    "a step ends at the ends of a smoothed latch's rise, if they matter to the latch's state") {
  constexpr double epsilon = SmoothedStep::epsilon;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Draws draws(seed);
    const Scene scene = latching_panel();
    const double at = scene.hinges[0].latched + (seed % 2 == 0 ? way_of(scene) * epsilon : 0);
    const double h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double way = draws.sign() * draws.log_uniform(0.1, 0.9) * epsilon; // passes one of both
    const double S = draws.uniform(0.1, 0.9) * epsilon;
    SmoothedStep step(scene, h, {at - way * s, at + way * (1 - s)}, {S, S});
    const double tau = std::min(s, 1 - s), passed = std::abs(way) * tau;
    step.check(s, at, h * tau * passed * passed * (3 / (epsilon * epsilon)) / 3 / S);
    SmoothedStep engaged(scene, h, {at - way * s, at + way * (1 - s)}, {epsilon, epsilon});
    CHECK_FALSE(
        KinkSearch<double, decltype(engaged.system)>(engaged.system, engaged.step, {0, 0}).first());
  }
}

TEST_CASE(
    "a step ends where a smoothed latch holds by all its might, if that matters to the hinge") {
  constexpr double epsilon = SmoothedStep::epsilon;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Draws draws(seed);
    Scene scene = latching_panel();
    Latch& latch = *scene.hinges[0].latch;
    const double k = latch.stiffness;
    if (seed % 2 == 0) latch.dissipation = 0.3, latch.damping = 0;
    const double h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double way = way_of(scene) * 0.1 * epsilon, v = std::abs(way) / h; // away from the latch
    const double first = scene.hinges[0].latched + way_of(scene) * 1.5 * epsilon; // where Ṡ is 1
    const double rise = draws.uniform(0.1, 0.5) * epsilon;
    SmoothedStep step(scene, h, {first, first + way},
                      {epsilon - rise * s, epsilon + rise * (1 - s)});
    const double y = 1.6 * epsilon;
    const double load = k * y + latch.damping * v + (seed % 2 == 0 ? k * 0.3 * y * v : 0);
    const double tau = std::min(s, 1 - s), passed = rise * tau / epsilon;
    const double inertia = step.wing.bodies[1].central_inertia;
    CAPTURE(seed, load);
    step.check(s, epsilon, h * tau * passed * passed * load / inertia / v);
  }
}

TEST_CASE("a strand that goes slack ends a step though one of the loop's hinges sticks, but not if "
          "both do") {
  Scene scene = coaxial_discs(3, 2);
  Synchronisation given;
  given.name = "loop", given.first = 0, given.second = 1, given.ratio = 1;
  given.stiffness = 100, given.damping = 10, given.preload = 20;
  scene.synchronisations = {given};
  for (const int moves : {1, 2, 0}) {
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    const Layout& at = system.layout();
    Step<double> step;
    step.t = 0, step.h = 0.1;
    system.start(step.x);
    step.x1 = step.x, step.dxdt = step.dxdt1 = State<double>(step.x.size(), 0.0);
    for (const int i : {1, 2})
      if (i != moves) system.set_contact(i, Contact::stuck);
    const double rate = 5; // 0.5 rad in the step: K e = 40 at 0.4 rad
    if (moves != 0) {
      for (State<double>* x : {&step.x, &step.x1}) (*x)[at.rate(moves)] = rate;
      step.dxdt[at.angle(moves)] = step.dxdt1[at.angle(moves)] = rate;
      step.x1[at.angle(moves)] += rate * step.h;
    }
    const auto found = KinkSearch<double, decltype(system)>(system, step, {1e-9, 0}).first();
    CAPTURE(moves);
    REQUIRE(found.has_value() == (moves != 0));
    if (found) CHECK(found->s == Approx(0.8).epsilon(1e-9));
  }
}

TEST_CASE("a step ends where a strand goes slack or taut, if that matters to either hinge") {
  int of_first = 0, of_second = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Draws draws(seed);
    const double J1 = draws.log_uniform(0.1, 10), J2 = draws.log_uniform(0.1, 10);
    Scene scene = coaxial_discs(J1, J2);
    Synchronisation given;
    given.name = "loop", given.first = 0, given.second = 1;
    given.ratio = draws.sign() * draws.uniform(0.3, 3), given.stiffness = draws.log_uniform(1, 100);
    given.damping = draws.chance(0.5) ? draws.log_uniform(1e-2, 1) : 0;
    given.preload = draws.log_uniform(1, 10);
    scene.synchronisations = {given};
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    // e = g x1 − x2 passes ±2 M_p/K by a tenth of that, at equal rates
    const double slack = 2 * *given.preload / given.stiffness, side = draws.sign();
    const double h = draws.log_uniform(1e-3, 1), s = draws.uniform(0.1, 0.9);
    const double fast = draws.sign() * 0.1 * slack / h, v1 = draws.uniform(-1, 1) * 0.1 * slack / h;
    const double v2 = given.ratio * v1 - fast, first = draws.uniform(-1, 1);
    Step<double> step;
    step.t = 0.5, step.h = h;
    step.x = {first, given.ratio * first - (side * slack - fast * s * h), v1, v2};
    step.x1 = {step.x[0] + v1 * h, step.x[1] + v2 * h, v1, v2};
    step.dxdt = step.dxdt1 = {v1, v2, 0, 0};
    const double tau = h * std::min(s, 1 - s);
    const double impulse = tau * (0.5 * given.damping * std::abs(fast) +
                                  0.25 * given.stiffness * std::abs(fast) * tau); // of half of K e
    const double on_first = std::abs(given.ratio) * impulse / J1 / std::abs(v1);
    const double on_second = impulse * (1 / J1 + 1 / J2) / std::abs(v2);
    ++(on_first > on_second ? of_first : of_second);
    const double limit = std::max(on_first, on_second);
    const auto search = [&](double rtol) {
      return KinkSearch<double, decltype(system)>(system, step, {rtol, 0}).first();
    };
    CAPTURE(seed, given.damping, given.ratio, on_first, on_second);
    const auto found = search(0.999 * limit);
    REQUIRE(found);
    CHECK(found->s == Approx(s).margin(1e-9));
    CHECK(found->kink.at == Approx(side * 2 * *given.preload).epsilon(1e-14));
    CHECK_FALSE(search(1.001 * limit));
  }
  CHECK(std::min(of_first, of_second) > 10);
}
