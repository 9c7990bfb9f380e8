// Where latches engage, and where they do not.
#include "core/deployment.hpp"
#include "core/events/latches.hpp"
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// One panel on its hinge in its centre of mass's line;
/// spring from `torque` to none, latch at `latched`.
Scene swinging_panel(double latched, double torque, double viscous) {
  Scene scene = oracle::latching_panel();
  scene.hinges[0].stowed = -1.5707963267948966;
  scene.hinges[0].latched = latched;
  scene.hinges[0].spring = {torque, 0};
  scene.hinges[0].friction.viscous = viscous;
  return scene;
}

} // namespace

TEST_CASE("a latch at the turning point engages if the energy suffices, and not else") {
  // φ = −cos t comes to rest at 1; the latch stands a gap g before that or beyond it.
  int tell = 0; // runs accurate enough to judge
  for (const double gap : {1e-3, 1e-6, 1e-9}) {
    const double rtol = std::max(1e-12, 1e-4 * gap);
    for (const double sign : {1., -1.}) {
      Scene scene = unit_oscillator(-1);
      Hinge& hinge = scene.hinges[0];
      hinge.latched = 1 - sign * gap, hinge.latch = Latch{10, 1};
      pull_towards(hinge, 0, panel_inertia);
      const double time = pi - std::acos(hinge.latched), rate = std::sin(time);
      const Integration how = within(rtol, 5);
      CAPTURE(gap, sign);
      with_every_method(scene, how, latches_only, MayGiveUp::all_but_auto, [&](const Outcome& out) {
        const double off = astray(how, out.work.steps, 1);
        if (off > 0.1 * gap) return; // the method cannot tell
        ++tell;
        REQUIRE(out.latches.size() == (sign > 0 ? 1u : 0u));
        if (sign < 0) return;
        // an angle that is off by δ is there δ/φ̇ too late, at a rate that is φ δ/φ̇ off
        CHECK(std::abs(out.latches[0].time - time) < off / rate);
        CHECK(std::abs(out.latches[0].rates[0] - rate) < off / rate);
      });
    }
  }
  CHECK(tell >= 40);
}

TEST_CASE("a grazing latch leaves its neighbour alone") {
  // A swings between -1 and 1 under a spring that is linear in the angle; its latched angle is very near the turning point.
  // B is on the same fixed base, independent of A.
  Scene scene = oracle::latching_panel();
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "other";
  Hinge b = scene.hinges[0];
  b.name = "b", b.child = 1;
  scene.hinges.push_back(b);
  Hinge& a = scene.hinges[0];
  a.stowed = -1;
  const double b_time = std::sqrt(2 * 1.5707963267948966 * 3 / 2);
  int latched = 0, passed = 0;
  for (const double rtol : {1e-4, 1e-6, 1e-8}) {
    double below = 0.99, above = 1.01; // bisect what decides whether A latches
    for (int k = 0; k < 48; ++k) {
      a.latched = 0.5 * (below + above);
      a.spring = {2, -2 * a.latched}; // -2 φ whatever the latched angle
      const Outcome out = run(scene, rtol, 6);
      REQUIRE(out.status != Status::failed);
      const auto of_b = std::find_if(out.latches.begin(), out.latches.end(),
                                     [](const LatchEvent& e) { return e.hinge == 1; });
      REQUIRE(of_b != out.latches.end());
      CAPTURE(rtol, a.latched);
      CHECK(relative(of_b->time, b_time) < 20 * rtol);
      (out.latches.size() == 2 ? below : above) = a.latched;
      ++(out.latches.size() == 2 ? latched : passed);
    }
    CHECK(std::abs(below - 1) < 50 * rtol); // the threshold is the amplitude
  }
  CHECK(latched > 0);
  CHECK(passed > 0);
}

TEST_CASE("a hinge that creeps up to its latched angle neither fails nor crawls") {
  // found by search: each once drove the step to round-off
  const double cases[][3] = {{1, 100, 25.926150258616033}, {3.1, 200, 34.001761356457635}};
  for (const auto& [latched, torque, viscous] : cases) {
    const Outcome out = Deployment().run(swinging_panel(latched, torque, viscous), {}, {});
    CAPTURE(latched, out.reason, out.work.steps, out.work.rejected);
    CHECK(out.status != Status::failed);
    CHECK(out.work.steps + out.work.rejected < 20'000);
  }
}

TEST_CASE("two latches at one instant: one time, in any order of the file, momenta kept") {
  const Scene scene = symmetric_tree();
  ReferenceOptions options;
  options.t_end = 6, options.rtol = 1e-13, options.atol = 1e-14;
  const ReferenceOutcome exact = cvode_run(scene, options);
  REQUIRE(exact.latches.size() == 4);
  Scene mixed = scene;
  std::swap(mixed.hinges[0], mixed.hinges[2]);
  for (const Scene& order : {scene, reversed(scene), mixed}) {
    const DenseWing<long double> wing(order);
    with_every_method(
        order, within(1e-8, 6, 1e-4), to_the_end, MayGiveUp::fixed_step, [&](const Outcome& out) {
          REQUIRE(out.latches.size() == 4);
          for (int pair : {0, 2}) {
            const LatchEvent &a = out.latches[pair], &b = out.latches[pair + 1];
            CHECK(a.time == b.time);
            // between two instants one latch would bear what two share
            CHECK(relative(out.peak_force[a.hinge].value, out.peak_force[b.hinge].value) < 1e-6);
            CHECK(relative(a.time, exact.latches[pair].time) < 1e-7);
            CHECK(std::abs(a.rates[a.hinge] + a.rates[b.hinge]) < 1e-7); // mirrored
          }
          const WingBalance<long double> after = wing.balance(state_of(out, wing));
          // in all 240 kg and 2.3 J: parts of up to √(2·240·2.3) kg·m/s of which zero
          // is the sum
          CHECK(after.linear_momentum.norm() < 1e-12L * 33);
          CHECK(std::abs(after.angular_momentum) < 1e-12L * 33);
        });
  }
}

TEST_CASE("hinges that are due together latch at one instant, whatever the order of the file") {
  Scene scene = oracle::symmetric_tree();
  for (const bool reversed : {false, true}) {
    if (reversed) std::reverse(scene.hinges.begin(), scene.hinges.end());
    const Outcome out = run(scene, 1e-8, 15);
    REQUIRE(out.status == Status::deployed);
    REQUIRE(out.latches.size() == 4);
    CHECK(out.latches[0].time == out.latches[1].time);
    CHECK(out.latches[2].time == out.latches[3].time);
    CHECK(out.latches[1].time < out.latches[2].time);
    // mirrored rates, and a spacecraft that stays where it is
    CHECK(std::abs(out.final.base_angle) < 1e-9);
    CHECK(std::abs(out.final.base_rate) < 1e-9);
  }
}

TEST_CASE("a hinge may start away from its latch and come back, however far it goes") {
  const double acceleration = 2 / panel_inertia;
  // 3.9 rad/s takes it 11.4 rad away, past where the latched attitude comes round again: an angle
  // is not taken modulo 2π, and the latch waits for the hinge to come back
  for (const double away : {0.1, 1., 3.9}) {
    Scene scene = latching_panel();
    scene.hinges[0].initial_rate = away;
    const ConstantDrive exact{acceleration, pi / 2, -away};
    CAPTURE(away);
    with_every_method(scene, within(1e-9, 20), latches_only, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        CHECK(out.status == Status::deployed);
                        check_latch(out, exact, 1e-7);
                        CHECK(out.latches.at(0).rates[0] < 0);
                      });
  }
}

TEST_CASE("a spring that pulls the wrong way never latches") {
  Scene scene = latching_panel();
  scene.hinges[0].spring = {-2, -2};
  with_every_method(scene, within(1e-9, 6), to_the_end, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(out.status != Status::deployed);
                      CHECK(out.latches.empty());
                      const double angle = pi / 2 + 0.5 * 2 / panel_inertia * 36;
                      CHECK(out.final.angles[0] == Approx(angle).epsilon(1e-8));
                    });
}

TEST_CASE("without springs a hinge goes as far as its initial rate takes it") {
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.spring = {0, 0};
  SECTION("a steady rate") {
    hinge.initial_rate = -0.25;
    with_every_method(scene, within(1e-9, 20), latches_only, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        check_latch(out, {0, pi / 2, 0.25}, 1e-12);
                      });
  }
  SECTION("against viscous friction, whose reach is I φ̇/b") {
    hinge.friction.viscous = 0.5;
    for (const double reach : {0.99, 1.01}) {
      const double rate = reach * pi / 2 * 0.5 / panel_inertia;
      hinge.initial_rate = -rate;
      const double time = -panel_inertia / 0.5 * std::log(1 - 1 / reach);
      CAPTURE(reach);
      with_every_method(scene, within(1e-9, 100, 1e-2), latches_only, MayGiveUp::fixed_step,
                        [&](const Outcome& out) {
                          REQUIRE(out.latches.size() == (reach > 1 ? 1u : 0u));
                          if (reach < 1) return;
                          // at a hundredth of its first rate: a hundred times as ill-conditioned
                          CHECK(relative(out.latches[0].time, time) < 1e-6);
                          CHECK(relative(out.latches[0].rates[0], -rate * (1 - 1 / reach)) < 1e-5);
                        });
    }
  }
  SECTION("no rate: it stays") {
    const auto judge = [](const Outcome& out) {
      CHECK((out.status == Status::timed_out || out.status == Status::stalled));
      CHECK(out.latches.empty());
      CHECK(out.final.angles[0] == pi / 2);
      CHECK(out.final.rates[0] == 0);
    };
    with_every_method(scene, within(1e-9, 20), {}, MayGiveUp::fixed_step, judge);
    rub(hinge, 0.1);
    with_every_method(scene, within(1e-9, 20), {}, MayGiveUp::fixed_step, [&](const Outcome& out) {
      judge(out);
      CHECK(out.status == Status::stalled);
    });
  }
}

namespace {

/// The angle from the latched one, rad, after a latch has engaged that the step's end missed by `off`.
double engaged_off(const Hinge& with, double off) {
  Scene scene = latching_panel();
  scene.hinges[0] = with;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  using AnySystem = System<double, Tree, BaseMotion::fixed>;
  AnySystem system(wing, std::nullopt, work);
  Step<double> step;
  system.start(step.x);
  step.x = {with.latched + off, wing.hinges[1].sense};
  step.dxdt = {step.x[1], 0};
  system.find_sides({with.latched - wing.hinges[1].sense, 0});
  std::vector<LatchEvent> latches;
  std::vector<HingeEvent> missed, let_go, releases;
  Latches<double, AnySystem> open(system);
  open.start();
  LatchRecord record{latches, missed, let_go, releases};
  REQUIRE(open.engage_simultaneous(1, step, record));
  REQUIRE(latches.size() == 1);
  return step.x[0] - with.latched;
}

} // namespace

// Beside that angle the next step would end at once, at the edge of the law, and later steps would have to grow again.
TEST_CASE("a hinge stands exactly at its latched angle when its latch engages, where a law changes "
          "there") {
  for (const Scene& panel : {latching_panel(), other_sense(latching_panel())})
    for (const double off : {-1e-12, 1e-12}) {
      const Hinge plain = panel.hinges[0];
      Hinge dissipates = plain, stops = plain, damped = plain;
      dissipates.latch->damping = 0, dissipates.latch->dissipation = 2;
      stops.far_stop = Stop{1e4, 10, 0};
      Damper damper;
      damper.coefficient = 1;
      damper.window = {plain.stowed, plain.latched};
      damped.damper = damper;
      CAPTURE(plain.latched, off);
      CHECK(engaged_off(plain, off) == Approx(off).epsilon(1e-3));
      CHECK(engaged_off(dissipates, off) == 0);
      CHECK(engaged_off(stops, off) == 0);
      CHECK(engaged_off(damped, off) == 0);
    }
}

TEST_CASE(
    "a latch captures a pass that is as slow as it says and misses a faster one, either way") {
  for (const bool turned : {false, true})
    for (const double capture_rate : {0.9, 1.1}) {
      Scene scene = thrown_panel(1); // at its latch after 1 s
      scene.hinges[0].latch = Latch{.stiffness = 1e4, .damping = 100, .capture_rate = capture_rate};
      if (turned) scene = other_sense(scene);
      const Outcome out = Deployment().run(scene, within(1e-10, 2), latches_only);
      CAPTURE(turned, capture_rate);
      CHECK(out.latches.size() == (capture_rate > 1 ? 1u : 0u));
      REQUIRE(out.missed.size() == (capture_rate > 1 ? 0u : 1u));
      CHECK((out.latches.empty() ? out.missed[0].time : out.latches[0].time) == Approx(1));
      if (out.latches.empty()) CHECK(std::abs(out.missed[0].rate) == Approx(1));
    }
}
