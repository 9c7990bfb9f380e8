// The largest moment of a hinge.
#include "core/deployment.hpp"
#include "core/peaks/moment_peaks.hpp"
#include "tests/support/dry_friction.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

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
