// Hinges that are held and released: closed forms, momenta of a free base, and lanes.
#include "tests/core/deployment/held_hinges.hpp"
#include "tests/support/dense_wing.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

TEST_CASE(
    "a panel that is released at T latches √(2ΘJ/τ) later, and its hold has borne the spring") {
  for (const double T : {0., 0.5, 3.}) {
    Scene scene = latching_panel();
    scene.hinges[0].release = at_time(T, T / 2);
    CAPTURE(T);
    for (const Scene& way : {scene, other_sense(scene)}) {
      const Outcome out = run_everywhere(way, 1e-11, 30);
      check_arrival(out, {1.5 * T + way_of_panel(), std::sqrt(2 * (pi / 2) * 2 / panel_inertia)},
                    1e-10);
      REQUIRE(out.releases.size() == (T > 0 ? 1 : 0));
      if (T > 0) CHECK(out.releases[0].time == 1.5 * T);
      CHECK(out.hold_moment[0].value == (T > 0 ? 2 : 0));
    }
  }
}

TEST_CASE("a panel that a spring holds swings about its load until it is released") {
  constexpr double k = 500, tau = 2, T = 1.23;
  Scene scene = latching_panel();
  scene.hinges[0].release = at_time(T);
  scene.hinges[0].hold = Hold{k, 0};
  const double omega = std::sqrt(k / panel_inertia), at_rest = tau / k;
  const double x = at_rest * (1 - std::cos(omega * T)), v = at_rest * omega * std::sin(omega * T);
  const double rate = std::sqrt(v * v + 2 * (pi / 2 - x) * tau / panel_inertia);
  for (const Scene& way : {scene, other_sense(scene)}) {
    const Outcome out = run_everywhere(way, 1e-11, 30);
    check_arrival(out, {T + (rate - v) * panel_inertia / tau, rate}, 1e-9);
    CHECK(relative(out.hold_moment[0].value, 2 * tau) < 1e-9);
    CHECK(out.overtravel[0] < 1e-12);
  }
  scene.hinges[0].hold->damping = 20; // ζ = 0.26
  const double zeta = 20 / (2 * std::sqrt(k * panel_inertia)), swing = std::sqrt(1 - zeta * zeta);
  const Outcome damped = run_everywhere(scene, 1e-11, 30);
  // the load τ (1 + A e^(−ζωt) cos(…)) of spring and damper together is largest where the panel's acceleration is least
  double most = 0;
  for (double t = 0; t < 1; t += 1e-6) {
    const double fall = std::exp(-zeta * omega * t), phase = swing * omega * t;
    const double acceleration =
        tau / panel_inertia * fall * (std::cos(phase) - zeta / swing * std::sin(phase));
    most = std::max(most, tau - panel_inertia * acceleration);
  }
  CHECK(relative(damped.hold_moment[0].value, most) < 1e-9);
}

// x(t) = τ/k (1 − cos ωt), ω² = k/J, reaches the latch where cos ωt = 1 − k Θ/τ.
TEST_CASE("a hinge that reaches its latch in spite of an elastic hold latches there, and its "
          "energy stays") {
  constexpr double k = 1, tau = 2, travel = pi / 2;
  const double omega = std::sqrt(k / panel_inertia), time = std::acos(1 - k * travel / tau) / omega,
               rate = tau / k * omega * std::sin(omega * time);
  for (const double released : {2 * time, 1000.}) {
    Scene scene = latching_panel();
    scene.hinges[0].release = at_time(released);
    scene.hinges[0].hold = Hold{k, 0};
    for (const Scene& way : {scene, other_sense(scene)}) {
      const Integration how = within(1e-11, 30);
      const Outcome out = Deployment().run(way, how, {});
      require_equal_bits({way, way, way}, how, every_peak);
      REQUIRE(out.latches.size() == 1);
      CHECK(std::abs(out.latches[0].time - time) < 1e-9);
      CHECK(std::abs(out.latches[0].rates[0]) == Approx(rate).epsilon(1e-8));
      CHECK(out.status == (released < 30 ? Status::deployed : Status::stalled));
      CHECK(std::abs(out.final.angles[0]) < 0.02);
      CHECK(out.energy.final < out.energy.initial);
    }
  }
}

TEST_CASE("an elastic hold that fails stalls the run, and no latch engages meanwhile") {
  Scene scene = two_panels();
  scene.hinges[0].release = at_time(1), scene.hinges[0].release->fails = 1;
  scene.hinges[0].hold = Hold{500, 5};
  const Outcome out = run_stalled(scene, 20);
  CHECK(out.never_released == std::vector<int>{0});
  CHECK(out.latches.size() == 1);
  CHECK(out.hold_moment[0].value > 2);
}

TEST_CASE("peaks are final where a hold has failed and the other hinges have rung out") {
  Scene beside = two_panels();
  beside.hinges[1].release = at_time(1), beside.hinges[1].release->fails = 1;
  Scene wings = symmetric_tree(); // one wing hangs, the other rings and turns the spacecraft
  const int first = wings.hinges[0].child;
  for (Hinge& hinge : wings.hinges)
    if (hinge.child == first || hinge.parent == first)
      hinge.release = at_time(1), hinge.release->fails = 1;
  for (const Scene& scene : {beside, wings}) {
    CAPTURE(scene.name);
    const Integration how = within(1e-9, 2000);
    const Outcome early = Deployment().run(scene, how, {});
    CHECK(early.status == Status::stalled);
    CHECK(early.peaks_final);
    CHECK(early.t_end < 1000);
    Goal longer;
    longer.to_t_end = true;
    const Outcome late = Deployment().run(scene, within(1e-9, early.t_end + 60), longer);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
      CAPTURE(i);
      CHECK(early.peak_moment[i].value == late.peak_moment[i].value);
      CHECK(early.peak_force[i].value == late.peak_force[i].value);
      CHECK(early.hold_moment[i].value == late.hold_moment[i].value);
    }
    require_equal_bits({scene, scene, scene}, how, every_peak);
  }
}

TEST_CASE("a hinge is released after another one latches, is released, or passes an angle") {
  const double way = way_of_panel();
  const double quarter = std::sqrt(2 * (pi / 8) * panel_inertia / 2); // to a quarter of the travel
  const std::array cases{std::pair{after(0, Release::Event::latched, 0.25), 1 + way + 0.25},
                         std::pair{after(0, Release::Event::latched), 1 + way},
                         std::pair{after(0, Release::Event::released, 0.75), 1.75},
                         std::pair{after(0, Release::Event::released), 1.0},
                         std::pair{after(0, Release::Event::passed, 0.5, pi / 8), 1.5 + quarter},
                         std::pair{after(0, Release::Event::passed, 0, pi / 8), 1 + quarter}};
  for (const auto& [release, time] : cases) {
    Scene scene = two_panels();
    scene.hinges[0].stowed += 0.4, scene.hinges[0].latched += 0.4; // angles count from its own
    scene.hinges[0].release = at_time(1);
    scene.hinges[1].release = release;
    CAPTURE(static_cast<int>(release.event), release.delay);
    for (const Scene& sense : {scene, other_sense(scene)}) {
      const Outcome out = run_everywhere(sense, 1e-11, 30);
      REQUIRE(out.releases.size() == 2);
      CHECK(relative(out.releases[1].time, time) < 1e-10);
      REQUIRE(out.latches.size() == 2);
      CHECK(relative(out.latches[1].time, time + way) < 1e-10);
    }
  }
}

TEST_CASE("holds that wait in a row: each is released by the one before it") {
  Scene scene = two_panels();
  scene.hinges[0].release = after(1, Release::Event::released, 0.5);
  scene.hinges[1].release = at_time(0);
  const Outcome out = run_everywhere(scene, 1e-11, 30);
  REQUIRE(out.releases.size() == 1);
  CHECK(out.releases[0].time == 0.5);
}

TEST_CASE("what a hold bears grows with the wing that moves") {
  Scene scene = seed_scene();
  scene.hinges[2].release = after(0, Release::Event::latched, 0.1);
  const Outcome out = run_everywhere(scene, 1e-10, 20);
  CHECK(out.status == Status::deployed);
  REQUIRE(out.releases.size() == 1);
  CHECK(out.releases[0].time > out.latches[0].time);
  CHECK(out.hold_moment[2].value > 0.75);
  CHECK(out.hold_moment[0].value == 0);
}

TEST_CASE("two mirrored wings that are released at once do not turn their free base") {
  Scene scene = symmetric_tree();
  for (Hinge& hinge : scene.hinges)
    if (hinge.parent == base_index) hinge.release = at_time(0.75);
  const Outcome out = run_everywhere(scene, 1e-9, 20);
  CHECK(out.status == Status::deployed);
  REQUIRE(out.base_peaks);
  CHECK(out.base_peaks->angle < 1e-12);
}

TEST_CASE("a wing that is released late turns the free base; the angular momentum is 0 for ever") {
  Scene scene = symmetric_tree();
  int roots = 0;
  for (Hinge& hinge : scene.hinges)
    if (hinge.parent == base_index) hinge.release = at_time(++roots * 0.8);
  const DenseWing<double> wing(scene);
  for (const double t_end : {0.5, 1.2, 2., 4., 7., 40.}) {
    CAPTURE(t_end);
    const Outcome out = run(scene, 1e-10, t_end);
    WingState<double> final = wing.initial_state();
    for (int i = 0; i < wing.size(); ++i)
      final.angles(i) = out.final.angles[i], final.rates(i) = out.final.rates[i];
    final.base_position = out.final.base_position, final.base_velocity = out.final.base_velocity;
    final.base_angle = out.final.base_angle, final.base_rate = out.final.base_rate;
    CHECK(std::abs(wing.balance(final).angular_momentum) < 1e-12);
    CHECK(wing.balance(final).linear_momentum.norm() < 1e-12);
    if (t_end < 40) continue;
    CHECK(out.status == Status::deployed);
    CHECK(out.base_peaks->angle > 1e-3);
    CHECK(std::abs(out.final.base_rate) < 1e-8); // at rest again
  }
}

TEST_CASE("the energy of an elastic hold counts beside laws of real hinges too") {
  Scene scene = latching_panel();
  scene.hinges[0].release = at_time(50), scene.hinges[0].hold = Hold{100, 0};
  Scene real = scene;
  real.hinges[0].stop = Stop{1e3, 0, 1}; // never touched
  for (const Scene& one : {scene, real}) {
    const Outcome out = run(one, 1e-10, 3.1);
    CHECK(out.hold_moment[0].value == Approx(4)); // it swings about its load
    CHECK(out.energy.final == Approx(out.energy.initial).margin(1e-7));
    CHECK(out.energy.drift_before_first_latch < 1e-7);
  }
}

TEST_CASE("no run ends early while a release is still to come") {
  Scene scene = two_panels();
  rub(scene.hinges[0], 3); // sticks for good
  scene.hinges[1].release = at_time(8);
  const Outcome out = Deployment().run(scene, within(1e-10, 60), {});
  CHECK(out.status == Status::stalled);
  REQUIRE(out.latches.size() == 1);
  CHECK(relative(out.latches[0].time, 8 + way_of_panel()) < 1e-9);
}

TEST_CASE("a released hinge may stick by its own friction until its load grows") {
  Scene scene = latching_panel();
  rub(scene.hinges[0], 2.5);
  scene.hinges[0].release = at_time(1);
  const Outcome out = run_stalled(scene, 10);
  REQUIRE(out.releases.size() == 1);
  CHECK(out.reason.starts_with("every hinge sticks"));
}

TEST_CASE("every method releases a hinge at its time") {
  Scene scene = two_panels();
  scene.hinges[0].release = at_time(1);
  scene.hinges[1].release = after(0, Release::Event::passed, 0.5, pi / 8);
  const double quarter = std::sqrt(2 * (pi / 8) * panel_inertia / 2);
  with_every_method(scene, within(1e-9, 30, 1e-3), {}, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      REQUIRE(out.latches.size() == 2);
                      CHECK(relative(out.latches[1].time, 1.5 + quarter + way_of_panel()) < 1e-6);
                    });
}

// The order of the file and of the tree is not that in which the holds wait.
TEST_CASE("holds that wait for each other without a delay let go at one instant, in any order") {
  for (const auto& order :
       {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}})
    for (const double first : {0.0, 0.7}) {
      Scene scene = two_panels();
      scene.bodies.push_back({"third_panel", 10, 0.5});
      Hinge third = scene.hinges[1];
      third.name = "third", third.child = 2, third.parent_point = {-3, 1};
      scene.hinges.push_back(third);
      scene.hinges[order[0]].release = at_time(first, 0.3);
      scene.hinges[order[1]].release = after(order[0], Release::Event::released);
      scene.hinges[order[2]].release = after(order[1], Release::Event::released);
      CAPTURE(order[0], order[1], order[2], first);
      const Outcome out = run_everywhere(scene, 1e-6, 30);
      REQUIRE(out.releases.size() == 3);
      for (const HingeEvent& release : out.releases) CHECK(release.time == first + 0.3);
      REQUIRE(out.latches.size() == 3);
      for (const LatchEvent& latch : out.latches) CHECK(latch.time == out.latches[0].time);
    }
}
