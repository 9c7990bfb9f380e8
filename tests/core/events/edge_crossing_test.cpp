// Steps that begin exactly at an angle at which a hinge's law changes.
#include "core/events/edge_crossing.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A step over h from an angle, by c sⁿ (1 − s/r): its first n − 1 derivatives vanish at the start.
Step<double> step_from(double angle, double c, int n, double r, double h) {
  const auto power = [](double s, int k) { return k < 0 ? 0.0 : std::pow(s, k); };
  const auto state = [&](double s, State<double>& x, State<double>& dxdt) {
    const double first = n * power(s, n - 1) - (n + 1) * power(s, n) / r;
    const double second = n * (n - 1) * power(s, n - 2) - n * (n + 1) * power(s, n - 1) / r;
    x = {angle + c * (power(s, n) - power(s, n + 1) / r), c * first / h};
    dxdt = {x[1], c * second / (h * h)};
  };
  Step<double> step;
  step.t = 2, step.h = h;
  state(0, step.x, step.dxdt), state(1, step.x1, step.dxdt1);
  return step;
}

} // namespace

TEST_CASE("a hinge that leaves an edge from rest does not cross it until it returns") {
  Draws draws(5);
  for (int k = 0; k < 400; ++k) {
    Scene scene = free_panel(draws.uniform(-0.5, 0.5));
    Hinge& hinge = scene.hinges[0];
    hinge.stop = Stop{100, 0.1, draws.uniform(0, 0.2)};
    hinge.damper.emplace().window = {hinge.stowed + 0.1, hinge.stowed + 0.6};
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    for (const Edge edge : {Edge::stop, Edge::window_low, Edge::window_high})
      for (const bool above : {false, true}) {
        system.note_crossing(1, edge, above);
        REQUIRE(way_over(system, 1, edge) == (above ? -1 : 1));
        const double angle = edge_angle(wing, 1, edge), h = draws.log_uniform(1e-3, 1);
        const double c = (above ? 1 : -1) * draws.log_uniform(1e-6, 0.3);
        const double returns = draws.uniform(0.05, 2);
        const int n = 1 + draws.below(3); // with a rate, with an acceleration, or with neither
        const std::optional<double> s =
            first_crossing(system, step_from(angle, c, n, returns, h), 1, edge);
        CAPTURE(k, above, c, n, returns);
        REQUIRE(s.has_value() == (returns < 1));
        if (s) CHECK(*s == Approx(returns).epsilon(1e-6));
      }
  }
}

TEST_CASE("a hinge at rest at an edge is on the side to which it accelerates") {
  Scene scene = free_panel(0.2);
  Hinge& hinge = scene.hinges[0];
  hinge.damper.emplace().window = {0.2, 0.9};
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  const auto side_after = [&](double rate, double acceleration) {
    system.note_crossing(1, Edge::window_low, false);
    const bool changed = settle_edges<double>(system, {0.2, rate}, {rate, acceleration});
    const bool above = way_over(system, 1, Edge::window_low) < 0;
    CHECK(changed == above);
    return above;
  };
  CHECK(side_after(0, 0.3));
  CHECK_FALSE(side_after(0, -0.3));
  CHECK(side_after(0.1, -5)); // its rate decides first
  CHECK_FALSE(side_after(-0.1, 5));
  CHECK_FALSE(side_after(0, 0));
}

TEST_CASE("a hinge that rounding moves about its edge does not cross it") {
  Scene scene = free_panel(0.2);
  scene.hinges[0].stop = Stop{100, 0.1, 0};
  const Wing<double> wing = [&] {
    Wing<double> made = make_wing<double>(scene, outward_order(scene));
    set_parameters(made, scene);
    return made;
  }();
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  const double angle = edge_angle(wing, 1, Edge::stop);
  const double band = 32 * 0x1p-52 * (1 + std::abs(angle));
  for (const bool above : {false, true}) {
    system.note_crossing(1, Edge::stop, above);
    const double way = way_over(system, 1, Edge::stop);
    for (const double start : {-0.4, 0., 0.2}) {
      Step<double> step = step_from(angle, way * 0.4 * band, 1, 0.5, 1e-3);
      step.x[0] += way * start * band, step.x1[0] += way * start * band;
      CHECK_FALSE(first_crossing(system, step, 1, Edge::stop).has_value());
    }
    // from two bands before it to two beyond
    const Step<double> far = step_from(angle - way * 2 * band, way * 8 * band, 1, 2, 1e-3);
    CHECK(first_crossing(system, far, 1, Edge::stop).has_value());
  }
}

TEST_CASE("hinges that reach their edges within an instant stand there together") {
  Scene scene = symmetric_tree();
  for (Hinge& hinge : scene.hinges) hinge.stop = Stop{100, 0.1, 0.1};
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::free> system(wing, std::nullopt, work);
  const Layout& at = system.layout();
  Step<double> step;
  step.t = 2, step.x.assign(at.size(), 0.0), step.dxdt.assign(at.size(), 0.0);
  const double instant = one_instant_of_latches(step.t);
  const double late[] = {0, 3, 0.5, 2, 0.9}; // instants before the edge, by hinge
  for (int i = 1; i <= 4; ++i) {
    step.x[at.rate(i)] =
        i == 4 ? -0.3 * way_over(system, i, Edge::stop) : 0.3 * way_over(system, i, Edge::stop);
    step.x[at.angle(i)] = edge_angle(wing, i, Edge::stop) - late[i] * instant * step.x[at.rate(i)];
  }
  meet_edges_simultaneous(system, 1, Edge::stop, step);
  const bool there[] = {false, true, true, false, false}; // due; soon; too late; on its way back
  for (int i = 1; i <= 4; ++i)
    CHECK((step.x[at.angle(i)] == edge_angle(wing, i, Edge::stop)) == there[i]);
}

TEST_CASE("of two edges within an instant a hinge stands at the one that is due, or at the first") {
  Scene scene = symmetric_tree();
  const double close = 0.3 * one_instant_of_latches(2.0); // at 1 rad/s
  for (Hinge& hinge : scene.hinges) {
    hinge.damper.emplace().coefficient = 1;
    hinge.damper->window = {hinge.stowed / 2, hinge.stowed / 2 + close};
  }
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::free> system(wing, std::nullopt, work);
  const Layout& at = system.layout();
  for (const double way : {-1., 1.}) {
    Step<double> step;
    step.t = 2, step.x.assign(at.size(), 0.0), step.dxdt.assign(at.size(), 0.0);
    const Edge first = way > 0 ? Edge::window_low : Edge::window_high;
    for (int i = 1; i <= 4; ++i) {
      for (const Edge edge : {Edge::window_low, Edge::window_high})
        system.note_crossing(i, edge, way < 0);
      step.x[at.rate(i)] = way;
      step.x[at.angle(i)] = edge_angle(wing, i, first) - way * 0.1 * close;
    }
    meet_edges_simultaneous(system, 1, first, step);
    for (int i = 1; i <= 4; ++i) {
      CAPTURE(way, i);
      CHECK(step.x[at.angle(i)] == edge_angle(wing, i, first));
    }
  }
}
