// Dampers and drag: whole runs against closed forms.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/random_scenes.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

Scene braked(const Damper& damper) {
  Scene scene = thrown_panel();
  scene.hinges[0].damper = damper;
  return scene;
}

Damper viscous(double c) {
  Damper damper;
  damper.coefficient = c;
  return damper;
}
Damper power_law(double A, double p) {
  Damper damper;
  damper.law = DamperLaw::power, damper.coefficient = A, damper.exponent = p;
  return damper;
}
Damper eddy_current(double torque, double rate) {
  Damper damper;
  damper.law = DamperLaw::eddy_current, damper.peak_torque = torque, damper.peak_rate = rate;
  return damper;
}

void check_both_senses(const Scene& scene, const Arrival& exact, double t_end) {
  check_arrival(run_everywhere(scene, 1e-11, t_end), exact, 1e-8);
  check_arrival(run_everywhere(other_sense(scene), 1e-11, t_end), exact, 1e-8);
}

/// A fluid damper that lets ω = T^n'/A' rad/s through, T in in·lbf.
struct FluidDamper {
  double A, exponent; ///< A', n'
  double seconds;     ///< to deploy by 90° under 60 to 28 in·lbf, s
};
constexpr double inch_pound = 0.1129848290276167; // N·m
/// A rate coefficient of a T^−b gives T = a T^−b ω: n' = 1 + b.
constexpr FluidDamper fluid_dampers[] = {
    {4e6, 2.315, 1181}, {7.96025e5, 2.111, 496}, {5.60677e5, 2.161, 291}};

/// A panel so light that its inertia moves the time by less than 1e-9.
Scene fluid_damped(const FluidDamper& fluid) {
  Scene scene;
  scene.name = "fluid_damped";
  scene.bodies = {{"panel", 1e-3, 1e-3, {}}};
  Hinge hinge;
  hinge.name = "root";
  hinge.latched = pi / 2, hinge.latch = Latch{};
  hinge.spring.torque_stowed = 60 * inch_pound, hinge.spring.torque_latched = 28 * inch_pound;
  hinge.damper = power_law(std::pow(fluid.A, 1 / fluid.exponent) * inch_pound, 1 / fluid.exponent);
  scene.hinges = {hinge};
  return scene;
}

} // namespace

TEST_CASE("one panel with a damper alone has its closed form") {
  const double I = panel_inertia;
  check_both_senses(braked(viscous(2)), viscous_arrival(I, 2, 1, 1), 3);
  check_both_senses(braked(power_law(1, 0.45)), power_law_arrival(I, 1, 0.45, 1, 1), 3);
  check_both_senses(braked(power_law(3, 1.5)), power_law_arrival(I, 3, 1.5, 1, 1), 3);
  check_both_senses(braked(eddy_current(1, 0.4)), eddy_current_arrival(I, 1, 0.4, 1, 1), 3);
  Damper scaled = viscous(1);
  scaled.scale = 2;
  check_both_senses(braked(scaled), viscous_arrival(I, 2, 1, 1), 3);
}

TEST_CASE("below its regularization rate a power law is linear") {
  Damper damper = power_law(2, 0.5);
  damper.regularization_rate = 4; // beyond every rate there is: c = 2 · 4^−½
  check_both_senses(braked(damper), viscous_arrival(panel_inertia, 1, 1, 1), 3);
}

TEST_CASE("a damper acts in its window, and nowhere else") {
  for (const auto& [from, to] : {std::pair(0.3, 0.6), {0.6, 0.3}}) {
    Damper damper = viscous(2);
    damper.window = {from, to};
    const Arrival inside = viscous_arrival(panel_inertia, 2, 1, 0.3);
    const Arrival exact{0.3 + inside.time + 0.4 / inside.rate, inside.rate};
    check_both_senses(braked(damper), exact, 3);
    with_every_method(braked(damper), within(1e-9, 3, 1e-4), {}, MayGiveUp::fixed_step,
                      [&](const Outcome& out) { check_arrival(out, exact, 1e-6); });
  }
  Damper from_the_start = eddy_current(2, 0.5); // its edge is where the hinge starts
  from_the_start.window = {0, 0.5};
  const Arrival inside = eddy_current_arrival(panel_inertia, 2, 0.5, 1, 0.5);
  check_both_senses(braked(from_the_start), {inside.time + 0.5 / inside.rate, inside.rate}, 3);
  Damper nowhere = viscous(100);
  nowhere.window = {1.5, 2};
  check_both_senses(braked(nowhere), {1, 1}, 3);
}

TEST_CASE("a damper whose window ends at the latched angle ends as the latch engages") {
  Draws dice(163);
  constexpr double c = 0.3, d = 5;
  for (int draw = 0; draw < 12; ++draw) {
    Scene scene = braked(viscous(c));
    Hinge& hinge = scene.hinges[0];
    hinge.stowed = dice.uniform(-3, 3), hinge.latched = hinge.stowed + 1;
    hinge.latch->stiffness = 1, hinge.latch->damping = d; // its moment falls from d ω
    // an end in another unit is rounded once more
    const double end =
        draw % 3 == 0 ? hinge.latched : std::nextafter(hinge.latched, draw % 3 == 1 ? 9 : -9);
    hinge.damper->window = std::array{hinge.stowed + dice.uniform(0, 0.9), end};
    const double way = end - (*hinge.damper->window)[0];
    const double rate = viscous_arrival(panel_inertia, c, 1, way).rate;
    for (const Scene& sense : {scene, other_sense(scene)})
      with_every_method(
          sense, within(1e-9, 3, 1e-4), {}, MayGiveUp::fixed_step, [&](const Outcome& out) {
            CAPTURE(draw, end);
            CHECK(relative(out.peak_moment[0].value, d * rate) < 1e-6); // with the damper 6 % more
          });
  }
}

TEST_CASE("a fluid damper deploys a wing in minutes, at the cost of a simple motion") {
  for (const FluidDamper& fluid : fluid_dampers) {
    const double exact = quasi_static_time(60, 28, pi / 2, fluid.A, fluid.exponent);
    CHECK(exact == Approx(fluid.seconds).margin(0.7));
    const Scene scene = fluid_damped(fluid);
    for (const double rtol : {1e-8, 1e-10}) {
      const Outcome out = run_everywhere(scene, rtol, 2000);
      CAPTURE(rtol, exact, out.work.steps, out.work.rhs_evaluations, methods_used(out));
      REQUIRE(out.latches.size() == 1);
      CHECK(relative(out.latches[0].time, exact) < 1e-8);
      // 2,748 to 3,212 in 113 to 136 steps at 1e-8, 4,983 to 5,415 at 1e-10; explicit ones a million
      CHECK(out.work.rhs_evaluations < (rtol > 1e-9 ? 4000 : 7000));
    }
  }
}

TEST_CASE("quadratic drag on one panel has its closed form") {
  Scene scene = thrown_panel();
  scene.environment.air_density = 1.2;
  scene.bodies[0].plate = Plate{{-0.5, 0}, {1, 0}, 2, 1.5}; // from the hinge, 1.5 m
  const double B = 1.2 * 1.5 * 2 * std::pow(1.5, 4) / 8;
  check_both_senses(scene, drag_arrival(panel_inertia, B, 1, 1), 6);
  scene.bodies[0].plate = Plate{{1, 0}, {-1, 0}, 2, 1.5}; // 1.5 m beyond the hinge, 0.5 m before
  const double both = 1.2 * 1.5 * 2 * (std::pow(1.5, 4) + std::pow(0.5, 4)) / 8;
  check_both_senses(scene, drag_arrival(panel_inertia, both, 1, 1), 6);
  scene.environment.air_density = 0; // in a vacuum a plate is nothing
  check_both_senses(scene, {1, 1}, 6);
}

TEST_CASE("without air a wing of plates is made as one without plates, whatever was made before") {
  const Scene bare = seed_scene();
  Scene plated = bare;
  for (Body& body : plated.bodies) body.plate = Plate{{-0.5, 0}, {0.5, 0}, 1, 1.2};
  const Outcome expected = Deployment().run(bare, within(1e-8, 60), {});
  REQUIRE(expected.peaks_final);
  Deployment deployment;
  for (const double density : {0., 1.2, 0.}) { // also after a run in air
    plated.environment.air_density = density;
    const Outcome out = deployment.run(plated, within(1e-8, 60), {});
    CAPTURE(density, out.t_end);
    CHECK((out.t_end == expected.t_end) == (density == 0));
    CHECK((out.peak_moment[0].value == expected.peak_moment[0].value) == (density == 0));
    CHECK((out.work.steps == expected.work.steps) == (density == 0));
    CHECK((out.peaks_final && out.t_end < 60));
  }
}
