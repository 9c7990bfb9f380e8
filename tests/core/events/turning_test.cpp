#include "core/events/turning.hpp"
#include "tests/core/deployment/real_runs.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A step of latching_panel in which it turns back: its angle is a parabola of time about its vertex.
struct TurnBack {
  double vertex;      ///< travel from the stowed angle, rad
  double bend;        ///< second derivative by the fraction of the step; > 0: a trough
  double place = 0.5; ///< of the vertex, in steps

  [[nodiscard]] Step<double> step(const HingeTerms<double>& hinge, double h) const {
    Step<double> step;
    step.t = 3, step.h = h;
    const auto state = [&](double s, State<double>& x, State<double>& dxdt) {
      const double travel = vertex + 0.5 * bend * (s - place) * (s - place);
      x = {hinge.stowed + hinge.sense * travel, hinge.sense * bend * (s - place) / h};
      dxdt = {x[1], hinge.sense * bend / (h * h)};
    };
    state(0, step.x, step.dxdt), state(1, step.x1, step.dxdt1);
    return step;
  }
};

Wing<double> wing_of_panel(bool other) {
  const Scene scene = other ? other_sense(latching_panel()) : latching_panel();
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  return wing;
}

} // namespace

TEST_CASE("a hinge that turns back counts near its latch, or near its stowed angle") {
  const Layout at{0, 1, false};
  const double whole = std::numbers::pi / 2;
  for (const bool other : {false, true})
    for (const double h : {0.01, 5.0})
      for (const double way : {1e-6, 0.1}) { // the hinge's travel in the step
        const Wing<double> wing = wing_of_panel(other);
        const auto counts = [&](const TurnBack& turn, bool waits) {
          return turns_near_an_end(wing, at, turn.step(wing.hinges[1], h), 1, waits);
        };
        const double bend = 8 * way; // from the middle to an end: ½ bend/4
        CAPTURE(other, h, way);
        for (const double off : {-20 * way, -0.7 * way, 0.0, 0.7 * way}) { // short of the latch
          CHECK(counts({whole - off, -bend}, true));
          CHECK_FALSE(counts({whole - off, -bend}, false)); // the latch is engaged
          CHECK(counts({off, bend}, true)); // towards the stowed angle, with either latch
          CHECK(counts({off, bend}, false));
        }
        CHECK_FALSE(counts({whole - 2 * way, -bend}, true));
        CHECK_FALSE(counts({2 * way, bend}, true));
        CHECK_FALSE(counts({0.5 * whole, bend}, true));
        CHECK_FALSE(counts({0.5 * whole, -bend}, true));
        CHECK_FALSE(counts({whole - 0.5 * way, bend}, true)); // it sets out for the latch
        CHECK_FALSE(counts({0.5 * way, -bend}, true));        // it leaves the stowed angle behind
        CHECK_FALSE(counts({whole, -bend, 1.5}, true));       // it turns after the step
        CHECK_FALSE(counts({whole, -bend, -0.5}, true));      // before it
      }
}

TEST_CASE("the place where a hinge turns back is its vertex, but not beside an end") {
  const Layout at{0, 1, false};
  for (const bool other : {false, true})
    for (const double bend : {-0.3, 0.3})
      for (const double h : {0.01, 5.0}) {
        const Wing<double> wing = wing_of_panel(other);
        const auto found = [&](double place) {
          return turning_point(at, TurnBack{0.7, bend, place}.step(wing.hinges[1], h), 1);
        };
        CAPTURE(other, bend, h);
        for (const double place : {2e-3, 0.1, 0.5, 0.8, 0.998}) {
          REQUIRE(found(place));
          CHECK(*found(place) == Approx(place).epsilon(1e-9));
        }
        for (const double place : {-0.5, 5e-4, 0.9995, 1.5}) CHECK_FALSE(found(place));
      }
}
