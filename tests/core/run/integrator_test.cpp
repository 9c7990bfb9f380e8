// Extra steps to a peak inside a step: how a run proceeds if its method refuses one.
#include "core/run/integrator.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <memory>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

struct Refused {
  Outcome outcome;
  int probes = 0; ///< steps that were to make sure of a peak
};

/// Runs a wing, but refuses every step inside another one and leaves NaN in its result.
template <BaseMotion M> Refused run_refusing_probes(const Scene& scene, const Integration& how) {
  using AnyRun = Integrator<double, Tree, M>;
  const Goal goal{.audit = false};
  const Observer nobody;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  typename AnyRun::AnySystem system(wing, std::nullopt, work);
  AnyRun run(system, how, goal, nobody);
  Refused refused;
  for (run.begin(); !run.ended();) {
    LaneResult place = run.empty_lane_result();
    if (&place.x1 == &place.step.x1) {
      run.make_step();
      continue;
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    place.x1.assign(place.x1.size(), none), place.dxdt1.assign(place.dxdt1.size(), none);
    place.forces_at_end.assign(place.forces_at_end.size(), {none, none});
    place.error = 2, place.judged = {2, 1};
    run.resume(place);
    ++refused.probes;
  }
  refused.outcome = run.outcome();
  return refused;
}

/// How far the largest peaks are off those of the usual run; the end is the same.
template <BaseMotion M = BaseMotion::fixed>
double largest_change(const Integration& how, const Scene& scene = seed_scene()) {
  const Outcome usual = Deployment().run(scene, how, {.audit = false});
  const auto [out, probes] = run_refusing_probes<M>(scene, how);
  CAPTURE(how.method, how.rtol, probes);
  CHECK(probes >= 5);
  REQUIRE(finite(out));
  CHECK(out.status == usual.status);
  CHECK(out.t_end == usual.t_end);
  double change = 0;
  for (int i = 0; i < 3; ++i)
    change = std::max({change, relative(out.peak_moment[i].value, usual.peak_moment[i].value),
                       relative(out.peak_force[i].value, usual.peak_force[i].value)});
  return change;
}

/// The seed wing without its latches: no shock hides the loads of its drives.
Scene swinging_wing() {
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) hinge.latch.reset();
  return scene;
}

/// On a base that turns under a constant acceleration, whose direction in the base's axes is a matter of time.
Scene wing_on_turning_base() {
  Scene scene = swinging_wing();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.acceleration = {3, 2};
  scene.base.rate = 2;
  return scene;
}

/// With a motor whose command rises with time.
Scene wing_with_rising_command() {
  Scene scene = swinging_wing();
  Motor motor{.time = {0, 100}, .rates = {0, 300}, .interpolation = Interpolation::linear};
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
  motor.gain = 5, motor.torque_limit = 1e3;
  scene.hinges[0].motor = motor;
  return scene;
}

} // namespace

TEST_CASE("where a method refuses the step to a peak, shorter ones lead there") {
  Integration how = within(1e-4, 60);
  for (const double rtol : {1e-4, 1e-8})
    for (const char* method : {"dopri5", "dop853", "bulirsch_stoer"}) {
      how.rtol = rtol, how.atol = 1e-2 * rtol, how.method = method;
      CAPTURE(rtol, method);
      CHECK(largest_change(how) < rtol); // what a step may lose, and the way there takes a few
    }
}

TEST_CASE("where the step to a peak is refused to Adams' method, the dense output's word stands") {
  for (const double rtol : {1e-4, 1e-8}) {
    Integration how = within(rtol, 60);
    how.method = "adams_bashforth_moulton";
    CAPTURE(rtol);
    CHECK(largest_change(how) < 1e-2 * std::sqrt(rtol));
    how.t_end = 5; // the dense output is of one time
    CHECK(largest_change<BaseMotion::prescribed>(how, wing_on_turning_base()) <
          1e-2 * std::sqrt(rtol));
    CHECK(largest_change(how, wing_with_rising_command()) < 1e-2 * std::sqrt(rtol));
  }
}

TEST_CASE("each of the shorter steps to a peak begins at its own time") {
  for (const double rtol : {1e-4, 1e-8})
    for (const char* method : {"dopri5", "dop853", "bulirsch_stoer"}) {
      Integration how = within(rtol, 5);
      how.method = method;
      CAPTURE(rtol, method);
      CHECK(largest_change<BaseMotion::prescribed>(how, wing_on_turning_base()) < rtol);
      CHECK(largest_change(how, wing_with_rising_command()) < rtol);
    }
}
