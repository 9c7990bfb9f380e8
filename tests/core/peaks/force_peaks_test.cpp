// Peak forces of whole runs against the dense oracle in extended precision.
#include "core/deployment.hpp"
#include "core/peaks/force_peaks.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Three panels of which the middle hinge's largest force lies inside a step, near half of a fast
/// swing's period, where both ends of the step are below 0.55 of it.
Scene swinging_wing() {
  Scene scene = seed_scene();
  const HingeTorque springs[] = {{1.99048, 1.39333}, {1.49485, 0.498283}, {0.72635, 0.0968466}};
  const Latch latches[] = {{11475.5, 11.7765}, {10182.2, 3.97612}, {10278, 4.55992}};
  for (int i = 0; i < 3; ++i)
    scene.hinges[i].spring = springs[i], scene.hinges[i].latch = latches[i];
  return scene;
}

double largest_error(const std::vector<Peak>& got, const std::vector<ReferencePeak>& expected) {
  double worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i)
    worst = std::max(worst, std::abs(got[i].value / expected[i].value - 1));
  return worst;
}

} // namespace

TEST_CASE("a peak force is found where both ends of a step are low, by every method", "[long]") {
  const Scene scene = swinging_wing();
  ReferenceOptions options;
  options.t_end = 9, options.rtol = 1e-15, options.atol = 1e-16;
  const ReferenceOutcome exact = high_precision_run<long double>(scene, options);
  CHECK(exact.peak_force[1].value == Approx(167.98457).epsilon(1e-6));
  for (const MethodInfo& method : methods())
    for (const double rtol : {1e-3, 1e-4, 1e-6}) {
      if (method.name == "runge_kutta4" || (method.name == "rosenbrock_w" && rtol < 1e-4)) continue;
      Integration how = within(rtol, 9);
      how.method = method.name;
      const Outcome out = Deployment().run(scene, how, to_the_end);
      CAPTURE(method.name, rtol);
      // what the steps' own errors add up to in the moments, the forces may be off; ten times the
      // tolerance where the moments happen to be better
      const double moments = largest_error(out.peak_moment, exact.peak_moment);
      CHECK(largest_error(out.peak_force, exact.peak_force) < 3 * moments + 10 * rtol);
    }
}

TEST_CASE("peak forces of loosely integrated wings are as good as their moments") {
  double worst = 0;
  for (int k = 0; k < 60; ++k) {
    Draws draws(1000 + k);
    Scene scene = seed_scene();
    for (Hinge& hinge : scene.hinges) {
      const double spring = draws.uniform(0.95, 1.05);
      hinge.spring.torque_stowed *= spring, hinge.spring.torque_latched *= spring;
      hinge.latch = Latch{1e4 * draws.uniform(0.8, 1.2), draws.log_uniform(1, 130)};
    }
    Integration tight = within(1e-11, 9);
    tight.method = "dop853";
    const Outcome exact = Deployment().run(scene, tight, to_the_end),
                  loose = Deployment().run(scene, within(1e-3, 9), to_the_end);
    for (int i = 0; i < 3; ++i)
      worst = std::max(worst, std::abs(loose.peak_force[i].value / exact.peak_force[i].value - 1));
  }
  CHECK(worst < 2e-3); // twice the tolerance; a missed peak is off by 2 to 12 %
}

TEST_CASE("a peak force inside a step has its own time") {
  // φ = 2 cos t: |f|² = (m c)² (16 sin⁴ t + 4 cos² t), at most (m c · 4)² at π/2
  for (const char* method : {"auto", "dopri5", "dop853", "bulirsch_stoer"}) {
    Integration how = within(1e-8, 3);
    how.method = method;
    const Outcome out = Deployment().run(unit_oscillator(2), how, to_the_end);
    CAPTURE(method);
    CHECK(out.peak_force[0].value == Approx(20).epsilon(1e-7));
    CHECK(out.peak_force[0].time == Approx(1.57079632679).epsilon(1e-4));
  }
}

TEST_CASE("a crest of the force between the places where it is sampled is not passed over") {
  // the same swing over a step of 0.8 s, with its crest at a part of it; the largest force so far is lower by 1e-4
  const Scene scene = unit_oscillator(2);
  for (const double part : {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}) {
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    system.want_forces(true);
    const double h = 0.8, from = 0.5 * std::numbers::pi - part * h;
    const auto state = [](double t) { return State<double>{2 * std::cos(t), -2 * std::sin(t)}; };
    Step<double> step{from, h, state(from), State<double>(2), state(from + h), State<double>(2)};
    ForcePeaks<double, decltype(system)> forces;
    forces.start(system);
    system(step.x, step.dxdt, from);
    forces.sample(system, from);
    forces.peaks[1].value = 20 * (1 - 1e-4);
    system(step.x1, step.dxdt1, from + h);
    State<double> x(2), dxdt(2);
    forces.over_step(system, step, x, dxdt);
    CAPTURE(part);
    REQUIRE(forces.doubtful().has_value());
    CHECK(*forces.doubtful() == Approx(part).margin(1e-3));
  }
}

TEST_CASE("the place of a force's maximum is corrected by Newton's method along the motion") {
  // θ = 2 cos t: |F| ∝ √(θ̈² + θ̇⁴) has a crest at t = π/2, which the dense output misplaces
  const Scene scene = unit_oscillator(2);
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  system.want_forces(true);
  State<double> x, dxdt;
  system.start(x);
  dxdt.resize(x.size());
  for (const double from : {0.7, 1.0, 1.2}) {
    Step<double> step;
    step.t = from, step.h = 0.9;
    const auto evaluate = [&](double s, State<double>& q, State<double>& rates) {
      const double t = step.t + s * step.h;
      q = {2 * std::cos(t), -2 * std::sin(t)}, rates = {q[1], -q[0]};
      State<double> found(2);
      system(q, found, t);
      CHECK(found[1] == Approx(rates[1]).margin(1e-12));
    };
    ForcePeaks<double, decltype(system)> forces;
    forces.start(system, 1e-14);
    evaluate(0, step.x, step.dxdt);
    forces.sample(system, step.t);
    evaluate(1, step.x1, step.dxdt1);
    forces.over_step(system, step, x, dxdt);
    const double place = (0.5 * std::numbers::pi - step.t) / step.h;
    CAPTURE(from, place);
    REQUIRE(forces.doubtful());
    const double off = std::abs(*forces.doubtful() - place);
    evaluate(*forces.doubtful(), x, dxdt);
    forces.confirm(system, step, x, dxdt);
    CHECK(off > 1e-6);
    CHECK(off < 0.02);
    REQUIRE(forces.doubtful());
    CHECK(std::abs(*forces.doubtful() - place) < 0.4 * off); // by the bend of five samples
    const double crest = 10 * 0.5 * 4;                       // m c θ̇²
    CHECK(forces.peaks[1].value == Approx(crest).epsilon(1e-3));
    CHECK(forces.peaks[1].value <= crest * (1 + 1e-12));
  }
}

namespace {

/// A step of the swing θ = 2 cos t whose crest of the force lies inside, with the exact states.
struct CrestInStep {
  CrestInStep(double from, double h, const Scene& of = unit_oscillator(2))
      : scene(of), wing(make_wing<double>(scene, outward_order(scene))) {
    set_parameters(wing, scene);
    system.reset();
    system.want_forces(true);
    step.t = from, step.h = h;
    place = (0.5 * std::numbers::pi - from) / h;
  }
  void evaluate(double s, State<double>& q, State<double>& rates) {
    const double t = step.t + s * step.h;
    q = {2 * std::cos(t), -2 * std::sin(t)}, rates = {q[1], -q[0]};
    State<double> found(2);
    system(q, found, t);
  }
  /// The places at which the force is evaluated for a gain that is worth a step: the doubt, and its corrections.
  /// @param before the largest force before the step, N
  std::vector<double> places(double worth, double before = 0) {
    State<double> x(2), dxdt(2);
    forces.start(system, worth);
    evaluate(0, step.x, step.dxdt);
    forces.sample(system, step.t);
    forces.peaks[1].raise(before, 0);
    evaluate(1, step.x1, step.dxdt1);
    forces.over_step(system, step, x, dxdt);
    std::vector<double> all;
    while (forces.doubtful()) {
      all.push_back(*forces.doubtful());
      evaluate(all.back(), x, dxdt);
      forces.confirm(system, step, x, dxdt);
    }
    return all;
  }

  Scene scene;
  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system{wing, std::nullopt, work};
  Step<double> step;
  ForcePeaks<double, decltype(system)> forces;
  double place = 0;
};

} // namespace

// A peak that is right but late costs no accuracy that a run shows: the corrections are held against the crest itself.
TEST_CASE("corrections of a force's maximum converge, are two at most, and stop once they gain too "
          "little") {
  const double crest = 10 * 0.5 * 4;
  std::array<int, 4> by_count{};
  for (int k = 0; k < 60; ++k) {
    Draws draws(40 + k);
    const double h = draws.uniform(0.5, 1.3),
                 from = 0.5 * std::numbers::pi - h * draws.uniform(0.2, 0.8);
    CAPTURE(h, from);
    CrestInStep eager(from, h);
    const std::vector<double> all = eager.places(1e-16);
    REQUIRE(all.size() >= 1);
    REQUIRE(all.size() <= 3);
    for (std::size_t c = 1; c < all.size(); ++c)
      if (std::abs(all[c - 1] - eager.place) > 1e-6)
        CHECK(std::abs(all[c] - eager.place) < 0.4 * std::abs(all[c - 1] - eager.place));
    const double off = std::abs(all.back() - eager.place) * h;
    CHECK(eager.forces.peaks[1].time == Approx(from + all.back() * h).margin(0.05));
    CHECK(off < 0.2 * std::abs(all[0] - eager.place) * h + 1e-6);
    for (const double worth : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      CrestInStep run(from, h);
      const std::vector<double> found = run.places(worth);
      const double lost = 1 - run.forces.peaks[1].value / crest;
      CAPTURE(worth, found.size(), lost);
      CHECK(lost < 4 * worth + 1e-14);
      ++by_count.at(found.size());
    }
  }
  CHECK(std::min({by_count[1], by_count[2], by_count[3]}) >= 20);
}

// A light plate on a heavy shaft: the hinge bears the air alone, of which the bound on reactions knows nothing.
TEST_CASE("a crest of the air's force inside a step is found, wherever it lies") {
  Scene scene = unit_oscillator(2);
  scene.bodies[0].mass = 1e-9, scene.bodies[0].inertia = 1e6;
  scene.bodies[0].plate = Plate{{0, -0.3}, {0, 0.7}, 1, 2};
  scene.environment.air_density = 1;
  for (const double part : {0.2, 0.25, 0.4, 0.5, 0.6, 0.75, 0.8}) {
    CrestInStep run(0.5 * std::numbers::pi - part * 0.8, 0.8, scene);
    std::vector<double> found = run.places(1);
    CAPTURE(part);
    const double crest = run.forces.peaks[1].value;
    State<double> x(2), rates(2);
    run.evaluate(part, x, rates);
    CHECK(crest == Approx(std::hypot(run.work.forces[1].x, run.work.forces[1].y)).epsilon(1e-3));
    CHECK(run.forces.peaks[1].time == Approx(0.5 * std::numbers::pi).margin(0.02));
    REQUIRE(found.size() == 1);
    CHECK(found[0] == Approx(part).margin(0.02));
  }
}

// The peak so far lies just below the crest, and above the force at the step's middle and ends.
TEST_CASE("a crest of the air's force beside the middle of a step is found above a peak nearly as "
          "large") {
  Scene scene = unit_oscillator(2);
  scene.bodies[0].mass = 1e-9, scene.bodies[0].inertia = 1e6;
  scene.bodies[0].plate = Plate{{0, -0.3}, {0, 0.7}, 1, 2};
  scene.environment.air_density = 1;
  for (const double part : {0.2, 0.25, 0.75, 0.8}) {
    CrestInStep run(0.5 * std::numbers::pi - part * 0.8, 0.8, scene);
    State<double> x(2), rates(2);
    run.evaluate(part, x, rates);
    const double crest = std::hypot(run.work.forces[1].x, run.work.forces[1].y);
    const std::vector<double> found = run.places(1, crest * (1 - 1e-3));
    CAPTURE(part, crest);
    REQUIRE(found.size() == 1);
    CHECK(found[0] == Approx(part).margin(0.02));
  }
}
