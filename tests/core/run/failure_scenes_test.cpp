// Scenes on which methods fail. Whatever the method, a run gives the right answer or says that it
// gives none: a wrong number that looks like an answer is the failure.
//
// Two more such scenes are tested elsewhere: the steps at which each method's ringing latch turns
// unstable (stability_test.cpp), and chains of a thousand panels (recursion_test.cpp, "a thousand
// bodies agree with a dense solve"; what they cost, studies/drivers/benchmark.cpp).
#include "tests/support/closed_forms.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

double relative(double got, double expected) { return std::abs(got / expected - 1); }

/// Latches, in order, against a reference
/// whose times and rates are multiplied by `pace` and 1/pace.
void check_latches(const Outcome& out, const ReferenceOutcome& exact, double tolerance,
                   double pace = 1) {
  REQUIRE(out.latches.size() == exact.latches.size());
  for (std::size_t k = 0; k < exact.latches.size(); ++k) {
    const LatchEvent& got = out.latches[k];
    const ReferenceLatch& expected = exact.latches[k];
    CAPTURE(k);
    REQUIRE(got.hinge == expected.hinge);
    CHECK(relative(got.time, expected.time * pace) < tolerance);
    CHECK(relative(got.rates[got.hinge], expected.rates[got.hinge] / pace) < 10 * tolerance);
  }
}

/// The one latch of a panel under a constant moment.
void check_latch(const Outcome& out, const ConstantDrive& exact, double tolerance) {
  REQUIRE(out.latches.size() == 1);
  CHECK(relative(out.latches[0].time, exact.time()) < tolerance);
  CHECK(relative(std::abs(out.latches[0].rates[0]), exact.rate()) < tolerance);
}

/// The seed scene in extended precision, to just after its last latch.
const ReferenceOutcome& seed_reference() {
  static const ReferenceOutcome outcome = [] {
    ReferenceOptions options;
    options.t_end = 7, options.rtol = 1e-15, options.atol = 1e-16;
    return high_precision_run<long double>(seed_scene(), options);
  }();
  return outcome;
}

/// The seed scene with a smoothed latch, by CVODE, to just after its second latch.
ReferenceOutcome smoothed_reference(std::optional<double> smoothing) {
  ReferenceOptions options;
  options.t_end = 6.3, options.rtol = 1e-11, options.atol = 1e-13, options.max_step = 1e-2;
  options.smoothing = smoothing;
  return cvode_run(seed_scene(), options);
}

} // namespace

TEST_CASE("a smoothed latch is as wrong as its width, and no wronger") {
  const ReferenceOutcome event = smoothed_reference({});
  std::vector<double> root_errors;
  for (const double epsilon : {1e-4, 1e-3, 1e-2}) {
    const ReferenceOutcome exact = smoothed_reference(epsilon);
    root_errors.push_back(exact.peak_moment[0].value / event.peak_moment[0].value - 1);
    Integration how = within(1e-9, 6.3, 1e-4);
    how.smoothing = epsilon;
    CAPTURE(epsilon);
    with_every_method(
        seed_scene(), how, to_the_end, MayGiveUp::all_but_auto, [&](const Outcome& out) {
          // the reference is good to 1e-7 (its own tests); the kinks of the smooth steps cost the
          // methods of high order more than their error estimates see, still far less than
          // the smoothing itself does
          for (int hinge : {0, 1})
            CHECK(relative(out.peak_moment[hinge].value, exact.peak_moment[hinge].value) < 1e-5);
        });
  }
  // what the smoothing itself does to the peak: about 15 ε, at first linearly
  CHECK(root_errors[0] == Approx(0.00154).epsilon(0.01));
  CHECK(root_errors[1] / root_errors[0] == Approx(10).epsilon(0.1));
  CHECK(root_errors[2] == Approx(0.219).epsilon(0.01));
}

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

TEST_CASE("a latch at the turning point engages if the energy suffices, and not else") {
  // φ = −cos t comes to rest at 1; the latch stands a gap g before that or beyond it.
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
        REQUIRE(out.latches.size() == (sign > 0 ? 1u : 0u));
        if (sign < 0) return;
        // an angle that is off by δ is there δ/φ̇ too late, at a rate that is φ δ/φ̇ off
        CHECK(std::abs(out.latches[0].time - time) < off / rate);
        CHECK(std::abs(out.latches[0].rates[0] - rate) < off / rate);
      });
    }
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
    with_every_method(order, within(1e-8, 6, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        REQUIRE(out.latches.size() == 4);
                        for (int pair : {0, 2}) {
                          const LatchEvent &a = out.latches[pair], &b = out.latches[pair + 1];
                          // extrapolation magnifies the roundings in which the two wings differ
                          const double apart = methods_used(out) == "seulex" ? 1e-9 : 0;
                          CHECK(std::abs(a.time - b.time) <= apart);
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
        CHECK(out.final.rates[0] == 0);
        // off by what the energy at the latch is off, over the stiffness
        CHECK(std::abs(out.final.angles[0] + rest + exact.at(4).u) < 1e-9);
      });
    }
  }
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

namespace {

/// A chain of two panels: the second hinge is in the second panel's centre of mass, so that each
/// panel's acceleration is constant whatever the masses. Masses and inertias of the seed scene's
/// panels times `root` and `tip`.
struct ChainOfTwo {
  double root, tip;

  [[nodiscard]] double root_inertia() const { return panel_inertia * root + 10 * tip; }
  [[nodiscard]] double root_torque() const { return root_inertia() / 3; }
  [[nodiscard]] double tip_torque() const { return 0.1 * tip; }
  /// Of the first hinge; both turn in the negative sense, the second drives the first back.
  [[nodiscard]] double root_acceleration() const {
    return (root_torque() - tip_torque()) / root_inertia();
  }
  [[nodiscard]] double tip_acceleration() const { // relative
    return tip_torque() / (0.5 * tip) - root_acceleration();
  }

  [[nodiscard]] Scene scene() const {
    Scene scene = latching_panel();
    scene.bodies = {{"root", 10 * root, 0.5 * root}, {"tip", 10 * tip, 0.5 * tip}};
    scene.hinges[0].spring = {root_torque(), root_torque()};
    Hinge second = scene.hinges[0];
    second.name = "second", second.parent = 0, second.child = 1;
    second.parent_point = {0.5, 0}, second.child_point = {0, 0};
    second.spring = {tip_torque(), tip_torque()};
    second.latch.reset();
    scene.hinges.push_back(second);
    return scene;
  }
};

/// The first two panels of the seed scene without latches, masses as above; what drives the
/// lightest panel is scaled with it.
Scene two_seed_panels(double root, double tip) {
  Scene scene = seed_scene();
  scene.bodies.pop_back(), scene.hinges.pop_back();
  const double factor[] = {root, tip};
  for (int i = 0; i < 2; ++i) {
    scene.bodies[i].mass *= factor[i], scene.bodies[i].inertia *= factor[i];
    scene.hinges[i].latch.reset();
  }
  for (LinearTorque* torque : {&scene.hinges[1].spring})
    torque->torque_stowed *= std::min(root, tip), torque->torque_latched *= std::min(root, tip);
  return scene;
}

} // namespace

TEST_CASE("mass ratios of a million either way agree with the limits") {
  for (const ChainOfTwo& exact : {ChainOfTwo{1, 1e-6}, ChainOfTwo{1e-6, 1}, ChainOfTwo{1e6, 1},
                                  ChainOfTwo{1, 1e6}, ChainOfTwo{1e-6, 1e6}}) {
    CAPTURE(exact.root, exact.tip);
    const ConstantDrive drive{exact.root_acceleration(), pi / 2};
    with_every_method(exact.scene(), within(1e-9, 10), latches_only, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        check_latch(out, drive, 1e-8);
                        // only relative rates are told: the second's is the whole chain's error
                        CHECK(relative(-out.latches.at(0).rates[1],
                                       exact.tip_acceleration() * drive.time()) < 1e-7);
                      });
  }
}

TEST_CASE("chains of unequal masses that do feel each other agree with extended precision") {
  ReferenceOptions options;
  options.t_end = 3, options.rtol = 1e-14, options.atol = 1e-15;
  for (const auto& [root, tip] : {std::pair(1., 1e-6), {1e-6, 1.}, {1e6, 1.}, {1., 1e6}}) {
    const Scene scene = two_seed_panels(root, tip);
    const ReferenceOutcome exact = high_precision_run<long double>(scene, options);
    CAPTURE(root, tip);
    with_every_method(scene, within(1e-10, 3), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        for (int i : {0, 1}) {
                          CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-7);
                          CHECK(std::abs(out.final.rates[i] - exact.final.rates(i)) < 1e-7);
                        }
                      });
  }
}

TEST_CASE("a body without mass or inertia is refused by name") {
  for (const auto& [mass, inertia] : {std::pair(0., 0.5), {10., 0.}, {-0., 0.5}}) {
    Scene scene = seed_scene();
    scene.bodies[1].mass = mass, scene.bodies[1].inertia = inertia;
    const std::string path =
        "bodies.panel_2." + std::string(mass > 0 ? "inertia" : "mass") + " is ";
    for (const MethodInfo& method : methods()) {
      Integration how;
      how.method = method.name;
      const Outcome out = Deployment().run(scene, how, {});
      CHECK(out.status == Status::invalid);
      CHECK_THAT(out.reason, Catch::Contains(path) && Catch::Contains("expected > 0"));
      CHECK(out.latches.empty());
    }
  }
}

TEST_CASE("next to no inertia: the right answer or none, never NaN") {
  // light bodies under normal moments, or under moments as light as they are; subnormal ones too
  for (const double light : {1e-12, 1e-24, 1e-30, 1e-60, 1e-150, 1e-290, 1e-310})
    for (const double torque : {2., 2 * light}) {
      Scene scene = latching_panel();
      scene.bodies[0].mass *= light, scene.bodies[0].inertia *= light;
      scene.hinges[0].spring = {torque, torque};
      const ConstantDrive exact{torque / (panel_inertia * light), pi / 2};
      INFO("light " << light << ", torque " << torque << ": exactly " << exact.time() << " s");
      for (const Goal& goal : {latches_only, Goal{}}) {
        Integration how = within(1e-9, exact.time() > 0 ? 10 * exact.time() : 1);
        how.max_steps = 5000;
        with_every_method(scene, how, goal, MayGiveUp::all,
                          [&](const Outcome& out) { check_latch(out, exact, 1e-6); });
      }
    }
}

TEST_CASE("ten thousand undamped periods drift no more than the tolerance lets them") {
  const double omega = std::sqrt(2 / (pi / 2) / panel_inertia), energy = 0.5 * 2 * (pi / 2);
  for (const MethodInfo& method : methods()) {
    const bool slow = method.order > 0 && method.order < 5; // for so tight a tolerance
    const bool long_run = method.name == "auto" || method.name == "dopri5";
    const double periods = slow ? 100 : long_run ? 10'000 : 1000;
    Integration how = within(1e-9, periods * 2 * pi / omega, 1e-2);
    how.method = method.name, how.max_steps = 100'000'000;
    Goal goal = latches_only;
    goal.audit = true;
    const Outcome out = Deployment().run(harmonic_panel(), how, goal);
    CAPTURE(method.name, out.reason, out.work.steps);
    if (method.name == "runge_kutta4" && gave_up(out)) continue;
    REQUIRE(out.status == Status::timed_out);
    // phase and amplitude; the energy is quadratic in the amplitude
    const double off = astray(how, out.work.steps, pi / 2);
    CHECK(std::abs(out.final.angles[0] - pi / 2) < off);
    CHECK(std::abs(out.final.rates[0]) < off);
    CHECK(out.energy.drift_before_first_latch < 2 * energy * off / (pi / 2));
    CHECK(off < 0.1); // the bound means something
  }
}

TEST_CASE("latches of 1e9 N·m/rad: auto is right, the others right or failed") {
  for (const double damping : {1e5, 1e3}) { // over-damped; ringing at some 1e4 rad/s for 10 ms
    Scene scene = seed_scene();
    for (Hinge& hinge : scene.hinges) hinge.latch = Latch{1e9, damping};
    ReferenceOptions options;
    options.t_end = 7, options.rtol = 1e-10, options.atol = 1e-12, options.stiff = true;
    const ReferenceOutcome exact = cvode_run(scene, options);
    REQUIRE(exact.latches.size() == 3);
    Integration how = within(1e-8, 7, 1e-4);
    how.max_steps = 60'000;
    CAPTURE(damping);
    with_every_method(scene, how, {}, MayGiveUp::all_but_auto, [&](const Outcome& out) {
      CHECK(out.status == Status::deployed);
      check_latches(out, exact, 1e-6); // the reference's own error is a tenth of it
      for (int i = 0; i < 3; ++i)
        CHECK(relative(out.peak_moment[i].value, exact.peak_moment[i].value) < 1e-4);
    });
  }
}

TEST_CASE("a tumbling free spacecraft keeps both momenta to round-off with every method") {
  const Scene scene = two_wing_free_spacecraft();
  const DenseWing<long double> wing(scene);
  const WingBalance<long double> before = wing.balance(wing.initial_state());
  const long double size = before.linear_momentum.norm() + std::abs(before.angular_momentum);
  for (const double rtol : {1e-5, 1e-8})
    with_every_method(
        scene, within(rtol, 8, 1e-4), to_the_end, MayGiveUp::fixed_step, [&](const Outcome& out) {
          CHECK(out.latches.size() == 6);
          const WingBalance<long double> after = wing.balance(state_of(out, wing));
          CHECK((after.linear_momentum - before.linear_momentum).norm() < 1e-12L * size);
          CHECK(std::abs(after.angular_momentum - before.angular_momentum) < 1e-12L * size);
        });
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
  SECTION("angles past the last whole radian that a double can tell") {
    // the same scene: φ = 1.5 + 0.1 cosh 33 t is 1e20 rad at 1.5 s; |f| = m c |φ̇², φ̈|
    Scene scene = unit_oscillator(1.6);
    pull_towards(scene.hinges[0], 1.5, -33 * 33 * panel_inertia);
    const double rate = 0.1 * 33 * std::sinh(33 * 1.5);
    with_every_method(scene, within(1e-8, 1.5), {}, MayGiveUp::all, [&](const Outcome& out) {
      CHECK(relative(out.final.rates[0], rate) < 1e-5);
      CHECK(relative(out.peak_force[0].value, 10 * 0.5 * rate * rate) < 1e-5);
    });
  }
  SECTION("an engagement that overflows") {
    Scene scene = seed_scene();
    scene.hinges[0].latch = Latch{1e308, 100};
    const Integration how = within(1e-8, 7);
    with_every_method(scene, how, {}, MayGiveUp::all,
                      [&](const Outcome& out) { check_latches(out, seed_reference(), 1e-6); });
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

TEST_CASE("a tolerance below round-off is met as far as it goes, or refused; it does not hang") {
  for (const double rtol : {1e-15, 1e-16, 1e-18}) {
    Integration how = within(rtol, 7, 1e-4);
    how.atol = 1e-20, how.max_steps = 20'000;
    Goal goal;
    goal.first_latch_only = true;
    with_every_method(seed_scene(), how, goal, MayGiveUp::all, [&](const Outcome& out) {
      REQUIRE(out.latches.size() == 1);
      const ReferenceLatch& exact = seed_reference().latches[0];
      CHECK(relative(out.latches[0].time, exact.time) < 1e-10);
      CHECK(relative(out.latches[0].rates[0], exact.rates[0]) < 1e-10);
    });
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

TEST_CASE("springs of a million N·m do in a thousandth of the time what those of one do") {
  const double times = 1e6, pace = 1 / std::sqrt(times); // moments · times, times · pace
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) {
    hinge.spring.torque_stowed *= times, hinge.spring.torque_latched *= times;
    hinge.latch->stiffness *= times, hinge.latch->damping *= times * pace;
  }
  with_every_method(scene, within(1e-9, 7 * pace, 1e-4 * pace), {}, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(out.status == Status::deployed);
                      check_latches(out, seed_reference(), 1e-7, pace);
                      for (int i = 0; i < 3; ++i) {
                        CHECK(relative(out.peak_moment[i].value,
                                       times * seed_reference().peak_moment[i].value) < 1e-6);
                        CHECK(relative(out.peak_force[i].value,
                                       times * seed_reference().peak_force[i].value) < 1e-6);
                      }
                    });
}
