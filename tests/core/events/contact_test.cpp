// Exact (set-valued) Coulomb friction: hinges that slide, come to rest and stick,
// against closed forms and the energy that friction takes.
#include "core/deployment.hpp"
#include "core/events/contact.hpp"
#include "tests/core/events/rubbed_wings.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

TEST_CASE("exact friction takes 4 τ_c/κ of an oscillation's amplitude each cycle, then holds it") {
  // κ = I: u = φ and ω = 1. The amplitudes are 1.05, 0.85 … at the times 0, π …
  struct Case {
    double kinetic, static_level, viscous, amplitude;
    int halves; ///< half cycles until it stops, known by hand where nothing is viscous
  };
  const double level = 0.1 * panel_inertia;
  for (const Case& c : {Case{level, level, 0, 1.05, 5}, Case{level, 3 * level, 0, 1.05, 4},
                        Case{level, level, 0, -0.55, 3}, Case{level, 6 * level, 0, 0.55, 0},
                        Case{level, level, 0.3, 1.05, -1}}) {
    const CoulombOscillator exact(
        {panel_inertia, panel_inertia, c.viscous, c.kinetic, c.static_level}, {c.amplitude, 0});
    if (c.halves >= 0) CHECK(exact.stop_time() == Approx(c.halves * pi).margin(1e-12));
    Scene scene = unit_oscillator(c.amplitude);
    rub(scene.hinges[0], c.kinetic, c.static_level);
    scene.hinges[0].friction.viscous = c.viscous;
    const Integration how = within(1e-9, 20);
    CAPTURE(c.static_level, c.viscous, c.amplitude);
    std::vector<Sample> samples;
    with_every_method(
        scene, how, to_the_end, MayGiveUp::fixed_step,
        [&](const Outcome& out) {
          CHECK(out.status == Status::timed_out); // a scene without a latch
          CHECK(out.t_end == 20);
          CHECK(out.final.rates[0] == 0);
          const double off = astray(how, out.work.steps, 1);
          CHECK(off < 1e-4); // the bound means something
          for (const Sample& sample : samples) {
            const CoulombOscillator::State at = exact.at(sample.t);
            CAPTURE(sample.t);
            REQUIRE(std::abs(sample.angles[0] - at.u) < off);
            REQUIRE(std::abs(sample.rates[0] - at.rate) < off);
            // the turning point is flat: its time is known only to the root of the error, times 2
            if (sample.t < exact.stop_time() + 2 * std::sqrt(2 * off)) continue;
            REQUIRE(sample.rates[0] == 0);
            REQUIRE(sample.angles[0] == out.final.angles[0]);
          }
        },
        &samples);
  }
}

TEST_CASE("a latched hinge rings against exact friction until it sticks") {
  const double kinetic = 0.5, torque = 2, stiffness = 1e4, damping = 100;
  const ConstantDrive drive{(torque - kinetic) / panel_inertia, pi / 2};
  int at_rest = 0; // runs that were followed to there
  for (const double static_level : {kinetic, 2.5}) {
    Scene scene = latching_panel();                                 // its latch: φ = 0, from above
    if (static_level > torque) scene.hinges[0].initial_rate = -0.1; // else it would never start
    const ConstantDrive to_latch{drive.acceleration, drive.travel,
                                 static_level > torque ? 0.1 : 0.0};
    rub(scene.hinges[0], kinetic, static_level);
    const double rest = torque / stiffness; // beyond the latched angle
    const CoulombOscillator exact({panel_inertia, stiffness, damping, kinetic, static_level},
                                  {-rest, to_latch.rate()});
    const Integration how = within(1e-9, 4, 5e-5);
    CAPTURE(static_level);
    for (const bool to_t_end : {true, false}) {
      Goal goal;
      goal.to_t_end = to_t_end;
      with_every_method(scene, how, goal, MayGiveUp::fixed_step, [&](const Outcome& out) {
        CHECK(out.status == Status::deployed);
        check_latch(out, to_latch, 1e-8);
        if (to_t_end) CHECK(out.t_end == 4);
        if (out.t_end < to_latch.time() + exact.stop_time() + 1e-3) return; // proven to be over
        ++at_rest;
        CHECK(out.final.rates[0] == 0);
        // off by what the energy at the latch is off, over the stiffness
        CHECK(std::abs(out.final.angles[0] + rest + exact.at(4).u) < 1e-9);
      });
    }
  }
  CHECK(at_rest >= 20);
}

TEST_CASE("exact friction stops a hinge short of its latch for ever") {
  const double torque = 0.5, kinetic = 2, rate = 0.7;
  const ConstantDrive backwards{(kinetic - torque) / panel_inertia, 0, rate};
  const double distance = 0.5 * rate * rate / backwards.acceleration,
               time = rate / backwards.acceleration;
  REQUIRE(distance < pi / 2);
  Scene scene = latching_panel();
  scene.hinges[0].spring = {torque, torque};
  scene.hinges[0].initial_rate = -rate;
  rub(scene.hinges[0], kinetic);
  const auto judge = [&](const Outcome& out) {
    CHECK(out.status == Status::stalled);
    CHECK_THAT(out.reason, Catch::Contains("sticks") || Catch::Contains("energy"));
    CHECK(out.latches.empty());
  };
  for (const double t_end : {1e-3, 1., 60.}) // proven from the first by the energy
    with_every_method(scene, within(1e-9, t_end), {}, MayGiveUp::fixed_step, judge);
  with_every_method(scene, within(1e-9, 10), to_the_end, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      judge(out);
                      CHECK(out.t_end == 10);
                      CHECK(out.final.rates[0] == 0);
                      CHECK(std::abs(out.final.angles[0] - (pi / 2 - distance)) < 1e-7);
                    });
  // before it stops it slides as the closed form says
  with_every_method(scene, within(1e-9, 0.5 * time), to_the_end, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(out.final.angles[0] == Approx(pi / 2 - 0.75 * distance).epsilon(1e-8));
                      CHECK(out.final.rates[0] == Approx(-0.5 * rate).epsilon(1e-8));
                    });
}

TEST_CASE("regularized friction creeps where a hinge should stick") {
  const double torque = 0.5, level = 2, width = 1e-3;
  Scene scene = latching_panel();
  scene.hinges[0].spring = {torque, torque};
  scene.hinges[0].friction.coulomb = level;
  scene.hinges[0].friction.regularization_rate = width;
  const double creep = width * torque / std::sqrt(level * level - torque * torque);
  // transients decay as exp(−600 t); stiff: an explicit method's steps are bounded by 5 ms
  with_every_method(scene, within(1e-8, 20, 2e-4), {}, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(out.status == Status::timed_out);
                      CHECK(out.latches.empty());
                      CHECK(relative(out.final.rates[0], -creep) < 1e-4); // the rate's tolerance
                      CHECK(pi / 2 - out.final.angles[0] == Approx(20 * creep).epsilon(1e-2));
                    });
}

TEST_CASE("the order of the hinges in the file changes nothing about friction") {
  for (const Scene& scene : {rubbed_seed(0.3, 1.2, 0.6), held_until_the_root_latches()}) {
    const Integration how = within(1e-9, 9);
    const Outcome there = Deployment().run(scene, how, to_the_end),
                  back = Deployment().run(reversed(scene), how, to_the_end);
    CHECK(there.status == back.status);
    REQUIRE(there.latches.size() == back.latches.size());
    REQUIRE(there.latches.size() > 0);
    for (std::size_t k = 0; k < there.latches.size(); ++k) {
      CHECK(there.latches[k].hinge == 2 - back.latches[k].hinge);
      CHECK(there.latches[k].time == Approx(back.latches[k].time).epsilon(1e-8));
    }
    for (int i : {0, 1, 2}) {
      CHECK(there.final.angles[i] == Approx(back.final.angles[2 - i]).margin(1e-7));
      CHECK((there.final.rates[i] == 0) == (back.final.rates[2 - i] == 0));
    }
  }
}

TEST_CASE("friction that is nothing changes nothing, and static friction alone only holds") {
  const Integration how = within(1e-9, 12);
  SECTION("no level") {
    const Outcome none = Deployment().run(seed_scene(), how, {}),
                  zero = Deployment().run(rubbed_seed(0, 0, 0), how, {});
    REQUIRE(zero.latches.size() == none.latches.size());
    for (std::size_t k = 0; k < none.latches.size(); ++k)
      CHECK(zero.latches[k].time == Approx(none.latches[k].time).epsilon(1e-8));
  }
  SECTION("a static level alone, which a moving hinge does not feel") {
    Scene scene = latching_panel();
    rub(scene.hinges[0], 0, 3);
    CHECK(Deployment().run(scene, how, {}).status == Status::stalled);
    scene.hinges[0].initial_rate = -0.1;
    const ConstantDrive exact{2 / panel_inertia, pi / 2, 0.1};
    with_every_method(scene, how, latches_only, MayGiveUp::fixed_step, [&](const Outcome& out) {
      REQUIRE(out.latches.size() == 1);
      CHECK(out.latches[0].time == Approx(exact.time()).epsilon(1e-8));
    });
  }
}

TEST_CASE("what energy a wing loses is what its friction takes") {
  for (const Scene& scene : {rubbed_seed(0.3, 1.2, 0.6), held_until_the_root_latches()}) {
    std::vector<Sample> samples;
    with_every_method(
        scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
        [&](const Outcome& out) {
          REQUIRE(!out.latches.empty());
          const double start = samples[0].kinetic + samples[0].potential;
          double taken = 0; // ∫ τ_c |φ̇| dt: a reversal is where a step ends
          for (std::size_t k = 1; samples[k].t <= out.latches[0].time; ++k) {
            const Sample &before = samples[k - 1], &at = samples[k];
            for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
              taken += scene.hinges[i].friction.coulomb * std::abs(at.angles[i] - before.angles[i]);
              if (before.rates[i] == 0 && at.rates[i] == 0)
                REQUIRE(stayed(at.angles[i], before.angles[i]));
            }
            REQUIRE(std::abs(start - (at.kinetic + at.potential) - taken) < 1e-7 * start);
          }
          CHECK(taken > 0.01 * start);
        },
        &samples);
  }
}

TEST_CASE("a hinge that sets out at a tiny rate does not come to rest at once") {
  const Layout at{0, 1, false};
  for (const double angle : {1.5708, -300.})
    for (const double rate : {0., 1e-18, 1e-14})
      for (const double h : {1e-7, 2e-4, 1e-2}) {
        const double a = 13.9, a1 = 9.3, end = rate + 0.49 * h * (a + a1); // its acceleration bends
        const double way = h * rate + h * h * (a / 3 + a1 / 6);
        const Step<double> step{3.55, h, {angle, rate}, {rate, a}, {angle + way, end}, {end, a1}};
        CAPTURE(angle, rate, h);
        CHECK(all_negative(way_to_rest(at, step, 1, -1.0)));
      }
}
