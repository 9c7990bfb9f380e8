// `auto`: which method integrates a run, and when.
#include "core/deployment.hpp"
#include "core/methods/method_choice.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <numbers>
#include <string>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

Scene with_latches(const Latch& latch) {
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) hinge.latch = latch;
  return scene;
}

/// The method that integrated at time t, the later one where two meet.
std::string method_at(const Outcome& out, double t) {
  std::string name;
  for (const Phase& phase : out.phases)
    if (phase.from <= t) name = phase.method;
  return name;
}

double time_by(const std::string& method, const Outcome& out) {
  double sum = 0;
  for (const Phase& phase : out.phases)
    if (phase.method == method) sum += phase.to - phase.from;
  return sum;
}

/// Phases cover the run from 0 to its end without gaps. Each has another method than the one before, and
/// their steps add up to the run's.
void check_phases(const Outcome& out) {
  REQUIRE_FALSE(out.phases.empty());
  CHECK(out.phases.front().from == 0);
  CHECK(out.phases.back().to == out.t_end);
  long steps = 0;
  for (std::size_t k = 0; k < out.phases.size(); ++k) {
    const Phase& phase = out.phases[k];
    steps += phase.steps;
    CHECK(phase.to >= phase.from);
    if (k == 0) continue;
    CHECK(phase.from == out.phases[k - 1].to);
    CHECK(phase.method != out.phases[k - 1].method);
  }
  CHECK(steps == out.work.steps);
}

Outcome run(const Scene& scene, double rtol, const std::string& method = "auto") {
  Integration how = within(rtol, 12, 1e-4);
  how.method = method;
  const Outcome out = Deployment().run(scene, how, {.to_t_end = true});
  CAPTURE(method, rtol, methods_used(out));
  check_phases(out);
  return out;
}

} // namespace

TEST_CASE("auto begins with dop853, at loose tolerances with dopri5") {
  for (const double rtol : {1e-1, 1e-2, 6e-3})
    CHECK(method_at(run(seed_scene(), rtol), 0) == "dopri5");
  for (const double rtol : {4e-3, 1e-3, 1e-4, 6e-5})
    CHECK(method_at(run(seed_scene(), rtol), 0) == "dop853");
  for (const double rtol : {1e-3, 1e-4}) { // later where latches are smoothed
    Integration how = within(rtol, 1, 1e-4);
    how.smoothing = 1e-3;
    CHECK(methods_used(Deployment().run(seed_scene(), how, {})) ==
          (rtol < 5e-4 ? "dop853" : "dopri5"));
  }
}

TEST_CASE(
    "at tight tolerances auto begins with taylor where the motion has series and no friction") {
  for (const double rtol : {4e-5, 1e-8, 1e-12}) {
    CHECK(methods_used(run(seed_scene(), rtol)) == "taylor");
    Scene rubs = seed_scene();
    rubs.hinges[1].friction.coulomb = 0.1;
    CHECK(method_at(run(rubs, rtol), 0) == "dop853");
    rubs.hinges[1].friction.model = FrictionModel::exact;
    CHECK(method_at(run(rubs, rtol), 0) == "dop853");
    Scene weighs = seed_scene();
    weighs.environment.gravity = {0, -1e-3};
    CHECK(method_at(run(weighs, rtol), 0) == "dop853");
    Integration how = within(rtol, 1, 1e-4);
    how.smoothing = 1e-3;
    CHECK(methods_used(Deployment().run(seed_scene(), how, {})) == "dop853");
  }
}

TEST_CASE("a wing without series gets dop853 in place of taylor") {
  Integration how = within(1e-8, 5);
  how.method = "taylor";
  Scene scene = seed_scene();
  CHECK(methods_used(Deployment().run(scene, how, {})) == "taylor");
  scene.hinges[1].stop = Stop{500, 0.2, 0};
  CHECK(methods_used(Deployment().run(scene, how, {})) == "dop853");
}

TEST_CASE("the step that auto counts as held back is a share of the explicit method's stable one") {
  const auto check = [](double rtol, bool series, Method first, double stable) {
    MethodChoice choice(within(rtol, 1), series);
    REQUIRE(choice.active() == first);
    choice.restart(0, 0, std::numeric_limits<double>::infinity(), true);
    for (const double radius : {1e-2, 1., 3e5}) {
      CAPTURE(rtol, series, radius);
      choice.set_radius(radius, 0, 0);
      CHECK(choice.first_step(1e9) == Approx(0.5 * stable / radius));
      CHECK(choice.held_back().shortest == Approx(choice::held_back_share * stable / radius));
    }
  };
  check(1e-8, true, Method::taylor, TaylorSeries<double>::stable_real);
  check(1e-8, false, Method::dop853, DormandPrince853<double>::stable_real);
  check(1e-2, true, Method::dopri5, DormandPrince5<double>::stable_real);
}

TEST_CASE("a lane may accept just the steps after which auto does not measure a radius") {
  for (const long begun : {0L, 1L, 5L, 6L, 7L, 8L, 127L, 128L, 134L, 135L, 1000L}) {
    MethodChoice choice(within(1e-8, 1), false);
    choice.restart(0, 0, std::numeric_limits<double>::infinity(), true);
    choice.resume(begun, choice.held_back());
    const long more = choice.steps_to_radius();
    CAPTURE(begun, more);
    REQUIRE(more >= 0);
    for (long k = 1; k <= more + 1; ++k) {
      choice.resume(begun + k, choice.held_back());
      CHECK(choice.wants_radius() == (k > more));
    }
  }
  CHECK(MethodChoice(within(1e-8, 1), false).steps_to_radius() < 200);
  Integration named = within(1e-8, 1);
  named.method = "dop853";
  CHECK(MethodChoice(named, false).steps_to_radius() == std::numeric_limits<long>::max());
}

TEST_CASE(
    "a radius measured where its bound holds steps back decides as early as one measured from "
    "the start") {
  for (const int free : {0, 3, 40}) {
    MethodChoice choice(within(1e-8, 1), false);
    choice.restart(0, 0, 1e3, true); // bounded by 1e3 1/s
    double time = 0;
    long evaluations = 0;
    const auto leaves_after = [&](double h) {
      return choice.after_step(h, time += h, evaluations += 12, 1.0);
    };
    const double h = choice.held_back().shortest;
    for (int k = 0; k < free; ++k) REQUIRE_FALSE(leaves_after(0.99 * h));
    int by_bound = 0, by_radius = 0;
    for (; !choice.wants_radius(); ++by_bound) {
      REQUIRE(by_bound < 50);
      REQUIRE_FALSE(leaves_after(1.01 * h));
    }
    CHECK(by_bound == HeldBackSteps<double>::enough);
    choice.set_radius(1e3, time, evaluations);
    for (bool leaves = false; !leaves; ++by_radius) {
      REQUIRE(by_radius < 50);
      leaves = leaves_after(1.01 * h);
    }
    CAPTURE(free);
    CHECK(by_radius == choice::steps_to_first_radius);
  }
}

TEST_CASE(
    "auto leaves the implicit method soon where its steps do not pay, and stays where they do") {
  for (const double pays : {0.2, 5.0}) { // time by an evaluation, against what it would have to be
    MethodChoice choice(within(1e-8, 1), false);
    choice.restart(0, 0, std::numeric_limits<double>::infinity(), true);
    choice.set_radius(1e3, 0, 0);
    const double h = choice.held_back().shortest * 1.01;
    double time = 0;
    long evaluations = 0;
    for (int k = 0; choice.active() == Method::dop853; ++k) {
      REQUIRE(k < 50);
      (void)choice.after_step(h, time += h, evaluations += 12, 1.0);
    }
    REQUIRE(choice.active() == Method::seulex);
    int steps = 0;
    bool leaves = false;
    for (; steps < 100 && !leaves; ++steps) {
      const double step = pays * choice::implicit_cost * h * 30 / 12;
      CHECK(choice.may_leave(step));
      leaves = choice.after_step(step, time += step, evaluations += 30, 1.0);
    }
    CAPTURE(pays, steps);
    CHECK(leaves == (pays < 1));
    CHECK(choice.active() == (leaves ? Method::dop853 : Method::seulex));
    CHECK(steps > choice::unjudged_steps);
    if (leaves) CHECK(steps <= choice::unjudged_steps + 2 * choice::bearable_steps);
  }
}

TEST_CASE("auto leaves steps that are not surely held back on a clear promise only") {
  const double stable = DormandPrince853<double>::stable_real / 1e3;
  struct Case {
    double share, highest_frequency; ///< of a step in the stable one; 1/s
    int first, last;                 ///< step after which auto leaves
  };
  constexpr int never = 3000;
  const auto near = [&](double share, double of_promise) {
    return of_promise * choice::clearly_promising_share / (share * stable);
  };
  const double sure = choice::promising_share / stable;
  for (const Case& c :
       {Case{0.11, near(0.11, 0.9), 5, 50}, Case{0.11, near(0.11, 1.1), never, never},
        Case{0.39, near(0.39, 0.9), 5, 50}, Case{0.39, near(0.39, 1.1), never, never},
        Case{0.09, 0, never, never}, Case{0.41, 0.9 * sure, 5, 50},
        Case{0.41, 1.1 * sure, choice::steps_to_try_anyway, choice::steps_to_try_anyway + 90}}) {
    MethodChoice choice(within(1e-8, 1), false);
    choice.restart(0, 0, std::numeric_limits<double>::infinity(), true);
    choice.set_radius(1e3, 0, 0);
    double time = 0;
    long evaluations = 0;
    int steps = 0;
    for (bool leaves = false; !leaves && steps < never; ++steps)
      leaves = choice.after_step(c.share * stable, time += c.share * stable, evaluations += 12,
                                 c.highest_frequency);
    CAPTURE(c.share, c.highest_frequency, steps);
    CHECK(steps >= c.first);
    CHECK(steps <= c.last);
  }
}

TEST_CASE("auto keeps its first method if nothing is stiff") {
  Scene scene = harmonic_panel();
  CHECK(methods_used(run(scene, 1e-8)) == "taylor");
  CHECK(methods_used(run(scene, 1e-4)) == "dop853");
  CHECK(methods_used(run(scene, 1e-2)) == "dopri5");
  // mildly stiff: another method only where it saves evaluations
  const Outcome out = run(seed_scene(), 1e-8), plain = run(seed_scene(), 1e-8, "taylor");
  CHECK(out.status == Status::deployed);
  CHECK(out.work.rhs_evaluations <= plain.work.rhs_evaluations);
}

TEST_CASE("after stiff latches auto continues with seulex, and phases tell it") {
  const Scene scene = with_latches({1e4, 1e4});
  for (const double rtol : {1e-2, 1e-3, 1e-6}) {
    const Outcome out = run(scene, rtol);
    CAPTURE(rtol, methods_used(out));
    REQUIRE(out.latches.size() == 3);
    CHECK(methods_used(out) == (rtol < 5e-5   ? "taylor, seulex"
                                : rtol < 5e-3 ? "dop853, seulex"
                                              : "dopri5, seulex"));
    for (const Phase& phase : out.phases) // not before the first latch
      if (phase.method == "seulex") CHECK(phase.from > out.latches[0].time);
    CHECK(method_at(out, out.latches[0].time) !=
          "seulex"); // the explicit one integrates the first shock
    CHECK(method_at(out, out.t_end) == "seulex");
    const double latched = out.t_end - out.latches[0].time;
    CHECK(time_by("seulex", out) > 0.9 * latched);
  }
}

TEST_CASE(
    "auto's choice saves most of the work where latches are stiff, and loses little elsewhere",
    "[long]") {
  struct Case {
    Latch latch;
    double rtol, at_most; ///< of the evaluations that the explicit method takes
  };
  for (const Case& c :
       {Case{{1e4, 1e4}, 1e-3, 0.04}, Case{{1e4, 1e4}, 1e-6, 0.06}, Case{{1e9, 1e5}, 1e-6, 0.04},
        Case{{1e6, 1e3}, 1e-6, 1.1}, Case{{1e4, 100}, 1e-6, 1.1}, Case{{1e4, 100}, 1e-10, 1.1}}) {
    const Scene scene = with_latches(c.latch);
    const Outcome chosen = run(scene, c.rtol),
                  plain = run(scene, c.rtol, c.rtol < 5e-5 ? "taylor" : "dop853");
    CAPTURE(c.latch.stiffness, c.latch.damping, c.rtol, chosen.work.rhs_evaluations,
            plain.work.rhs_evaluations, plain.reason);
    CHECK(chosen.status == Status::deployed);
    const bool gave_up_there = gave_up(plain) && plain.t_end < chosen.t_end;
    CHECK((gave_up_there || plain.status == Status::deployed));
    CHECK(static_cast<double>(chosen.work.rhs_evaluations) <
          c.at_most * static_cast<double>(plain.work.rhs_evaluations));
  }
}

TEST_CASE("auto goes on implicitly where an elastic hold is stiff on a light panel") {
  Scene scene = seed_scene();
  scene.bodies.pop_back(), scene.hinges.pop_back();
  for (Body& body : scene.bodies) body.mass = 0.2, body.inertia = 7e-4;
  for (Hinge& hinge : scene.hinges) hinge.spring.scale = 1e-4;
  scene.hinges[1].release = Release{.time = 5};
  scene.hinges[1].hold = Hold{5e4, 60};
  Integration how = within(1e-8, 1);
  const Outcome out = Deployment().run(scene, how, {});
  how.method = "dop853";
  const Outcome plain = Deployment().run(scene, how, {});
  CAPTURE(methods_used(out), out.work.rhs_evaluations, plain.work.rhs_evaluations);
  CHECK(4 * out.work.rhs_evaluations < plain.work.rhs_evaluations);
  CHECK(time_by("seulex", out) > 0.6 * out.t_end);
}

TEST_CASE("what a run records changes neither its methods nor its motion", "[long]") {
  const int wings = random_cases(600, 40),
            first = 100; // two of the 40 leave the implicit method by its cost
  int implicit = 0;
  for (int seed = first; seed < first + wings; ++seed) {
    Draws draws(static_cast<std::uint64_t>(seed));
    Scene scene = with_latches({draws.log_uniform(1e3, 1e6), draws.log_uniform(1, 300)});
    for (Body& body : scene.bodies) body.mass *= draws.log_uniform(0.05, 1), body.inertia = 0.02;
    if (draws.chance(0.5)) {
      scene.hinges[1].release = Release{.time = draws.uniform(0.1, 3)};
      scene.hinges[1].hold = Hold{draws.log_uniform(1e3, 1e5), draws.log_uniform(1, 100)};
    }
    const Integration how = within(1e-8, 6);
    const Outcome all = Deployment().run(scene, how, {.to_t_end = true});
    implicit += time_by("seulex", all) > 0;
    for (const Goal& goal : {Goal{.peak_moment = false, .peak_force = false, .to_t_end = true},
                             Goal{.peak_moment = false, .to_t_end = true},
                             Goal{.peak_force = false, .hold_moment = false, .to_t_end = true}}) {
      const Outcome out = Deployment().run(scene, how, goal);
      CAPTURE(seed, methods_used(all), methods_used(out), goal.peak_moment, goal.peak_force);
      CHECK(out.work.steps == all.work.steps);
      REQUIRE(out.latches.size() == all.latches.size());
      for (std::size_t i = 0; i < all.latches.size(); ++i) {
        CHECK(out.latches[i].time == all.latches[i].time);
        CHECK(out.latches[i].rates == all.latches[i].rates);
      }
    }
  }
  CHECK(implicit > 10);
}

TEST_CASE("auto goes on with the implicit method after events") {
  // stiff dampers on light panels that stick and slide: each event once began the explicit method anew
  Scene scene = seed_scene();
  scene.bodies.pop_back(), scene.hinges.pop_back();
  for (Body& body : scene.bodies) body.mass = 2e-3, body.inertia = 3e-4;
  for (Hinge& hinge : scene.hinges) {
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = 0.05;
    hinge.latch = Latch{2e3, 0.5};
    Damper damper;
    damper.law = DamperLaw::eddy_current, damper.peak_torque = 0.4, damper.peak_rate = 0.01;
    hinge.damper = damper;
  }
  const Outcome chosen = run(scene, 1e-8), implicit = run(scene, 1e-8, "seulex");
  REQUIRE(chosen.status == implicit.status);
  REQUIRE(chosen.peak_moment.size() == implicit.peak_moment.size());
  CHECK(chosen.work.rhs_evaluations < 2 * implicit.work.rhs_evaluations);
}

TEST_CASE("a method that is asked for by name is the only one") {
  for (const std::string_view name : method_names) {
    if (name == "runge_kutta4") continue; // its step would have to be chosen
    CHECK(methods_used(run(seed_scene(), 1e-6, std::string(name))) == name);
  }
}

TEST_CASE("implicit steps do not stay below the hump of a fast mode that has died out") {
  // the outermost latch engages first: its ringing is over after some 10 µs, and the motion goes on for seconds
  Scene scene;
  scene.bodies = {{"b0", 0.0496, 0.00402}, {"b1", 0.0536, 0.0044}, {"b2", 0.0511, 0.00575}};
  scene.hinges.resize(3);
  const HingeTorque springs[] = {{0.0303, 0.0258}, {0.0124, 0.00906}, {0.0599, 0.0257}};
  const Latch latches[] = {{4.86e6, 48.7}, {2.8e4, 9.69}, {1.41e8, 786}};
  for (int i = 0; i < 3; ++i) {
    Hinge& hinge = scene.hinges[i];
    hinge.name = "h" + std::to_string(i), hinge.parent = i - 1, hinge.child = i;
    hinge.parent_point = {i == 0 ? 0.3 : 0.538, 0}, hinge.child_point = {-0.538, 0.01};
    hinge.stowed = (i == 1 ? -1 : 1) * (i == 0 ? std::numbers::pi / 2 : std::numbers::pi);
    hinge.spring = springs[i], hinge.latch = latches[i];
  }
  Damper viscous, eddy;
  viscous.coefficient = 0.161;
  eddy.law = DamperLaw::eddy_current, eddy.peak_torque = 0.00571, eddy.peak_rate = 0.727;
  scene.hinges[0].damper = viscous, scene.hinges[1].damper = eddy;
  Integration how;
  how.t_end = 5;
  const Outcome out = Deployment().run(scene, how, to_the_end);
  REQUIRE(out.latches.size() == 1);
  CHECK(method_at(out, 5) == "seulex");
  CHECK(out.work.rhs_evaluations < 15'000); // 9,000; without leaps 42,000
  how.rtol = 1e-11, how.atol = 1e-13;
  const Outcome exact = Deployment().run(scene, how, to_the_end);
  for (int i = 0; i < 3; ++i) CHECK(std::abs(out.final.angles[i] - exact.final.angles[i]) < 1e-6);
}
