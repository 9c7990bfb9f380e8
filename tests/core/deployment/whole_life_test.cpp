// Random wings with holds, motors, latches that miss and let go, and stops beyond the latched angle: against the dense
// formulation in an integrator of its own.
#include "tests/core/deployment/random_lives.hpp"
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/whole_life.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

void check_events(const std::vector<HingeEvent>& got, const std::vector<WholeLife::Event>& exact) {
  REQUIRE(got.size() == exact.size());
  for (std::size_t k = 0; k < got.size(); ++k) {
    CAPTURE(k, got[k].time, exact[k].time);
    CHECK(got[k].hinge == exact[k].hinge);
    CHECK(std::abs(got[k].time - exact[k].time) < 1e-7);
  }
}

std::vector<HingeEvent> events_of(const std::vector<LatchEvent>& latches) {
  std::vector<HingeEvent> events;
  for (const LatchEvent& latch : latches)
    events.push_back({latch.hinge, latch.time, latch.rates[latch.hinge]});
  return events;
}

} // namespace

namespace {

/// Runs random wings and CHECKs all that happens to them against the dense formulation.
void check_lives(int first, int cases, bool motors) {
  std::size_t releases = 0, missed = 0, let_go = 0, held = 0;
  double work = 0;
  for (int k = 0; k < cases; ++k) {
    RandomScene options;
    options.bodies = 1 + k % 4;
    options.branching = k % 3 != 0;
    options.motion = static_cast<BaseMotion>(k % 3);
    options.mass_lower = 1, options.mass_upper = 10;
    const Scene scene = with_life(random_scene(first + k, options), first + 500 + k, motors);
    CAPTURE(k, options.bodies);
    const double t_end = 3;
    WholeLife exact(scene);
    exact.run(t_end);
    const Outcome out = run(scene, 1e-11, t_end);
    REQUIRE(out.status != Status::failed);
    check_events(out.releases, exact.releases);
    check_events(out.missed, exact.missed);
    check_events(events_of(out.latches), exact.latches);
    check_events(out.let_go, exact.let_go);
    releases += out.releases.size(), missed += out.missed.size(), let_go += out.let_go.size();
    const WingState<double> end = exact.state();
    for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
      CAPTURE(i);
      CHECK(std::abs(out.final.angles[i] - end.angles(static_cast<int>(i))) < 1e-6);
      CHECK(std::abs(out.final.rates[i] - end.rates(static_cast<int>(i))) < 1e-5);
      CHECK((holding_latch(out, static_cast<int>(i)) != nullptr) ==
            exact.engaged(static_cast<int>(i)));
      if (!out.motor_energy.empty()) {
        work += std::abs(exact.motor_energy[i]);
        CHECK(std::abs(out.motor_energy[i] - exact.motor_energy[i]) <
              1e-6 * (1 + std::abs(exact.motor_energy[i])));
      }
      if (out.hold_moment.empty()) continue;
      held += exact.hold_moment[i] > 0;
      CHECK(std::abs(out.hold_moment[i].value - exact.hold_moment[i]) <
            1e-7 * (1 + exact.hold_moment[i]));
    }
  }
  CHECK(releases > 0);
  CHECK(missed > 0);
  CHECK(let_go > 0);
  CHECK(held > 0);
  CHECK((work > 0) == motors);
}

} // namespace

TEST_CASE("random wings live as the dense formulation says: holds, captures, latches that let go",
          "[long]") {
  check_lives(9000, random_cases(200, 10), false);
}

namespace {

/// A panel that passes its latch too fast, is thrown back by a stop more slowly and latches then. Many such latches let the
/// panel go again, back to where it was stowed.
Scene caught_on_the_way_back(std::uint64_t seed) {
  Draws draws(seed);
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  if (draws.chance(0.5)) hinge.stowed = -hinge.stowed; // mirrored
  const double fast =
      std::sqrt(2 * hinge.spring.torque_stowed * std::abs(hinge.stowed) / panel_inertia);
  Latch latch{draws.log_uniform(50, 500), 0};
  latch.dissipation = draws.log_uniform(0.01, 0.1);
  latch.capture_rate = fast * draws.uniform(0.7, 0.98);
  latch.holding_moment = draws.log_uniform(1, 20);
  hinge.latch = latch;
  hinge.far_stop =
      Stop{draws.log_uniform(100, 1000), draws.uniform(0.2, 2), draws.uniform(0.05, 0.3)};
  return scene;
}

} // namespace

TEST_CASE(
    "a latch that caught the hinge on its way back and let it go awaits it at the stowed side") {
  int awaited = 0;
  for (int seed = 1; seed <= random_cases(100, 5); ++seed) {
    const Scene scene = caught_on_the_way_back(static_cast<std::uint64_t>(seed));
    const double t_end = 8, out_of_stowed = scene.hinges[0].stowed < 0 ? 1 : -1;
    WholeLife exact(scene);
    exact.run(t_end);
    const Outcome out = run(scene, 1e-11, t_end);
    CAPTURE(seed, out.reason);
    check_events(out.missed, exact.missed);
    check_events(events_of(out.latches), exact.latches);
    check_events(out.let_go, exact.let_go);
    if (out.latches.empty() || out.let_go.empty()) continue;
    const bool on_the_way_back = out.latches[0].rates[0] * out_of_stowed < 0;
    const double lost = out.let_go[0].time;
    const bool again =
        out.latches.back().time > lost || (!out.missed.empty() && out.missed.back().time > lost);
    awaited += on_the_way_back && again;
  }
  CHECK(awaited >= 2);
}

TEST_CASE("random wings with motors and elastic holds live as the dense formulation says",
          "[long]") {
  check_lives(12000, random_cases(200, 12), true);
}

TEST_CASE("random wings with a life have the same bits in lanes") {
  for (int k = 0; k < random_cases(60, 12); ++k) {
    RandomScene options;
    options.bodies = 1 + k % 5;
    options.motion = static_cast<BaseMotion>(k % 3);
    const Scene drawing = with_life(random_scene(9000 + k, options), 9500 + k, k % 2 == 1);
    std::vector<Scene> units;
    for (int u = 0; u < 10; ++u) {
      Draws draws(400 + u);
      units.push_back(drawing);
      for (Hinge& hinge : units.back().hinges) {
        hinge.spring.scale *= draws.uniform(0.9, 1.1);
        if (hinge.release) hinge.release->delay *= draws.uniform(0.5, 1.5);
        if (hinge.release) hinge.release->fails = draws.chance(0.1) ? 1 : 0;
        if (hinge.latch->capture_rate) *hinge.latch->capture_rate *= draws.uniform(0.5, 2);
        if (hinge.latch->holding_moment) *hinge.latch->holding_moment *= draws.uniform(0.5, 2);
        if (hinge.motor) hinge.motor->gain *= draws.uniform(0.5, 2);
        if (hinge.motor) hinge.motor->torque_limit *= draws.uniform(0.5, 2);
        if (k % 4 == 3) hinge.friction.model = FrictionModel::exact;
      }
    }
    CAPTURE(k);
    Integration how;
    how.rtol = 1e-6, how.atol = 1e-8, how.t_end = 4, how.max_steps = 5000;
    Goal goal = k % 2 ? every_peak : latches_alone;
    goal.hold_moment = k % 3 == 0;
    require_equal_bits(units, how, goal);
  }
}
