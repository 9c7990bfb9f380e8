// The largest moment of a hinge.
#include "core/deployment.hpp"
#include "core/peaks/moment_peaks.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/dry_friction.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

TEST_CASE("a peak at the very instant of the engagement is not missed") {
  // Overdamped: |T − k y − d φ̇| falls from the first, since d |M|/I > k φ̇ throughout.
  Scene scene = latching_panel();
  const double damping = 3000;
  scene.hinges[0].latch = Latch{1e4, damping};
  const ConstantDrive exact{2 / panel_inertia, pi / 2};
  for (const double rtol : {1e-4, 1e-6, 1e-9})
    with_every_method(scene, within(rtol, 3, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        check_latch(out, exact, 10 * rtol);
                        const double peak = damping * exact.rate() - 2;
                        CHECK(relative(out.peak_moment[0].value, peak) < 10 * rtol);
                        CHECK(out.peak_moment[0].time == out.latches[0].time);
                      });
}

TEST_CASE("no moment of a hinge that turns back in a step is beyond its hull, friction with it") {
  for (const double sense : {1.0, -1.0}) {
    Scene scene = latching_panel();
    Hinge& hinge = scene.hinges[0];
    hinge.spring = {sense * 10, sense * 10};
    hinge.friction.coulomb = 0.5; // in a layer of 1e-3 rad/s
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    const System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    for (const double rate : {-1.0, 1.0}) { // turns to minus that in 0.1 s
      Step<double> step;
      step.t = 0, step.h = 0.1;
      step.x = {0.5, rate}, step.x1 = {0.5, -rate};
      step.dxdt = {rate, -20 * rate}, step.dxdt1 = {-rate, -20 * rate};
      const MomentOverStep moment(system, step, 1);
      double most = 0;
      for (int k = 0; k <= 16; ++k) most = std::max(most, std::abs(moment(k / 16.0)));
      CHECK(most == Approx(10.5).epsilon(1e-5)); // where friction has the spring's sense
      CHECK(most <= moment.most());
      CHECK(moment.most() == Approx(10.5).epsilon(1e-12));
    }
  }
}

TEST_CASE("a moment that keeps its direction over a step does so wherever it is sampled") {
  int kept = 0, turning = 0, kept_regularized = 0;
  RealFeatures features;
  features.backlash = features.air = false;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const bool regularized = seed > 200;
    features.measured = !regularized; // their regularized friction has no smooth bound
    Draws draws(seed);
    RandomScene options;
    options.bodies = 2 + static_cast<int>(seed % 3);
    options.motion = BaseMotion::fixed;
    options.friction = false;
    Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
    for (Hinge& hinge : scene.hinges) {
      rub(hinge, 0.1); // exact: what a test shows too
      if (!regularized) continue;
      hinge.friction.model = FrictionModel::regularized;
      hinge.friction.coulomb = draws.log_uniform(0.1, 10);
      hinge.friction.regularization_rate = draws.log_uniform(1e-3, 1);
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    Step<double> step;
    system.start(step.x);
    const Layout& at = system.layout();
    for (int i = 1; i <= at.bodies; ++i)
      step.x[at.angle(i)] += draws.uniform(0, 1) * wing.hinges[i].sense,
          step.x[at.rate(i)] = draws.uniform(-1, 1);
    system.find_sides(step.x);
    for (int i = 1; i <= at.bodies && !regularized; ++i)
      system.set_contact(i, step.x[at.rate(i)] > 0 ? Contact::forward : Contact::backward);
    step.h = draws.log_uniform(1e-3, 0.1);
    step.dxdt.resize(at.size()), step.dxdt1.resize(at.size());
    system(step.x, step.dxdt, 0);
    step.x1 = step.x;
    for (int k = 0; k < at.size(); ++k) step.x1[k] += step.h * step.dxdt[k];
    system(step.x1, step.dxdt1, step.h);
    for (int i = 1; i <= at.bodies; ++i) {
      const MomentOverStep moment(system, step, i);
      double rise = 0, fall = 0, size = 0;
      for (int k = 0; k < 400; ++k) {
        const double here = moment(k / 400.), there = moment((k + 1) / 400.);
        rise = std::max(rise, there - here), fall = std::max(fall, here - there);
        size = std::max(size, std::abs(here));
      }
      const bool turns = std::min(rise, fall) > 1e-12 * size;
      turning += turns;
      if (!moment.keeps_direction()) continue;
      ++(regularized ? kept_regularized : kept);
      CAPTURE(seed, i, rise, fall);
      CHECK_FALSE(turns);
    }
  }
  CAPTURE(kept, kept_regularized, turning);
  CHECK(kept >= 80);
  CHECK(kept_regularized >= 20);
  CHECK(turning >= 100);
}

TEST_CASE(
    "the moment over a step is the system's at the states there, motors and their tables with it") {
  int saturated = 0, within_limit = 0;
  RealFeatures features;
  features.backlash = features.air = false;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Draws draws(700 + seed);
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4), options.motion = BaseMotion::fixed;
    Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
    for (Hinge& hinge : scene.hinges) {
      if (draws.chance(0.3)) continue;
      Motor motor;
      motor.rate = draws.uniform(-1, 1), motor.scale = draws.uniform(0.5, 2);
      motor.gain = draws.log_uniform(0.1, 10), motor.torque_limit = draws.log_uniform(0.1, 10);
      if (draws.chance(0.5))
        motor.table = std::make_shared<Curve>(std::vector<double>{0, 0.5, 1},
                                              std::vector<double>{0, draws.uniform(-2, 2), 1},
                                              Interpolation::monotone, Beyond::constant);
      hinge.motor = motor;
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    if (wing.motors.empty()) continue;
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    Step<double> step;
    system.start(step.x);
    const Layout& at = system.layout();
    step.t = 0.1, step.h = draws.log_uniform(1e-3, 0.3);
    for (int i = 1; i <= at.bodies; ++i) {
      step.x[at.angle(i)] += draws.uniform(0, 1) * wing.hinges[i].sense;
      step.x[at.rate(i)] = draws.uniform(-1, 1);
      system.start_motor(i, 0.0);
    }
    system.find_sides(step.x);
    step.dxdt.resize(at.size()), step.dxdt1.resize(at.size());
    system(step.x, step.dxdt, step.t);
    step.x1 = step.x;
    for (int k = 0; k < at.size(); ++k) step.x1[k] += step.h * step.dxdt[k];
    system(step.x1, step.dxdt1, step.t + step.h);
    State<double> x(at.size());
    for (int i = 1; i <= at.bodies; ++i) {
      const MomentOverStep moment(system, step, i);
      for (const double s : {0., 0.2, 0.5, 0.9, 1.}) {
        step.interpolate(at, s, x);
        system.set_commands(step.t + s * step.h);
        const double exact = system.moment(x, i);
        CAPTURE(seed, i, s);
        CHECK(moment(s) == Approx(exact).epsilon(1e-9).margin(1e-9));
        CHECK(std::abs(exact) <= moment.most() * (1 + 1e-9));
        if (!wing.motors[i].present) continue;
        const double wanted = wing.motors[i].gain * std::abs(work.motors[i].now - x[at.rate(i)]);
        ++(wanted > wing.motors[i].limit ? saturated : within_limit);
      }
    }
  }
  CHECK(std::min(saturated, within_limit) > 100);
}

TEST_CASE("how fast a moment changes is its difference along the motion, whatever exerts it") {
  int motors = 0, loops = 0, laws = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    Draws draws(1700 + seed);
    RandomScene options;
    options.bodies = 2 + static_cast<int>(seed % 3), options.motion = BaseMotion::fixed;
    Scene scene = with_real_hinges(random_scene(seed, options), seed);
    for (Synchronisation& loop : scene.synchronisations)
      loop.table.reset(); // the second derivative of its function is neglected
    for (Hinge& hinge : scene.hinges) {
      if (draws.chance(0.5)) continue;
      hinge.motor = Motor{.rate = draws.uniform(-1, 1), .gain = draws.log_uniform(0.1, 10)};
      hinge.motor->torque_limit = draws.log_uniform(0.1, 10);
      if (draws.chance(0.7))
        hinge.motor->table = std::make_shared<Curve>(
            std::vector<double>{0, 0.5, 1}, std::vector<double>{0, draws.uniform(-2, 2), 1},
            Interpolation::monotone, Beyond::constant);
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    const Layout& at = system.layout();
    for (int i = 1; i <= at.bodies; ++i) {
      x[at.angle(i)] += draws.uniform(0, 1) * wing.hinges[i].sense;
      x[at.rate(i)] = draws.uniform(-1, 1);
      system.start_motor(i, 0.0);
    }
    system.find_sides(x);
    const double t = draws.uniform(0.1, 0.4), d = 1e-6;
    State<double> dxdt(at.size()), y(at.size());
    system(x, dxdt, t);
    for (int i = 1; i <= at.bodies; ++i) {
      const auto m = [&](double dt) {
        for (int k = 0; k < at.size(); ++k) y[k] = x[k] + dt * dxdt[k];
        system.set_commands(t + dt);
        return system.moment(y, i);
      };
      const double before = (m(0) - m(-d)) / d, after = (m(d) - m(0)) / d;
      const double close =
          1e-4 * (1 + std::abs(before) + std::abs(after)); // between them at a kink
      if (std::abs(before - after) > 0.05 * (std::abs(before) + std::abs(after))) continue;
      const double found = moment_rate(system, x, dxdt, t, i);
      CAPTURE(seed, i, before, after, found);
      CHECK(found >= std::min(before, after) - close);
      CHECK(found <= std::max(before, after) + close);
      motors += !wing.motors.empty() && wing.motors[i].present;
      loops += std::ranges::any_of(wing.loops, [&](const auto& loop) { return joins(loop, i); });
      laws += !wing.real.empty();
    }
  }
  CHECK(std::min({motors, loops, laws}) > 50);
}

TEST_CASE("a moment's maximum inside a step has its place there, and a step to it corrects both") {
  // M = −κ cos (t − t0): the dense output of a step over more than a radian misplaces its crest
  const Scene scene = unit_oscillator(1);
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  State<double> x, dxdt;
  system.start(x);
  for (const double h : {0.2, 1.4})
    for (const double place : {0.2, 0.43, 0.9}) {
      Step<double> step;
      step.t = 7, step.h = h;
      const auto state = [&](double s, State<double>& q, State<double>& rates) {
        const double phase = (s - place) * h;
        q = {std::cos(phase), -std::sin(phase)}, rates = {q[1], -q[0]};
      };
      state(0, step.x, step.dxdt), state(1, step.x1, step.dxdt1);
      PeakOf<double> peak{};
      std::optional<DoubtfulMoment<double>> doubt = raise_moment(peak, system, step, 1);
      CAPTURE(h, place);
      REQUIRE(doubt);
      CHECK(doubt->s == Approx(place).margin(2e-3));
      CHECK(doubt->bend == Approx(panel_inertia).epsilon(0.1));
      CHECK(peak.value == Approx(panel_inertia * std::max(step.x[0], step.x1[0])).epsilon(1e-12));
      const double off = std::abs(doubt->s - place);
      state(doubt->s, x, dxdt);
      (void)confirm_moment(*doubt, peak, system, step, 1, x, dxdt, 1e-14);
      CHECK(std::abs(doubt->s - place) <= 0.1 * off + 1e-12);
      CHECK(peak.value == Approx(panel_inertia).epsilon(1e-5));
      CHECK(peak.time == Approx(7 + place * h).epsilon(1e-3));
      state(doubt->s, x, dxdt);
      CHECK_FALSE(confirm_moment(*doubt, peak, system, step, 1, x, dxdt, 1e-9)); // it is there
      CHECK(peak.value == Approx(panel_inertia).epsilon(1e-9));
    }
}

TEST_CASE("the largest moment of the dense output is found wherever it lies in the step") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Draws draws(seed);
    const double turns = draws.uniform(0.5, 2.5), phase = draws.uniform(0, 6),
                 bias = draws.uniform(-1, 1);
    const auto moment = [&](double s) { return 3 * std::sin(turns * s + phase) + bias + s; };
    Step<double> step;
    step.t = 5, step.h = draws.log_uniform(1e-3, 10);
    double most = 0, place = 0;
    for (int k = 0; k <= 20000; ++k) {
      const double size = std::abs(moment(k / 20000.));
      if (size > most) most = size, place = k / 20000.;
    }
    PeakOf<double> peak{};
    raise_by_interpolant(peak, moment, step);
    CAPTURE(seed, turns, phase, most, place);
    CHECK(peak.value == Approx(most).epsilon(1e-6));
    CHECK(std::abs(moment((peak.time - step.t) / step.h)) == Approx(peak.value).epsilon(1e-6));
    PeakOf<double> higher{2 * most, 1};
    raise_by_interpolant(higher, moment, step);
    CHECK((higher.value == 2 * most && higher.time == 1));
  }
}
