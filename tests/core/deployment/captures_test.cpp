// Latches that miss a pass that is too fast, and that let go of a load: closed forms and lanes.
#include "tests/core/deployment/real_runs.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// A panel thrown at 1 rad/s, which reaches its latch after 1 s.
Scene thrown_at_latch(const Latch& latch) {
  Scene scene = thrown_panel();
  scene.hinges[0].latch = latch;
  return scene;
}

Latch holding(double stiffness, double moment, double damping = 0) {
  return {.stiffness = stiffness, .damping = damping, .holding_moment = moment};
}

Latch capturing(double rate, double stiffness = 1e4, double damping = 100) {
  return {.stiffness = stiffness, .damping = damping, .capture_rate = rate};
}

void check_event(const HingeEvent& event, double time, double rate) {
  CAPTURE(event.time, time, event.rate, rate);
  CHECK(relative(event.time, time) < 1e-9);
  CHECK(relative(event.rate, rate) < 1e-7);
}

} // namespace

TEST_CASE("an undamped latch lets go where its load reaches the holding moment") {
  for (const double k : {1e2, 1e4})
    for (const double share : {0.2, 0.7, 0.99}) { // of the largest load, ω √(kJ)
      const double largest = std::sqrt(k * panel_inertia), w = std::sqrt(k / panel_inertia);
      CAPTURE(k, share);
      for (const bool turned : {false, true}) {
        Scene scene = thrown_at_latch(holding(k, share * largest));
        if (turned) scene = other_sense(scene);
        const double sense = scene.hinges[0].latched > scene.hinges[0].stowed ? 1 : -1;
        const Outcome out = run_everywhere(scene, 1e-12, 4);
        CHECK(out.status == Status::timed_out);
        REQUIRE(out.latches.size() == 1);
        REQUIRE(out.let_go.size() == 1);
        check_event(out.let_go[0], 1 + (pi + std::asin(share)) / w,
                    -sense * std::sqrt(1 - share * share));
        CHECK(holding_latch(out, 0) == nullptr);
      }
    }
}

TEST_CASE("a latch that is loaded less than its holding moment holds") {
  const double largest = std::sqrt(1e4 * panel_inertia);
  const Outcome out = run_everywhere(thrown_at_latch(holding(1e4, 1.001 * largest)), 1e-10, 4);
  CHECK(out.status == Status::deployed);
  CHECK(out.let_go.empty());
  REQUIRE(holding_latch(out, 0));
  CHECK(holding_latch(out, 0)->time == out.latches[0].time);
}

TEST_CASE("a pass that is too fast misses the latch; a stop beyond it throws the hinge back") {
  const double k = 1e4, w = std::sqrt(k / panel_inertia);
  for (const double gap : {0., 0.05}) {
    Scene scene = thrown_at_latch(capturing(0.9));
    scene.hinges[0].far_stop = Stop{k, 0, gap};
    CAPTURE(gap);
    for (const Scene& way : {scene, other_sense(scene)}) {
      const double sense = way.hinges[0].latched > way.hinges[0].stowed ? 1 : -1;
      const Outcome out = run_everywhere(way, 1e-12, 4);
      CHECK(out.status == Status::timed_out);
      CHECK(out.latches.empty());
      REQUIRE(out.missed.size() == 2);
      check_event(out.missed[0], 1, sense);
      check_event(out.missed[1], 1 + 2 * gap + pi / w, -sense);
    }
  }
}

TEST_CASE("a pass where the spring's table has a knot is missed once") {
  for (const double torque : {2., 20., 200.})
    for (const double latched : {0., 0.1}) {
      Scene scene = latching_panel();
      Hinge& hinge = scene.hinges[0];
      hinge.stowed = 1.5, hinge.latched = latched;
      hinge.spring.table =
          torque_table({1.5, 0.6, latched}, {1, torque / 2, torque}, Interpolation::linear);
      hinge.latch = capturing(0.05);
      hinge.far_stop = Stop{500, 0.1, 0.1};
      CAPTURE(torque, latched);
      std::size_t passes = 0;
      for (const char* method : {"dop853", "dopri5", "bulirsch_stoer", "rosenbrock_w", "seulex"}) {
        Integration how = within(1e-8, 4);
        how.method = method;
        const Outcome out = Deployment().run(scene, how, every_peak);
        CAPTURE(method);
        if (passes == 0) passes = out.missed.size();
        CHECK(out.missed.size() == passes);
        for (std::size_t k = 1; k < out.missed.size(); ++k)
          CHECK(out.missed[k].time - out.missed[k - 1].time > 1e-3);
      }
      CHECK(passes >= 1);
    }
}

TEST_CASE("a hinge that a stop has slowed down engages its latch from the far side") {
  const double c = 0.5, gap = 0.05, rate = hunt_crossley_rebound(c, 1);
  Scene scene = thrown_at_latch(capturing(0.99 * 1));
  scene.hinges[0].far_stop = Stop{1e4, c, gap};
  REQUIRE(rate < 0.99);
  for (const Scene& way : {scene, other_sense(scene)}) {
    const double sense = way.hinges[0].latched > way.hinges[0].stowed ? 1 : -1;
    const Outcome out = run_everywhere(way, 1e-11, 20);
    CHECK(out.status == Status::deployed);
    CHECK(out.t_end < 20); // proven
    REQUIRE(out.missed.size() == 1);
    REQUIRE(out.latches.size() == 1);
    CHECK(relative(-sense * out.latches[0].rates[0], rate) < 1e-8);
  }
  scene.hinges[0].latch->capture_rate = 0.99 * rate;
  CHECK(run_everywhere(scene, 1e-11, 4).latches.empty());
}

TEST_CASE("a capture rate is a limit: at it a latch engages, above it not") {
  for (const double limit : {0.999999, 1.000001}) {
    const Outcome out = run_everywhere(thrown_at_latch(capturing(limit)), 1e-11, 4);
    CHECK(out.latches.size() == (limit > 1 ? 1 : 0));
    CHECK(out.missed.size() == (limit > 1 ? 0 : 1));
  }
}

TEST_CASE("a latch that is met from the far side with too large a damper opens at once") {
  Scene scene = thrown_at_latch({.stiffness = 1e4, .damping = 100, .holding_moment = 20});
  scene.hinges[0].latch->capture_rate = 0.99;
  scene.hinges[0].far_stop = Stop{1e4, 0.1, 0.05}; // back at 0.9 rad/s or so: 90 N·m of damping
  const Outcome out = run_everywhere(scene, 1e-11, 4);
  REQUIRE(out.latches.size() == 1);
  REQUIRE(out.let_go.size() == 1);
  CHECK(out.let_go[0].time == out.latches[0].time);
  CHECK(out.status == Status::timed_out);
}

TEST_CASE(
    "a latch that has let go engages again at the next pass, if the spring brings the hinge back") {
  Scene scene = latching_panel();
  scene.hinges[0].latch = holding(1e4, 120, 10);
  const Outcome out = run_everywhere(scene, 1e-11, 60);
  CHECK(out.status == Status::deployed);
  CHECK(out.t_end < 60); // it is proven that the latch holds
  REQUIRE(out.latches.size() >= 2);
  CHECK(out.let_go.size() == out.latches.size() - 1);
  REQUIRE(holding_latch(out, 0));
  CHECK(holding_latch(out, 0)->time == out.latches.back().time);
  const Outcome whole = run_everywhere(scene, 1e-11, 60, true);
  CHECK(whole.latches.size() == out.latches.size());
  CHECK(whole.let_go.size() == out.let_go.size());
  CHECK(relative(whole.peak_moment[0].value, out.peak_moment[0].value) < 1e-9);
}

// The latched panel swings back to e = 0 after π/ω_d, at e^(−δ π/ω_d) of its rate, δ = d/2J: there the damper's jump
// exceeds the holding moment.
TEST_CASE(
    "a latch that its damper opens on the way back opens at its latched angle, to the tolerance") {
  for (const double rtol : {1e-6, 1e-9})
    for (const double k : {1e2, 1e4}) {
      const double w0 = std::sqrt(k / panel_inertia), d = 0.02 * w0 * panel_inertia;
      const double delta = d / (2 * panel_inertia), wd = std::sqrt(w0 * w0 - delta * delta),
                   back = std::exp(-delta * pi / wd);
      for (const double share : {0.05, 0.5, 0.95}) {
        CAPTURE(rtol, k, share);
        const Scene scene = thrown_at_latch(holding(k, share * d * back, d));
        for (const Scene& way : {scene, other_sense(scene)}) {
          const Outcome out = run_everywhere(way, rtol, 4);
          REQUIRE(out.let_go.size() == 1);
          CHECK(std::abs(out.let_go[0].time - (1 + pi / wd)) < 3 * rtol);
          CHECK(std::abs(out.let_go[0].rate) == Approx(back).epsilon(3 * rtol));
        }
      }
    }
}

TEST_CASE("a latch whose damper pulls it open where it begins to bear lets go once") {
  for (const double rtol : {1e-4, 1e-6, 1e-8})
    for (const double damping : {40., 60., 80., 100., 120., 150.}) // back at 0.7 … 0.2 rad/s
      for (const char* method : {"dop853", "dopri5", "bulirsch_stoer", "rosenbrock_w", "seulex"}) {
        Scene scene = thrown_at_latch(holding(1e3, 10, damping));
        scene.hinges[0].far_stop = Stop{1e4, 0, 0};
        for (const Scene& way : {scene, other_sense(scene)}) {
          CAPTURE(rtol, damping, method);
          Integration how = within(rtol, 4);
          how.method = method;
          const Outcome out = Deployment().run(way, how, every_peak);
          CHECK(out.latches.size() == 1);
          CHECK(out.let_go.size() == 1);
        }
      }
}

TEST_CASE("without peaks a run ends only when it is proven that its latches hold") {
  Scene scene = latching_panel();
  scene.hinges[0].latch = holding(1e4, 120, 10);
  Goal goal = latches_alone;
  const Outcome out = Deployment().run(scene, within(1e-10, 60), goal);
  CHECK(out.status == Status::deployed);
  CHECK(out.t_end > out.latches.back().time);
  CHECK(out.t_end < 60);
  scene.hinges[0].latch = Latch{1e4, 10};
  const Outcome plain = Deployment().run(scene, within(1e-10, 60), goal);
  CHECK(plain.t_end == plain.latches.back().time);
}

TEST_CASE("energy: what a latch held when it let go is lost, the rest is kept") {
  const double k = 1e4, share = 0.6;
  const Scene scene = thrown_at_latch(holding(k, share * std::sqrt(k * panel_inertia)));
  Goal goal;
  goal.to_t_end = true;
  const Outcome out = Deployment().run(scene, within(1e-12, 2), goal);
  const double start = 0.5 * panel_inertia;
  CHECK(relative(out.energy.initial, start) < 1e-12);
  CHECK(relative(out.energy.final, start * (1 - share * share)) < 1e-9); // less ½ k e²
}

TEST_CASE("every method finds the instant at which a latch lets go") {
  const double k = 1e3, share = 0.6, w = std::sqrt(k / panel_inertia);
  const Scene scene = thrown_at_latch(holding(k, share * std::sqrt(k * panel_inertia)));
  with_every_method(scene, within(1e-9, 3, 1e-4), {}, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      REQUIRE(out.let_go.size() == 1);
                      CHECK(relative(out.let_go[0].time, 1 + (pi + std::asin(share)) / w) < 1e-5);
                    });
}

// More runs than an engine has lanes: each lane makes several, and its next run has events of its own only.
TEST_CASE("what latches missed, held and lost in one run of a lane is not told of the next") {
  std::vector<Scene> scenes;
  for (int k = 0; k < 40; ++k) {
    Scene scene = thrown_at_latch(k % 3 == 0   ? capturing(0.7)
                                  : k % 3 == 1 ? holding(1e3, 10.0 + k)
                                               : capturing(2));
    scene.hinges[0].initial_rate = 0, scene.hinges[0].spring = {1, 1}; // it arrives at 0.8 rad/s
    scene.hinges[0].release = Release{.time = k % 4 == 0 ? 0.5 : 0};
    if (k % 3 == 0) scene.hinges[0].far_stop = Stop{1e4, 0, 0.001 * k};
    scenes.push_back(scene);
  }
  long missed = 0, lost = 0, released = 0;
  const Integration how = within(1e-8, 6);
  for (const Scene& scene : scenes) {
    const Outcome out = Deployment().run(scene, how, every_peak);
    missed += !out.missed.empty(), lost += !out.let_go.empty(), released += !out.releases.empty();
  }
  CHECK((missed > 8 && lost > 8 && released > 8));
  require_equal_bits(scenes, how, every_peak);
}
