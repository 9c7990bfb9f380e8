// Steps that end at an event: state, accelerations and forces at an end that is moved there.
#include "core/run/landing.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A run of a scene, and what lands it.
struct LandingRun {
  explicit LandingRun(const Scene& of, const Goal& asked)
      : scene(of), goal(asked), wing(make_wing<double>(scene, outward_order(scene))),
        system((set_parameters(wing, scene), wing), std::nullopt, work), run(system, how, goal),
        events(system), landing(run, events) {
    events.start();
  }

  Scene scene;
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

/// The panel of latching_panel() on a step to its latch, which it passes at 1.14 rad/s.
struct Arriving : LandingRun {
  explicit Arriving(const Goal& asked) : LandingRun(latching_panel(), asked) {
    system.want_forces(goal.peak_force);
    run.step.t = 2, run.step.h = 0.01;
    run.step.x = {0.00571, -1.14}, run.step.x1 = state_after(0.01);
    system(run.step.x, run.step.dxdt, 2);
    system(run.step.x1, run.step.dxdt1, 2.01);
  }

  /// The exact state under a constant moment.
  [[nodiscard]] State<double> state_after(double h) const {
    const double a = -2 / panel_inertia;
    return {0.00571 - 1.14 * h + 0.5 * a * h * h, -1.14 + a * h};
  }

  /// Makes the cut step too long by this share. @return the excess, s
  double overshoot(double share = 0.5e-7) {
    const double late = share * run.step.h;
    run.step.h += late;
    run.step.x1 = state_after(run.step.h);
    system(run.step.x1, run.step.dxdt1, run.step.t + run.step.h);
    return late;
  }
};

} // namespace

TEST_CASE(
    "a step that ends a little late is moved back to its event: state, accelerations, forces") {
  Arriving at(Goal{});
  REQUIRE(at.landing.cut_at_event({}, 1e-8));
  const double exact = at.run.step.h;
  CHECK(at.run.step.x1[0] < 0); // of the whole step: beyond the latch
  const double late = at.overshoot();
  REQUIRE(late > 1e-10);
  const double beyond = at.run.step.x1[0];
  CHECK(beyond < -1e-11);
  CHECK_FALSE(at.landing.correct_end()); // it is not made again
  CHECK(at.landing.at_event());
  CHECK(at.run.step.x1[0] == beyond); // peaks are searched in the step as it was made
  CHECK(at.landing.carry_end_to_event());
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
  REQUIRE(at.landing.cut_at_event({}, 1e-8));
  at.overshoot();
  const long before = at.work.evaluations;
  CHECK_FALSE(at.landing.correct_end());
  CHECK(at.landing.carry_end_to_event());
  CHECK(at.work.evaluations == before);
  CHECK(std::abs(at.run.step.x1[0]) < 1e-16);
}

TEST_CASE("a step that ends much too late is made again") {
  Arriving at(Goal{});
  REQUIRE(at.landing.cut_at_event({}, 1e-8));
  const double exact = at.run.step.h;
  at.run.step.h *= 1.001;
  at.run.step.x1 = at.state_after(at.run.step.h);
  CHECK(at.landing.correct_end());
  CHECK(at.run.step.h == Approx(exact).epsilon(1e-6));
}

TEST_CASE("how far a step may be moved to its event depends on the tolerance, if accelerations are "
          "known") {
  // the square of the way is a hundredth of rtol: up to 1e-4 steps at 1e-6
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10, 1e-13, 0.0}) {
    const double most = std::max(0.1 * std::sqrt(rtol), 1e-7);
    for (const double share : {0.9 * most, 1.1 * most}) {
      CAPTURE(rtol, share);
      Arriving at(latches_only);
      REQUIRE(at.landing.cut_at_event({}, rtol));
      at.overshoot(share);
      CHECK(at.landing.correct_end() == (share > most));
    }
  }
}

TEST_CASE("a step is moved along a curved way: the state stays that of the motion") {
  // where springs turn a panel, φ̈ = −ω² (φ − c) with ω = 8: exact states on both sides of the latch
  constexpr double omega = 8, c = 0.3, h = 0.1;
  const auto state = [&](double t) { // at the latched angle, 0, for t = 0, at −2 rad/s
    const double p = std::atan2(0.25, -0.3), r = std::hypot(0.25, 0.3);
    return std::array{c + r * std::cos(omega * t + p), -r * omega * std::sin(omega * t + p),
                      -omega * omega * r * std::cos(omega * t + p)};
  };
  REQUIRE(std::abs(state(0)[0]) < 1e-15);
  REQUIRE(state(0)[1] == Approx(-2));
  for (const double share : {-1e-4, 1e-4, 1e-6}) {
    CAPTURE(share);
    Arriving at(latches_only);
    REQUIRE(at.landing.cut_at_event({}, 1e-4));
    Step<double>& step = at.run.step;
    const auto first = state(-h), last = state(share * h);
    step.h = h * (1 + share);
    step.x = {first[0], first[1]}, step.dxdt = {first[1], first[2]};
    step.x1 = {last[0], last[1]}, step.dxdt1 = {last[1], last[2]};
    CHECK_FALSE(at.landing.correct_end());
    CHECK(at.landing.carry_end_to_event());
    // to first order alone: ½ ω² way² = 1.6e-9 off in the angle
    CHECK(std::abs(step.x1[0]) < 1e-12);
    CHECK(step.x1[1] == Approx(state(0)[1]).epsilon(1e-10)); // 3e-9
    CHECK(step.dxdt1[0] == step.x1[1]);
    CHECK(step.dxdt1[1] == Approx(state(0)[2]).epsilon(1e-6));
  }
}

// The second order of Newton's step misses the latch by some 1e-10 rad after so long a way. Where it ends, the exact state is
// known all the same.
TEST_CASE("a step that is moved far ends in the exact state at its time") {
  constexpr double omega = 8, h = 0.1;
  const auto state = [](double t) { // φ̈ = −ω² φ, through 0 at −2 rad/s
    return std::array{-2 / omega * std::sin(omega * t), -2 * std::cos(omega * t),
                      2 * omega * std::sin(omega * t)};
  };
  for (const double share : {-9e-4, 9e-4}) {
    CAPTURE(share);
    Arriving at(latches_only);
    Step<double>& step = at.run.step;
    step.h = 0.2, step.x1 = at.state_after(0.2); // longer than the step that is moved
    at.system(step.x1, step.dxdt1, step.t + step.h);
    REQUIRE(at.landing.cut_at_event({}, 1e-4));
    const auto first = state(-h), last = state(share * h);
    step.h = h * (1 + share);
    step.x = {first[0], first[1]}, step.dxdt = {first[1], first[2]};
    step.x1 = {last[0], last[1]}, step.dxdt1 = {last[1], last[2]};
    CHECK_FALSE(at.landing.correct_end());
    CHECK(at.landing.carry_end_to_event());
    const auto exact = state(step.h - h);
    CHECK(std::abs(exact[0]) < 1e-9); // it has been moved
    CHECK(std::abs(step.x1[0] - exact[0]) < 3e-12);
    CHECK(std::abs(step.x1[1] - exact[1]) < 1e-7);
    CHECK(std::abs(step.dxdt1[1] - exact[2]) < 2e-3);
  }
}

TEST_CASE(
    "a hinge that grazes its latch is not moved there along the slope at the end: the step is "
    "made again") {
  // past the latch by 1 nrad, at 20 µrad/s, and turning back at 1 rad/s²: the slope is lost within the way
  Arriving at(latches_only);
  REQUIRE(at.landing.cut_at_event({}, 1e-6));
  Step<double>& step = at.run.step;
  const auto arrives = [&step](double rate) {
    step.h = 1;
    step.x = {0.5 + rate - 1e-9, -1 - rate}, step.dxdt = {-1 - rate, 1};
    step.x1 = {-1e-9, -rate}, step.dxdt1 = {-rate, 1};
  };
  constexpr double slow = 2e-5, quick = 2e-4; // rad/s; the ways take 5e-5 and 5e-6 s
  arrives(slow);
  CHECK(at.landing.correct_end());
  arrives(quick);
  CHECK_FALSE(at.landing.correct_end());
  CHECK(at.landing.carry_end_to_event());
  CHECK(std::abs(step.x1[0]) < 1e-12);
}

TEST_CASE("a step is moved to its event once, and not where the run turns to another step") {
  const auto moves_after = [](auto&& act) {
    Arriving at(latches_only);
    REQUIRE(at.landing.cut_at_event({}, 1e-6));
    at.overshoot();
    REQUIRE_FALSE(at.landing.correct_end());
    act(at);
    return at.landing.carry_end_to_event();
  };
  CHECK(moves_after([](Arriving&) {}));
  CHECK_FALSE(moves_after([](Arriving& at) { at.landing.carry_end_to_event(); }));
  CHECK_FALSE(moves_after([](Arriving& at) { at.landing.expect_no_event(); }));
  CHECK_FALSE(moves_after([](Arriving& at) { (void)at.landing.cut_at_event({}, 1e-6); }));
}

namespace {

/// Two pairs of discs on a fixed base, each pair with a damped loop that goes slack at |x_a − x_b| = 2 M_p/K = 0.1 rad, on
/// steps in which the outer disc of each pair moves evenly: the discs are so heavy that the loops hardly turn them.
struct TwoLoops : LandingRun {
  TwoLoops() : LandingRun(two_pairs(), latches_only) {
    run.step.t = 1, run.step.h = 0.1;
    run.step.x = at({0, 0}), run.step.dxdt.assign(8, 0);
    system(run.step.x, run.step.dxdt, 1);
  }

  /// Ends the step with these angles of the outer discs, reached evenly.
  void end(const std::array<double, 2>& angles) {
    Step<double>& step = run.step;
    step.x = at({0, 0}), step.x1 = at(angles);
    for (const int pair : {0, 1})
      for (State<double>* x : {&step.x, &step.x1}) (*x)[5 + 2 * pair] = angles[pair] / step.h;
    for (auto [x, dxdt] : {std::pair{&step.x, &step.dxdt}, std::pair{&step.x1, &step.dxdt1}}) {
      dxdt->assign(8, 0);
      std::copy(x->begin() + 4, x->end(), dxdt->begin());
    }
  }

  [[nodiscard]] static State<double> at(const std::array<double, 2>& angles) {
    return {0, angles[0], 0, angles[1], 0, 0, 0, 0};
  }

  [[nodiscard]] static Scene two_pairs() {
    Scene scene = coaxial_discs(1e6, 1e6);
    scene.bodies.push_back({"disc_3", 1, 1e6}), scene.bodies.push_back({"disc_4", 1, 1e6});
    for (const int k : {0, 1}) {
      Hinge hinge = scene.hinges[k];
      hinge.name += "_of_pair_2";
      hinge.parent = k == 0 ? -1 : 2, hinge.child = 2 + k;
      scene.hinges.push_back(hinge);
    }
    for (const int pair : {0, 1}) {
      Synchronisation loop;
      loop.name = "cable_" + std::to_string(pair), loop.first = 2 * pair,
      loop.second = 2 * pair + 1;
      loop.stiffness = 100, loop.damping = 10, loop.preload = 5;
      scene.synchronisations.push_back(loop);
    }
    return scene;
  }
};

} // namespace

TEST_CASE("a jump that a refused step does not show is found in the step that ends at another") {
  const KinkLimit jumps{1e-8, 1e-10, true};
  // loop 1 goes slack at 0.06 s, loop 2 at 0.03 s; the refused step ends far off and has loop 2 taut throughout
  for (const int late : {0, 1}) {
    std::array<double, 2> refused{}, exact{};
    refused[late] = 0.1 * 0.1 / 0.06, refused[1 - late] = 0.05;
    TwoLoops pairs;
    pairs.end(refused);
    REQUIRE(pairs.landing.cut_refused_step(jumps, 1e-8));
    CHECK(pairs.run.step.h == Approx(0.06).epsilon(1e-4));
    exact[late] = 0.1 * pairs.run.step.h / 0.06;
    exact[1 - late] = 0.1 * pairs.run.step.h / 0.03;
    pairs.end(exact);
    CHECK_FALSE(pairs.landing.correct_end());
    REQUIRE(pairs.landing.cut_at_earlier_event(jumps));
    CHECK(pairs.run.step.h == Approx(0.03).epsilon(1e-4));
    // no other lies before that one
    exact[late] = 0.1 * pairs.run.step.h / 0.06;
    exact[1 - late] = 0.1 * pairs.run.step.h / 0.03;
    pairs.end(exact);
    CHECK_FALSE(pairs.landing.correct_end());
    CHECK_FALSE(pairs.landing.cut_at_earlier_event(jumps));
    CHECK(pairs.landing.at_jump());
  }
}

// Under exact friction a panel with a smoothed latch comes to rest: not at its latch, whose state S then goes on with its
// own rate.
TEST_CASE(
    "a step that is moved to its event ends there in every component, a smoothed latch's too") {
  Scene scene = latching_panel();
  rub(scene.hinges[0], 4);
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  const Integration how;
  System<double, Tree, BaseMotion::fixed> system(wing, 1e-3, work);
  Underway<double, decltype(system)> run(system, how, latches_only);
  Events<double, decltype(system)> events(system);
  events.start();
  Landing<double, decltype(system)> landing(run, events);
  const Layout& at = system.layout();
  const int angle = at.angle(1), rate = at.rate(1), latch = at.latch(1);
  system.set_contact(1, Contact::forward);
  constexpr double slowing = -2, from = 0.7, speed = 0.1, engaged = 0.25, fills = 0.4;
  const auto state = [&](double t, State<double>& x, State<double>& dxdt) {
    x.assign(at.size(), 0), dxdt.assign(at.size(), 0);
    x[angle] = from + t * (speed + 0.5 * slowing * t), x[rate] = speed + slowing * t;
    dxdt[angle] = x[rate], dxdt[rate] = slowing;
    x[latch] = engaged + fills * t, dxdt[latch] = fills;
  };
  for (const double share : {-5e-4, 5e-4, 5e-5}) { // of the step, by which its end misses the rest
    run.step.t = 3, run.step.h = 0.1;
    state(0, run.step.x, run.step.dxdt), state(0.1, run.step.x1, run.step.dxdt1);
    REQUIRE(landing.cut_at_event({}, 1e-4));
    const double rests = -speed / slowing;
    CHECK(run.step.h == Approx(rests).epsilon(1e-9));
    run.step.h = rests * (1 + share);
    state(run.step.h, run.step.x1, run.step.dxdt1);
    CAPTURE(share);
    CHECK_FALSE(landing.correct_end());
    CHECK(landing.carry_end_to_event());
    State<double> x, dxdt;
    state(run.step.h, x, dxdt); // where the step ends now
    for (int k = 0; k < at.size(); ++k) {
      CAPTURE(k);
      CHECK(std::abs(run.step.x1[k] - x[k]) < 1e-12);
    }
    CHECK(std::abs(run.step.x1[rate]) < 1e-12);
  }
}
