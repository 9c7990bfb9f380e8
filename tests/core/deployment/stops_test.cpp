// Stops, latches with backlash and latches with dissipation: whole runs against closed forms.
#include "tests/core/deployment/real_runs.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// A panel thrown at 1 rad/s against its stop, its latch 1 rad the other way.
Scene thrown_at_stop(const Stop& stop) {
  Scene scene = thrown_panel(-1);
  scene.hinges[0].stop = stop;
  return scene;
}

void check_bounce(const Scene& scene, const Arrival& exact, double depth, double moment) {
  for (const Scene& way : {scene, other_sense(scene)}) {
    const Outcome out = run_everywhere(way, 1e-11, 4);
    check_arrival(out, exact, 1e-8);
    CHECK(relative(out.overtravel[0], depth) < 1e-8);
    CHECK(relative(out.peak_moment[0].value, moment) < 1e-8);
  }
}

} // namespace

TEST_CASE("a panel bounces off a stop without dissipation: half a period of the contact") {
  for (const double k : {1e2, 1e4, 1e6})
    for (const double gap : {0., 0.05}) {
      const double w = std::sqrt(k / panel_inertia);
      CAPTURE(k, gap);
      check_bounce(thrown_at_stop({k, 0, gap}), {2 * gap + pi / w + 1, 1}, gap + 1 / w, k / w);
    }
}

TEST_CASE("a stop with dissipation returns the rate of Hunt and Crossley's law") {
  for (const double c : {0.1, 0.5, 2., 10.}) {
    Scene scene = thrown_at_stop({1e4, c, 0.05});
    const double rate = hunt_crossley_rebound(c, 1);
    const double depth = hunt_crossley_depth(panel_inertia, 1e4, c, 1);
    const Outcome out = run_everywhere(scene, 1e-11, 20);
    CAPTURE(c);
    REQUIRE(out.latches.size() == 1);
    CHECK(relative(out.latches[0].rates[0], rate) < 1e-8);
    CHECK(relative(out.overtravel[0], 0.05 + depth) < 1e-8);
  }
}

TEST_CASE("every method bounces off a stop") {
  const double w = std::sqrt(1e4 / panel_inertia);
  with_every_method(thrown_at_stop({1e4, 0, 0.05}), within(1e-9, 4, 1e-4), {},
                    MayGiveUp::fixed_step, [&](const Outcome& out) {
                      check_arrival(out, {0.1 + pi / w + 1, 1}, 1e-6);
                      CHECK(relative(out.overtravel[0], 0.05 + 1 / w) < 1e-6);
                    });
}

TEST_CASE("a hinge that its spring presses on the stop comes to rest there") {
  Scene scene = free_panel();
  Hinge& hinge = scene.hinges[0];
  const double k = 1e3, b = 20, torque = 2, gap = 0.03;
  hinge.spring.torque_stowed = hinge.spring.torque_latched = -torque;
  hinge.friction.viscous = b, hinge.stop = Stop{k, 0, gap}, hinge.latch = Latch{};
  hinge.initial_rate = 0;
  const Outcome out = run_everywhere(scene, 1e-10, 30, true);
  CHECK(out.latches.empty());
  CHECK(std::abs(out.final.angles[0] + gap + torque / k) < 1e-9);
  CHECK(std::abs(out.final.rates[0]) < 1e-9);
  const Outcome asked = Deployment().run(scene, within(1e-8, 30), {});
  CHECK((asked.status == Status::stalled || asked.status == Status::timed_out));
  // without a gap it starts on the stop, and sinks in as a step response does
  hinge.stop->gap = 0;
  const double decay = b / (2 * panel_inertia), w = std::sqrt(k / panel_inertia - decay * decay);
  const Outcome sinking = run_everywhere(scene, 1e-11, 30, true);
  CHECK(relative(sinking.overtravel[0], torque / k * (1 + std::exp(-decay * pi / w))) < 1e-8);
  CHECK(relative(-sinking.final.angles[0], torque / k) < 1e-8);
}

TEST_CASE("a hinge that just reaches its stop, or just not, swings on") {
  // φ = cos t from its stowed angle 1 to the other side and back: it touches at 2π, at rest
  for (const double gap : {0., 1e-13, 1e-9, 1e-4}) {
    Scene scene = unit_oscillator(1);
    scene.hinges[0].stop = Stop{1e4, 0.3, gap};
    const Outcome out = run_everywhere(scene, 1e-11, 10, true);
    CAPTURE(gap, out.work.steps);
    CHECK(std::abs(out.final.angles[0] - std::cos(10)) < 1e-8);
    CHECK(std::abs(out.final.rates[0] + std::sin(10)) < 1e-8);
    CHECK(out.overtravel[0] < 1e-9);
    CHECK(out.work.steps < 5000);
  }
}

TEST_CASE("a shallow contact is not missed") {
  // φ = cos t + v sin t comes back to √(1 + v²), v²/2 beyond 1: in contact for about 2 v
  for (const double v : {1e-2, 1e-3}) {
    Scene scene = unit_oscillator(1, v);
    scene.hinges[0].stop = Stop{1e-30, 0, 0}; // to be met, not felt
    const Outcome out = run_everywhere(scene, 1e-11, 10, true);
    CHECK(std::abs(out.final.angles[0] - std::cos(10) - v * std::sin(10)) < 1e-8);
    // first at atan v, and again a turn later
    CHECK(std::abs(out.overtravel[0] - (std::hypot(1, v) - 1)) < 1e-9);
    // ½ I v² = ½ k δ² + ½ I ((1 + δ)² − 1), the oscillator's stiffness being I
    const double k = 1e5, I = panel_inertia;
    scene.hinges[0].stop = Stop{k, 0, 0};
    const Outcome hard = run_everywhere(scene, 1e-11, 10, true);
    const double depth = (std::sqrt(I * I + (k + I) * I * v * v) - I) / (k + I);
    CHECK(std::abs(hard.overtravel[0] - depth) < 1e-10);
  }
}

TEST_CASE("overtravel is told where there is no stop") {
  Scene scene = unit_oscillator(1, 0.5); // cos t + 0.5 sin t
  const Outcome out = run_everywhere(scene, 1e-11, 10, true);
  CHECK(relative(out.overtravel[0], std::hypot(1, 0.5) - 1) < 1e-9);
  const Outcome none = run_everywhere(thrown_panel(), 1e-11, 10);
  CHECK(none.overtravel[0] == 0);
  scene.hinges[0].initial_rate = -0.5; // outwards first; back beyond the start later
  CHECK(relative(run_everywhere(scene, 1e-11, 10, true).overtravel[0], std::hypot(1, 0.5) - 1) <
        1e-9);
}

TEST_CASE("an engaged latch with backlash flies from edge to edge") {
  const double k = 1e3;
  for (const double backlash : {1e-3, 0.1})
    for (const double t : {1.02, 1.3, 2., 5.}) {
      Scene scene = free_panel(0, 1);
      scene.hinges[0].latch = Latch{k, 0, backlash};
      const Played exact = backlash_motion(panel_inertia, k, backlash, 1, t - 1);
      const Outcome out = run_everywhere(scene, 1e-11, t, true);
      CAPTURE(backlash, t);
      REQUIRE(out.latches.size() == 1);
      CHECK(std::abs(out.latches[0].time - 1) < 1e-9);
      CHECK(std::abs(out.final.angles[0] - 1 - exact.angle) < 1e-8);
      CHECK(std::abs(out.final.rates[0] - exact.rate) < 1e-7); // times ω = 18 of the contact
      if (t > 1.3) CHECK(relative(out.peak_moment[0].value, std::sqrt(k * panel_inertia)) < 1e-8);
    }
}

TEST_CASE("every method plays in a latch's backlash") {
  Scene scene = free_panel(0, 1);
  scene.hinges[0].latch = Latch{1e3, 0, 0.1};
  const Played exact = backlash_motion(panel_inertia, 1e3, 0.1, 1, 1);
  with_every_method(scene, within(1e-9, 2, 1e-4), to_the_end, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(std::abs(out.final.angles[0] - 1 - exact.angle) < 1e-6);
                      CHECK(std::abs(out.final.rates[0] - exact.rate) < 1e-5);
                    });
}

TEST_CASE("backlash that a damped latch jumps into and out of agrees with the reference") {
  Scene scene = free_panel(0, 1);
  scene.hinges[0].latch = Latch{1e3, 20, 0.02};
  const ReferenceOutcome exact = real_reference(scene, 2.5);
  const Outcome out = run_everywhere(scene, 1e-11, 2.5, true);
  compare(out, exact, 1e-8, 1e-7);
  CHECK(std::abs(out.final.angles[0] - exact.final.angles(0)) < 1e-8);
  CHECK(std::abs(out.final.rates[0] - exact.final.rates(0)) < 1e-7);
}

TEST_CASE("a latch with dissipation takes Hunt and Crossley's share on either side of its angle") {
  const double k = 1e3;
  for (const double c : {0.05, 0.5, 4.})
    for (const double backlash : {0., 0.02}) {
      Scene scene = free_panel(0, 1);
      scene.hinges[0].latch = Latch{k, 0, backlash, c};
      const auto peak = [&](double speed) { // k δ (1 + c δ̇) is largest inside the swing
        const double first = hunt_crossley_depth(panel_inertia, k, c, speed), cv = c * speed;
        double most = k * first;
        for (double u = cv; u > 0;
             u -= cv / 20'000) { // ½ k δ² = I (f(c v) − f(u))/c², f = u − ln(1 + u)
          const double height = (cv - u) - std::log1p((cv - u) / (1 + u));
          most = std::max(most, k * std::sqrt(2 * panel_inertia * height / k) / c * (1 + u));
        }
        return most;
      };
      CAPTURE(c, backlash);
      const ReferenceOutcome exact = real_reference(scene, 1.6);
      for (const Scene& way : {scene, other_sense(scene)}) {
        const Outcome out = run_everywhere(way, 1e-11, 1.6, true);
        REQUIRE(out.latches.size() == 1);
        CHECK(relative(out.peak_moment[0].value, peak(1)) < 1e-7);
        CHECK(std::abs(std::abs(out.final.angles[0]) - exact.final.angles(0)) < 1e-8);
        CHECK(std::abs(std::abs(out.final.rates[0]) - std::abs(exact.final.rates(0))) < 1e-7);
      }
    }
}

TEST_CASE("every method swings in a latch with dissipation") {
  Scene scene = free_panel(0, 1);
  scene.hinges[0].latch = Latch{1e3, 0, 0, 0.5};
  const ReferenceOutcome exact = real_reference(scene, 2);
  with_every_method(scene, within(1e-9, 2, 1e-4), to_the_end, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(std::abs(out.final.angles[0] - exact.final.angles(0)) < 1e-6);
                      CHECK(std::abs(out.final.rates[0] - exact.final.rates(0)) < 1e-5);
                      CHECK(relative(out.peak_moment[0].value, exact.peak_moment[0].value) < 1e-6);
                    });
}

TEST_CASE(
    "a smoothed latch with dissipation agrees with the reference and tends to the event latch") {
  Scene scene = free_panel(0, 1);
  scene.hinges[0].latch = Latch{1e3, 0, 0, 0.5};
  const double event = run(scene, 1e-10, 2).peak_moment[0].value;
  double before = 1;
  for (const double epsilon : {1e-2, 1e-3, 1e-4}) {
    Integration how = within(1e-9, 2);
    how.smoothing = epsilon;
    const Outcome out = Deployment().run(scene, how, to_the_end);
    ReferenceOptions options;
    options.t_end = 2, options.rtol = 1e-11, options.atol = 1e-13, options.max_step = 1e-2;
    options.smoothing = epsilon;
    const ReferenceOutcome exact = cvode_run(scene, options);
    CAPTURE(epsilon);
    CHECK(relative(out.peak_moment[0].value, exact.peak_moment[0].value) < 1e-5);
    CHECK(std::abs(out.final.angles[0] - exact.final.angles(0)) < 1e-5);
    const double deviation = relative(out.peak_moment[0].value, event);
    CHECK(deviation < before);
    before = deviation;
  }
}
