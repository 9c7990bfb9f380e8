// A step's end that is moved to its event: state, accelerations and forces all go with it.
#include "core/run/landing.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The panel of latching_panel() on a step to its latch, which it passes at 1.14 rad/s.
struct Arriving {
  explicit Arriving(const Goal& asked)
      : goal(asked), wing(make_wing<double>(scene, outward_order(scene))),
        system((set_parameters(wing, scene), wing), std::nullopt, work), run(system, how, goal),
        events(system), landing(run, events) {
    events.start();
    system.want_forces(goal.peak_force);
    run.step.t = 2, run.step.h = 0.01;
    run.step.x = {0.00571, -1.14}, run.step.x1 = state_after(0.01);
    system(run.step.x, run.step.dxdt, 2);
    system(run.step.x1, run.step.dxdt1, 2.01);
  }

  /// Of the motion under a constant moment.
  [[nodiscard]] State<double> state_after(double h) const {
    const double a = -2 / panel_inertia;
    return {0.00571 - 1.14 * h + 0.5 * a * h * h, -1.14 + a * h};
  }

  /// Makes the step cut to its event, a little too long. @return how much, s
  double overshoot() {
    const double late = 0.5e-7 * run.step.h;
    run.step.h += late;
    run.step.x1 = state_after(run.step.h);
    system(run.step.x1, run.step.dxdt1, run.step.t + run.step.h);
    return late;
  }

  Scene scene = latching_panel();
  Integration how;
  Goal goal;
  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system;
  using AnySystem = decltype(system);
  Underway<double, AnySystem> run;
  Events<double, AnySystem> events;
  Landing<double, AnySystem> landing;
};

} // namespace

TEST_CASE("a step that ends a little late is moved back to its event with all that it ends in") {
  Arriving at(Goal{});
  REQUIRE(at.landing.finds_event());
  const double exact = at.run.step.h;
  CHECK(at.run.step.x1[0] < 0); // of the whole step: beyond the latch
  const double late = at.overshoot();
  REQUIRE(late > 1e-10);
  const double beyond = at.run.step.x1[0];
  CHECK(beyond < -1e-11);
  CHECK_FALSE(at.landing.misses_event()); // it is not made again
  CHECK(at.landing.at_event());
  CHECK(at.run.step.h == Approx(exact).margin(1e-15));
  CHECK(std::abs(at.run.step.x1[0]) < 1e-16);
  // accelerations and forces are those of the state moved to, to the last bit
  State<double> fresh(2);
  at.system(at.run.step.x1, fresh, at.run.step.t + at.run.step.h);
  CHECK(at.run.step.dxdt1 == fresh);
  CHECK(at.run.step.dxdt1[0] == at.run.step.x1[1]);
}

TEST_CASE("where nobody asks for peaks, a step is moved to its event without an evaluation") {
  Arriving at(latches_only);
  REQUIRE(at.landing.finds_event());
  at.overshoot();
  const long before = at.work.evaluations;
  CHECK_FALSE(at.landing.misses_event());
  CHECK(at.work.evaluations == before);
  CHECK(std::abs(at.run.step.x1[0]) < 1e-16);
}

TEST_CASE("a step that ends much too late is made again") {
  Arriving at(Goal{});
  REQUIRE(at.landing.finds_event());
  const double exact = at.run.step.h;
  at.run.step.h *= 1.001;
  at.run.step.x1 = at.state_after(at.run.step.h);
  CHECK(at.landing.misses_event());
  CHECK(at.run.step.h == Approx(exact).epsilon(1e-6));
}
