// Whole runs against independent ones: another formulation, other integrators, closed forms.
#include "core/deployment.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

Outcome run(const Scene& scene, double rtol, double t_end, bool to_t_end = true) {
  Integration how;
  how.rtol = rtol, how.atol = 1e-2 * rtol, how.t_end = t_end;
  Goal goal;
  goal.to_t_end = to_t_end;
  return Deployment().run(scene, how, goal);
}

double relative(double got, double expected) { return std::abs(got / expected - 1); }

void compare(const Outcome& got, const oracle::ReferenceOutcome& expected, double latches,
             double peaks) {
  REQUIRE(got.latches.size() == expected.latches.size());
  for (std::size_t k = 0; k < got.latches.size(); ++k) {
    const LatchEvent& a = got.latches[k];
    const oracle::ReferenceLatch& b = expected.latches[k];
    CAPTURE(k, a.hinge);
    REQUIRE(a.hinge == b.hinge);
    CHECK(relative(a.time, b.time) < latches);
    for (std::size_t j = 0; j < a.rates.size(); ++j)
      CHECK(std::abs(a.rates[j] - b.rates[j]) < latches * std::abs(b.rates[a.hinge]) * 10);
  }
  for (std::size_t i = 0; i < got.peak_moment.size(); ++i) {
    CAPTURE(i);
    CHECK(relative(got.peak_moment[i].value, expected.peak_moment[i].value) < peaks);
    CHECK(relative(got.peak_force[i].value, expected.peak_force[i].value) < peaks);
  }
}

oracle::ReferenceOutcome reference(const Scene& scene, double t_end) {
  oracle::ReferenceOptions options;
  options.t_end = t_end;
  options.rtol = 1e-15, options.atol = 1e-16;
  return oracle::high_precision_run<long double>(scene, options);
}

} // namespace

TEST_CASE("the three-panel wing gives the figures of an independent model") {
  // Produced outside this repository by SciPy's DOP853 at rtol 1e-11
  // on a dense model in absolute angles.
  const Outcome out = run(oracle::seed_scene(), 1e-10, 12);
  REQUIRE(out.status == Status::deployed);
  REQUIRE(out.latches.size() == 3);
  const double time[] = {4.819271, 6.047369, 6.794189}, rate[] = {-1.267827, 0.732120, -1.160431};
  const double moment[] = {250.4651, 84.6102, 115.9431};
  for (int k = 0; k < 3; ++k) {
    CHECK(out.latches[k].hinge == k); // root, mid, tip
    CHECK(std::abs(out.latches[k].time - time[k]) < 1e-6);
    CHECK(std::abs(out.latches[k].rates[k] - rate[k]) < 1e-6);
    CHECK(std::abs(out.peak_moment[k].value - moment[k]) < 1e-4);
  }
  // the tip's peak is at its own engagement: d |φ̇| less the spring that is left, at t⁺
  CHECK(out.peak_moment[2].time == out.latches[2].time);
  CHECK(out.peak_moment[2].value ==
        Approx(100 * std::abs(out.latches[2].rates[2]) - 0.1).epsilon(1e-12));
}

TEST_CASE("latches, peak moments and peak forces agree with extended precision by another route") {
  const oracle::ReferenceOutcome exact = reference(oracle::seed_scene(), 12);
  compare(run(oracle::seed_scene(), 1e-8, 12), exact, 1e-7, 1e-6);
  compare(run(oracle::seed_scene(), 1e-10, 12), exact, 1e-9, 1e-8);
  compare(run(oracle::seed_scene(), 1e-12, 12), exact, 1e-11, 1e-10);
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

TEST_CASE("without peaks a run ends at its last latch") {
  Integration how;
  Goal goal{.peak_moment = false, .peak_force = false, .audit = false, .to_t_end = false};
  const Outcome out = Deployment().run(oracle::seed_scene(), how, goal);
  CHECK(out.status == Status::deployed);
  CHECK(out.t_end == out.latches.back().time);
  CHECK(out.peak_moment.empty());
  CHECK(out.peak_force.empty());
}

TEST_CASE("energy before the first latch drifts less than 1e-9 at the defaults") {
  for (const Scene& scene : {oracle::seed_scene(), oracle::two_wing_free_spacecraft()}) {
    const Outcome out = Deployment().run(scene, {}, {});
    REQUIRE(!out.latches.empty());
    CAPTURE(out.energy.drift_before_first_latch, out.energy.initial);
    CHECK(out.energy.drift_before_first_latch < 1e-9 * std::abs(out.energy.initial));
    CHECK(out.energy.drift_before_first_latch > 0); // it is measured
  }
}

TEST_CASE("random wings with every base motion agree with the reference") {
  std::size_t latches = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = static_cast<BaseMotion>(seed % 3);
    const Scene scene = oracle::random_scene(seed, options);
    CAPTURE(seed, options.bodies);
    const Outcome got = run(scene, 1e-11, 1.5);
    REQUIRE(got.status != Status::failed);
    compare(got, reference(scene, 1.5), 1e-8, 1e-7);
    latches += got.latches.size();
  }
  CHECK(latches >= 8);
}

TEST_CASE("a free spacecraft keeps both momenta to round-off at any tolerance") {
  const Scene scene = oracle::two_wing_free_spacecraft();
  const oracle::DenseWing<long double> wing(scene);
  const auto before = wing.balance(wing.initial_state());
  for (const double rtol : {1e-4, 1e-8}) {
    const Outcome out = run(scene, rtol, 10);
    auto state = wing.initial_state();
    for (int i = 0; i < wing.size(); ++i)
      state.angles[i] = out.final.angles[i], state.rates[i] = out.final.rates[i];
    state.base_position = out.final.base_position.cast<long double>();
    state.base_velocity = out.final.base_velocity.cast<long double>();
    state.base_angle = out.final.base_angle, state.base_rate = out.final.base_rate;
    const auto after = wing.balance(state);
    // relative to the sum of the parts' magnitudes, of which the total is a difference
    const long double size = before.linear_momentum.norm() + std::abs(before.angular_momentum) + 1;
    CHECK(static_cast<double>((after.linear_momentum - before.linear_momentum).norm() / size) <
          1e-12);
    CHECK(static_cast<double>(std::abs(after.angular_momentum - before.angular_momentum) / size) <
          1e-12);
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

TEST_CASE("one panel has closed forms before and after its latch") {
  const Scene scene = oracle::latching_panel();
  const double inertia = 0.5 + 10 * 0.25, travel = 1.5707963267948966, torque = 2, k = 1e4, d = 100;
  const Outcome out = run(scene, 1e-10, 5);
  REQUIRE(out.latches.size() == 1);
  const double t = std::sqrt(2 * travel * inertia / torque), speed = torque / inertia * t;
  CHECK(relative(out.latches[0].time, t) < 1e-9);
  CHECK(relative(std::abs(out.latches[0].rates[0]), speed) < 1e-9);
  // after it: y'' + 2 δ y' + ω² y = torque/inertia in the deploying sense, y(0) = 0, y'(0) = speed.
  // |M| = |torque − k y − d y'|, maximised on a fine grid and refined by its neighbours' parabola
  const double delta = d / (2 * inertia), omega = std::sqrt(k / inertia - delta * delta),
               rest = torque / k;
  const auto moment = [&](double s) {
    const double b = (speed - delta * rest) / omega, e = std::exp(-delta * s);
    const double y = rest + e * (-rest * std::cos(omega * s) + b * std::sin(omega * s));
    const double v =
        -delta * (y - rest) + e * omega * (rest * std::sin(omega * s) + b * std::cos(omega * s));
    return std::abs(torque - k * y - d * v);
  };
  double best = 0;
  for (int i = 0; i <= 2'000'000; ++i) best = std::max(best, moment(i * 1e-7));
  CHECK(relative(out.peak_moment[0].value, best) < 1e-9);
}

TEST_CASE("the smoothed latch tends to the event latch") {
  const double exact = run(oracle::seed_scene(), 1e-9, 9).peak_moment[0].value;
  double before = 1;
  for (const double epsilon : {1e-2, 1e-3, 1e-4, 1e-5}) {
    Integration how;
    how.t_end = 9;
    how.smoothing = epsilon;
    const Outcome out = Deployment().run(oracle::seed_scene(), how, {});
    REQUIRE(out.status == Status::deployed);
    const double deviation = relative(out.peak_moment[0].value, exact);
    CHECK(deviation < before);
    before = deviation;
  }
  CHECK(before < 1e-3);
}

TEST_CASE("the smoothed latch agrees with CVODE on the dense model") {
  oracle::ReferenceOptions options;
  options.t_end = 9, options.rtol = 1e-10, options.atol = 1e-12, options.max_step = 1e-3,
  options.smoothing = 1e-3;
  const oracle::ReferenceOutcome exact = oracle::cvode_run(oracle::seed_scene(), options);
  Integration how;
  how.rtol = 1e-9, how.atol = 1e-12, how.t_end = 9, how.smoothing = 1e-3;
  Goal goal;
  goal.to_t_end = true;
  compare(Deployment().run(oracle::seed_scene(), how, goal), exact, 1e-7, 1e-5);
}

TEST_CASE("what cannot be run says so") {
  Scene scene = oracle::seed_scene();
  SECTION("an unphysical draw is invalid, with each reason") {
    scene.bodies[1].mass = -1;
    scene.hinges[0].friction.coulomb = std::nan("");
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::invalid);
    CHECK_THAT(out.reason,
               Catch::Contains("bodies." + scene.bodies[1].name + ".mass is -1, expected > 0"));
    CHECK_THAT(out.reason,
               Catch::Contains("hinges.root.friction.coulomb is nan, expected a finite number"));
  }
  SECTION("numbers that overflow fail the run and give no result") {
    scene.hinges[0].spring = {1e300, 1e300};
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::failed);
    CHECK(!out.reason.empty());
    for (const Peak& peak : out.peak_moment) CHECK(std::isfinite(peak.value));
  }
  SECTION(
      "what no step can follow in the middle of a run fails it there, and keeps what came before") {
    scene.hinges[0].latch = Latch{1e308, 100};
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::failed);
    CHECK_THAT(out.reason, Catch::Contains("step size") && Catch::Contains("at t = 4.81"));
    CHECK(out.latches.size() == 1);
    for (const Peak& peak : out.peak_moment) CHECK(std::isfinite(peak.value));
    for (const Peak& peak : out.peak_force) CHECK(std::isfinite(peak.value));
  }
  SECTION("a latch too stiff for the method reaches the limit of steps") {
    for (Hinge& hinge : scene.hinges) hinge.latch = Latch{1e9, 1e5};
    Integration how;
    how.method = "dopri5";
    how.max_steps = 2000;
    const Outcome out = Deployment().run(scene, how, {});
    CHECK(out.status == Status::failed);
    CHECK_THAT(out.reason, Catch::Contains("limit of 2000 steps"));
  }
  SECTION("a wing without the torque to unfold is timed out") {
    for (Hinge& hinge : scene.hinges) hinge.spring = {0, 0};
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::timed_out);
    CHECK(out.latches.empty());
    CHECK(out.t_end == 60);
  }
}

TEST_CASE("one workspace serves scenes of different topology") {
  Deployment deployment;
  const Outcome first = deployment.run(oracle::seed_scene(), {}, {});
  (void)deployment.run(oracle::two_wing_free_spacecraft(), {}, {});
  (void)deployment.run(oracle::latching_panel(), {}, {});
  const Outcome again = deployment.run(oracle::seed_scene(), {}, {});
  REQUIRE(first.latches.size() == again.latches.size());
  for (std::size_t k = 0; k < first.latches.size(); ++k)
    CHECK(first.latches[k].time == again.latches[k].time);
  CHECK(first.peak_force[1].value == again.peak_force[1].value);
}

TEST_CASE("a workspace tells a star from a chain of as many bodies") {
  Scene chain = oracle::seed_scene(), star = chain;
  for (Hinge& hinge : star.hinges) hinge.parent = base_index;
  Deployment deployment;
  (void)deployment.run(star, {}, {});
  const Outcome after = deployment.run(chain, {}, {}), fresh = Deployment().run(chain, {}, {});
  REQUIRE(after.latches.size() == fresh.latches.size());
  for (std::size_t k = 0; k < fresh.latches.size(); ++k)
    CHECK(after.latches[k].time == fresh.latches[k].time);
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

TEST_CASE("a grazing latch leaves its neighbour alone") {
  // A swings between -1 and 1 under a spring that is linear in the angle; its latch stands just
  // about at the turning point. B, beside it on the same fixed base, knows nothing of it.
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

TEST_CASE("where a free spacecraft is and how fast it flies changes nothing in its wings") {
  Scene scene = oracle::two_wing_free_spacecraft();
  const Outcome here = run(scene, 1e-8, 10);
  for (const auto& [position, velocity] : {std::pair(1e5, 0.0), {7e6, 7500.0}, {1e8, 0.0}}) {
    scene.base.position.x() = position, scene.base.velocity.y() = velocity;
    const Outcome out = run(scene, 1e-8, 10);
    REQUIRE(out.latches.size() == here.latches.size());
    for (std::size_t k = 0; k < here.latches.size(); ++k)
      CHECK(relative(out.latches[k].time, here.latches[k].time) < 1e-7);
    for (std::size_t i = 0; i < here.peak_moment.size(); ++i)
      CHECK(relative(out.peak_moment[i].value, here.peak_moment[i].value) < 1e-6);
  }
}
