// When a run ends and why, and that an early end loses no peak.
#include "core/deployment.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a run for peaks of one kind loses none of them, and ends by a proof") {
  Integration how;
  how.t_end = 200;
  int ended = 0;
  for (const bool forces : {true, false})
    for (int k = 0; k < 12; ++k) {
      oracle::RandomScene options;
      options.bodies = 2 + k % 3;
      options.branching = k % 2 == 0;
      options.motion = BaseMotion::fixed;
      Scene scene = oracle::random_scene(300 + k, options);
      for (Hinge& hinge : scene.hinges) hinge.latch = Latch{2e4, 40};
      Goal goal{.peak_moment = !forces, .peak_force = forces, .audit = false};
      const Outcome early = Deployment().run(scene, how, goal);
      if (early.status != Status::deployed) continue;
      goal.to_t_end = true;
      const Outcome whole = Deployment().run(scene, how, goal);
      ended += early.t_end < how.t_end;
      const std::vector<Peak>& seen = forces ? early.peak_force : early.peak_moment;
      const std::vector<Peak>& all = forces ? whole.peak_force : whole.peak_moment;
      CAPTURE(forces, k, early.t_end);
      for (std::size_t i = 0; i < all.size(); ++i) CHECK(seen[i].value == all[i].value);
    }
  CHECK(ended >= 12);
}

TEST_CASE("without peaks a run ends at its last latch") {
  Integration how;
  Goal goal{.peak_moment = false, .peak_force = false, .audit = false, .to_t_end = false};
  const Outcome out = Deployment().run(oracle::seed_scene(), how, goal);
  CHECK(out.status == Status::deployed);
  CHECK(out.t_end == out.latches.back().time);
  CHECK(out.peak_moment.empty());
  CHECK(out.peak_force.empty());
}

TEST_CASE(
    "a run whose final angles are asked for ends at t_end, or when all hinges stick for good") {
  Goal goal{.peak_moment = false, .peak_force = false, .audit = false, .to_rest = true};
  Integration how;
  how.t_end = 30;
  const Outcome rings = Deployment().run(oracle::seed_scene(), how, goal);
  CHECK(rings.status == Status::deployed);
  CHECK(rings.t_end == 30);
  Scene scene = oracle::latching_panel();
  rub(scene.hinges[0], 3); // more than its spring
  const Outcome sticks = Deployment().run(scene, how, goal);
  CHECK(sticks.status == Status::stalled);
  CHECK(sticks.t_end < 30);
  goal.to_rest = false, goal.to_t_end = true;
  CHECK(sticks.final_angle == Deployment().run(scene, how, goal).final_angle);
  CHECK(rings.final_angle == Deployment().run(oracle::seed_scene(), how, goal).final_angle);
}

TEST_CASE("a campaign's run may stop early: no peak is lost by it") {
  const oracle::ReferenceOutcome exact = reference(oracle::seed_scene(), 12);
  const Outcome whole = run(oracle::seed_scene(), 1e-9, 60),
                early = run(oracle::seed_scene(), 1e-9, 60, false);
  CHECK(whole.t_end == 60);
  CHECK(early.t_end < 20);
  for (int i = 0; i < 3; ++i) {
    CHECK(early.peak_moment[i].value == whole.peak_moment[i].value);
    CHECK(early.peak_force[i].value == whole.peak_force[i].value);
  }
  compare(early, exact, 1e-8, 1e-7);
}

TEST_CASE("an early end loses no peak on random wings") {
  int early_ends = 0;
  for (std::uint64_t seed = 100; seed < 160; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 3);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = seed % 2 == 0 ? BaseMotion::fixed : BaseMotion::free;
    const Scene scene = oracle::random_scene(seed, options);
    const Outcome whole = run(scene, 1e-7, 15), early = run(scene, 1e-7, 15, false);
    if (whole.status != Status::deployed) continue;
    early_ends += early.t_end < whole.t_end;
    CAPTURE(seed);
    for (std::size_t i = 0; i < whole.peak_moment.size(); ++i) {
      CHECK(early.peak_moment[i].value == whole.peak_moment[i].value);
      CHECK(early.peak_force[i].value == whole.peak_force[i].value);
    }
  }
  CHECK(early_ends >= 5);
}

namespace {

struct Needed {
  double evaluations, time; ///< as parts of the whole run
};
/// Runs the scene to t_end, and to its early end: no bit of a peak may differ.
Needed part_needed(const Scene& scene, const Integration& how) {
  const Outcome whole = Deployment().run(scene, how, to_the_end),
                early = Deployment().run(scene, how, {});
  CAPTURE(early.t_end, early.reason, whole.work.rhs_evaluations, early.work.rhs_evaluations);
  CHECK(early.status == whole.status);
  CHECK(early.latches.size() == whole.latches.size());
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    CHECK(early.peak_moment[i].value == whole.peak_moment[i].value);
    CHECK(early.peak_force[i].value == whole.peak_force[i].value);
    CHECK(early.peak_moment[i].time == whole.peak_moment[i].time);
  }
  CHECK(early.overtravel == whole.overtravel);
  CHECK(early.peaks_final == (early.t_end < how.t_end));
  return {static_cast<double>(early.work.rhs_evaluations) /
              static_cast<double>(whole.work.rhs_evaluations),
          early.t_end / how.t_end};
}

} // namespace

TEST_CASE("an early end loses no peak: bases of prescribed motion") {
  struct Motion {
    double rate, push, part; // part: of the evaluations to 60 s; 1 where no proof is possible
  };
  for (const auto& [rate, push, part] :
       {Motion{0, 0.02, 0.7}, {0, 0.5, 1}, {0.035, 0, 0.7}, {0.3, 0, 1}, {0.035, 0.02, 0.8}}) {
    Scene scene = seed_scene();
    scene.base.motion = BaseMotion::prescribed;
    scene.base.rate = rate, scene.base.acceleration = {push, -push / 2};
    CAPTURE(rate, push);
    CHECK(part_needed(scene, within(1e-8, 60)).evaluations <= part);
  }
}

TEST_CASE("an early end loses no overtravel: a hinge without a latch swings back") {
  struct Hinges {
    double before_rest, kappa, viscous, stiffness, damping; // of the root, and of the tip's latch
  };
  for (const auto& [before_rest, kappa, viscous, stiffness, damping] :
       {Hinges{0.017, 70, 7, 5600, 25}, {0.046, 124, 14, 1080, 1.24}, {0.4, 70, 7, 5600, 25}}) {
    Scene scene = seed_scene();
    scene.bodies.resize(2), scene.hinges.resize(2);
    Hinge &root = scene.hinges[0], &tip = scene.hinges[1];
    root.latch.reset(), root.harness = {}, root.spring = {}, root.friction = {};
    root.stowed = 0, root.latched = before_rest;
    root.spring.torque_stowed = kappa * before_rest; // and none where it is to rest
    root.friction.viscous = viscous;
    tip.latch = Latch{stiffness, damping, 0};
    CAPTURE(before_rest, kappa, viscous);
    CHECK(part_needed(scene, within(1e-8, 100)).time < 0.5);
  }
}

TEST_CASE("an early end loses no peak: free bases that spin") {
  // the panel latches against the spin; when it rings back with the spin, it pulls harder
  for (const double rate : {0.3, 1., 3.})
    for (const double viscous : {0.5, 2., 8.}) {
      Scene scene = free_panel(1);
      scene.base.motion = BaseMotion::free;
      scene.base.mass = 500, scene.base.inertia = 100, scene.base.rate = rate;
      Hinge& hinge = scene.hinges[0];
      hinge.latched = 0, hinge.latch = Latch{100, 0.5, 0};
      hinge.spring.torque_stowed = 10, hinge.friction.viscous = viscous;
      CAPTURE(rate, viscous);
      CHECK(part_needed(scene, within(1e-8, 200)).time < 1);
    }
}

TEST_CASE("peaks on a base that turns faster and faster are final up to t_end, and not for ever") {
  Scene scene = seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.angular_acceleration = 1e-3;
  const auto found = [&](double t_end, const Goal& goal) {
    return Deployment().run(scene, within(1e-8, t_end), goal);
  };
  const Outcome early = found(20, {}), whole = found(20, to_the_end);
  CHECK(early.status == Status::deployed);
  CHECK(early.t_end < 10);
  CHECK_FALSE((early.peaks_final || early.moments_final || early.forces_final));
  CHECK(found(20, latches_only).t_end < 10);
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    CHECK(early.peak_moment[i].value == whole.peak_moment[i].value);
    CHECK(early.peak_force[i].value == whole.peak_force[i].value);
  }
  // a base that comes to turn so fast that loads exceed the peaks of the deployment
  scene.base.angular_acceleration = 0.02;
  const Outcome soon = found(40, to_the_end), later = found(400, {});
  CHECK(later.t_end == 400);
  for (std::size_t i = 0; i < scene.hinges.size(); ++i)
    CHECK(later.peak_force[i].value > 1.1 * soon.peak_force[i].value);
}

TEST_CASE("an early end loses no peak: hinges without latches") {
  const double viscous[] = {12, 2, 2}; // damps the hinge to its spring's rest
  const double part[] = {0.95, 0.5, 0.5}, undamped[] = {0.1, 1.01, 1.01}; // 1.01: not proven
  for (const int without : {0, 1, 2}) {
    Scene scene = seed_scene();
    Hinge& hinge = scene.hinges[without];
    hinge.latch.reset();
    hinge.friction.viscous = viscous[without];
    CAPTURE(without);
    CHECK(part_needed(scene, within(1e-8, 400)).time < part[without]);
    hinge.friction.viscous = 0; // only the other hinges' latches take its energy
    CHECK(part_needed(scene, within(1e-6, 400)).time < undamped[without]);
  }
}

TEST_CASE("an early end loses no peak: hinges that cannot reach their latches") {
  // the tip's harness outweighs its spring on the way: it comes to rest there, and rings no more
  for (const double viscous : {1.0, 3.0}) {
    Scene scene = seed_scene();
    Hinge& hinge = scene.hinges[2];
    hinge.harness = {0, 1.5};
    hinge.friction.viscous = viscous;
    CAPTURE(viscous);
    const Outcome out = Deployment().run(scene, within(1e-8, 200), {});
    CHECK(out.status == Status::stalled);
    CHECK_THAT(out.reason, Catch::Contains("energy: no hinge can reach its latch"));
    CHECK(out.latches.size() == 2);
    CHECK(part_needed(scene, within(1e-8, 200)).time < 0.5);
  }
}

TEST_CASE("a run may end at the instant of a latch") {
  const Scene scene = oracle::latching_panel();
  const double t = run(scene, 1e-8, 5).latches.at(0).time;
  for (const int ulps : {-4, -1, 0, 1, 2, 4, 5, 50}) {
    double t_end = t;
    for (int k = 0; k < std::abs(ulps); ++k) t_end = std::nextafter(t_end, ulps > 0 ? 1e9 : 0);
    const Outcome out = run(scene, 1e-8, t_end);
    CAPTURE(ulps, out.reason);
    CHECK(out.status != Status::failed);
    CHECK(out.t_end <= t_end);
  }
}

TEST_CASE("a run that ends at the instant of a latch, or an ulp beside it, is consistent") {
  Scene scene = latching_panel(); // at a steady 1/4 rad/s from 1 to 0: exactly 4 s
  scene.hinges[0].spring = {0, 0};
  scene.hinges[0].stowed = 1, scene.hinges[0].initial_rate = -0.25;
  const double ulp = std::numeric_limits<double>::epsilon() * 4;
  for (const double beside : {0., ulp, -ulp, 5 * ulp, -5 * ulp, 1e-9, -1e-9})
    for (const Goal& goal : {latches_only, Goal{}, to_the_end}) {
      const double t_end = 4 + beside;
      CAPTURE(beside, goal.to_t_end);
      with_every_method(scene, within(1e-8, t_end), goal, MayGiveUp::fixed_step,
                        [&](const Outcome& out) {
                          const bool latched = !out.latches.empty();
                          CHECK(out.status == (latched ? Status::deployed : Status::timed_out));
                          if (std::abs(beside) > 1e-12) CHECK(latched == (beside > 0));
                          CHECK(out.t_end <= t_end);
                          CHECK(relative(out.t_end, 4) < 1e-8);
                          // the sum of a few thousand equal steps
                          if (latched) CHECK(relative(out.latches[0].time, 4) < 1e-11);
                        });
    }
}

TEST_CASE("what stops being a number fails the run") {
  SECTION("a motion that outgrows the numbers") {
    // unstable: φ̈ = 33² (φ − 1.5), past 1e308 at about 21 s, and its square at half that
    Scene scene = unit_oscillator(1.6);
    pull_towards(scene.hinges[0], 1.5, -33 * 33 * panel_inertia);
    for (const Goal& goal : {Goal{}, latches_only}) {
      const Integration how = within(1e-6, 30);
      for (const MethodInfo& method : methods()) {
        Integration with = how;
        with.method = method.name;
        const Outcome out = Deployment().run(scene, with, goal);
        CAPTURE(method.name, out.reason, out.t_end);
        CHECK(gave_up(out));
        CHECK(finite(out));
      }
    }
  }
  SECTION("accelerations that overflow at the start, of any hinge") {
    for (const std::size_t hinge : {0, 1, 2})
      for (const MethodInfo& method : methods()) {
        Scene scene = seed_scene();
        scene.hinges[hinge].initial_rate = 1e200; // its square is none
        Integration how = within(1e-6, 30);
        how.method = method.name;
        const Outcome out = Deployment().run(scene, how, {});
        CAPTURE(hinge, method.name, out.reason);
        CHECK(out.status == Status::failed);
        CHECK(out.reason.starts_with("the accelerations are not finite at the start"));
        CHECK(out.t_end == 0);
        CHECK(out.work.steps == 0);
      }
  }
  SECTION("angles past the last whole radian that a double can tell") {
    // the same scene: φ = 1.5 + 0.1 cosh 33 t is 1e20 rad at 1.5 s; |f| = m c |φ̇², φ̈|
    Scene scene = unit_oscillator(1.6);
    pull_towards(scene.hinges[0], 1.5, -33 * 33 * panel_inertia);
    // up to 1e6 rad, at 0.51 s, every method follows it; to 1e20 none does
    const double t = std::acosh(1e7) / 33, rate = 0.1 * 33 * std::sinh(33 * t);
    with_every_method(scene, within(1e-8, t), {}, MayGiveUp::fixed_step, [&](const Outcome& out) {
      CHECK(relative(out.final.rates[0], rate) < 1e-4);
      CHECK(relative(out.peak_force[0].value, 10 * 0.5 * rate * rate) < 1e-4);
    });
    for (const MethodInfo& method : methods()) {
      Integration how = within(1e-8, 1.5);
      how.method = method.name;
      const Outcome out = Deployment().run(scene, how, {});
      CAPTURE(method.name, out.reason);
      CHECK(gave_up(out));
      CHECK(out.t_end < 1.5);
    }
  }
  SECTION("an engagement that overflows") {
    Scene scene = seed_scene();
    scene.hinges[0].latch = Latch{1e308, 100};
    const int judged =
        with_every_method(scene, within(1e-8, 7), {}, MayGiveUp::all, [](const Outcome&) {});
    CHECK(judged == 0); // none makes anything of it
  }
}

TEST_CASE("a tolerance below round-off is met as far as it goes, or refused; it does not hang") {
  int judged = 0;
  for (const double rtol : {1e-15, 1e-16, 1e-18}) {
    Integration how = within(rtol, 7, 1e-4);
    how.atol = 1e-20, how.max_steps = 20'000;
    Goal goal;
    goal.first_latch_only = true;
    judged += with_every_method(seed_scene(), how, goal, MayGiveUp::all, [&](const Outcome& out) {
      REQUIRE(out.latches.size() == 1);
      const ReferenceLatch& exact = seed_reference().latches[0];
      CHECK(relative(out.latches[0].time, exact.time) < 1e-10);
      CHECK(relative(out.latches[0].rates[0], exact.rates[0]) < 1e-10);
    });
  }
  CHECK(judged >= 8);
}

TEST_CASE("a run that ends at a latch evaluates nothing after it, unless it is observed or peaks "
          "are asked for") {
  const Goal none{.peak_moment = false,
                  .peak_force = false,
                  .overtravel = false,
                  .audit = false,
                  .end_state = false};
  for (const bool first_only : {true, false}) {
    Goal goal = none;
    goal.first_latch_only = first_only;
    CAPTURE(first_only);
    const Outcome out = Deployment().run(seed_scene(), within(1e-8, 60), goal);
    long shown = 0;
    const auto see = [&](const Sample& sample) { shown += sample.t == out.t_end; };
    const Outcome watched = Deployment().run(seed_scene(), within(1e-8, 60), goal, see);
    CHECK(shown == 2); // both sides of the engagement
    CHECK(watched.work.rhs_evaluations == out.work.rhs_evaluations + 1);
    CHECK(out.status == (first_only ? Status::timed_out : Status::deployed));
    CHECK(watched.status == out.status);
    REQUIRE(out.latches.size() == (first_only ? 1 : 3));
    for (std::size_t k = 0; k < out.latches.size(); ++k) {
      CHECK(out.latches[k].time == watched.latches[k].time);
      CHECK(out.latches[k].rates == watched.latches[k].rates);
    }
    CHECK(out.t_end == out.latches.back().time);
    // a latch's shock is at t⁺
    goal.peak_moment = true;
    const Outcome peaks = Deployment().run(seed_scene(), within(1e-8, 60), goal);
    const int last = out.latches.front().hinge;
    if (first_only)
      CHECK(peaks.peak_moment[last].value ==
            Approx(100 * std::abs(out.latches[0].rates[last])).epsilon(0.02)); // and the spring
  }
}
