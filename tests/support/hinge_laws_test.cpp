// The oracle's laws of real hinges against values by hand, and the dense wing with them against its
// own energy.
#include "tests/support/drifted.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

using Shape = Interpolation;

/// d(T + P)/dt, W.
double power(const DenseWing<Quad>& wing, const WingState<Quad>& state) {
  const Quad h = 1e-12;
  const WingResponse<Quad> response = wing.respond(state);
  const WingBalance<Quad> late = wing.balance(drifted(state, response, h));
  const WingBalance<Quad> early = wing.balance(drifted(state, response, -h));
  return static_cast<double>((late.kinetic + late.potential - early.kinetic - early.potential) /
                             (2 * h));
}

} // namespace

TEST_CASE("the oracle's PCHIP has the slopes worked out by hand") {
  // chords 1 and 1/2 over 1 and 2: 9/13 in the middle, 7/6 and 1/6 at the ends
  const Table<double> table({0, 1, 3}, {0, 1, 2}, Shape::monotone, Beyond::constant);
  CHECK(table.slope(1e-300) == Approx(7 / 6.));
  CHECK(table.slope(1) == Approx(9 / 13.));
  CHECK(table.slope(std::nextafter(3, 0)) == Approx(1 / 6.));
  CHECK(table.value(0.5) == Approx(0.5 + (7 / 6. - 9 / 13.) / 8));
  CHECK(table.value(-1) == 0);
  CHECK(table.value(4) == 2);
  CHECK(table.slope(4) == 0);
  // Simpson's rule with the ends' slopes: h (y0 + y1)/2 + h² (m0 − m1)/12
  CHECK(table.integral(0, 1) == Approx(0.5 + (7 / 6. - 9 / 13.) / 12));
  CHECK(table.integral(-1, 5) ==
        Approx(table.integral(0, 1) + 3 + (9 / 13. - 1 / 6.) * 4 / 12 + 4));
  CHECK(table.integral(5, -1) == -table.integral(-1, 5));
}

TEST_CASE("the oracle's PCHIP is level at an extreme of the table and turns descending knots") {
  const Table<double> up({0, 1, 2, 3}, {0, 2, 1, 5}, Shape::monotone, Beyond::straight);
  CHECK(up.slope(1) == 0);
  CHECK(up.slope(2) == 0);
  CHECK(up.slope(0) == 3 * 0.0 + 2 + 1.5); // the parabola's, below 3 · 2
  CHECK(up.value(-2) == Approx(-7));       // straight on
  const Table<double> down({3, 2, 1, 0}, {5, 1, 2, 0}, Shape::monotone, Beyond::straight);
  for (const double x : {-1., 0.3, 1.7, 2.2, 4.}) CHECK(down.value(x) == Approx(up.value(x)));
}

TEST_CASE("the oracle's linear table and its slope") {
  const Table<double> table({0, 1, 3}, {0, 1, 0}, Shape::linear, Beyond::straight);
  CHECK(table.value(0.25) == Approx(0.25));
  CHECK(table.value(2) == Approx(0.5));
  CHECK(table.slope(2) == Approx(-0.5));
  CHECK(table.value(5) == Approx(-1));
  CHECK(table.integral(0, 3) == Approx(1.5));
}

TEST_CASE("the oracle's dampers, stop, latch and loop by hand") {
  Damper damper;
  damper.law = DamperLaw::power, damper.coefficient = 3, damper.exponent = 0.5;
  damper.regularization_rate = 0.01, damper.scale = 2;
  CHECK(damper_moment(damper, 0.0, 4.0) == Approx(-12));
  CHECK(damper_moment(damper, 0.0, -4.0) == Approx(12));
  CHECK(damper_moment(damper, 0.0, 0.001) == Approx(-6 * 10 * 0.001));
  damper.law = DamperLaw::eddy_current, damper.peak_torque = 5, damper.peak_rate = 0.2;
  CHECK(damper_moment(damper, 0.0, 0.2) == Approx(-10)); // the scale is 2
  CHECK(damper_moment(damper, 0.0, 0.4) == Approx(-8));
  damper.law = DamperLaw::viscous, damper.window = {1, -1};
  CHECK(damper_moment(damper, 0.5, 1.0) == Approx(-6));
  CHECK(damper_moment(damper, 1.5, 1.0) == 0);

  const Stop stop{100, 0.5, 0.1};
  CHECK(stop_moment(stop, -0.05, -1.0) == 0);
  CHECK(stop_moment(stop, -0.3, -1.0) == Approx(30)); // 100 · 0.2 · 1.5
  CHECK(stop_moment(stop, -0.3, 1.0) == Approx(10));
  CHECK(stop_moment(stop, -0.3, 3.0) == 0); // it never pulls

  const Latch latch{100, 2, 0.2};
  CHECK(latch_moment(latch, 0.05, 1.0) == 0);
  CHECK(latch_moment(latch, 0.15, 1.0) == Approx(-7));
  CHECK(latch_moment(latch, -0.15, 1.0) == Approx(3));
  CHECK(latch_energy(latch, -0.15) == Approx(0.125));
  const Latch soft{100, 0, 0.2, 3};
  CHECK(latch_moment(soft, 0.05, 1.0) == 0);
  CHECK(latch_moment(soft, 0.15, 1.0) == Approx(-20));
  CHECK(latch_moment(soft, -0.15, 1.0) == Approx(-10)); // ½ k's 5 back, 15 against the rate

  Synchronisation cable;
  cable.ratio = 2, cable.stiffness = 10, cable.damping = 1, cable.preload = 1;
  const Loop<double> loop(cable);
  CHECK(loop.out_of_step(1, 1.5) == Approx(0.5));
  CHECK(loop.pull(0.1, 0.2) == Approx(1.2));
  CHECK(loop.pull(0.5, 0.2) == Approx(2.5 + 1 + 0.1));
  CHECK(loop.pull(-0.5, 0.0) == Approx(-3.5));
  CHECK(loop.energy(0.5) == Approx(0.2 + 0.3 * (2 + 3.5) / 2)); // a triangle and a trapezium
}

TEST_CASE("a torque test both ways: the deploying hinge has the deploying curve") {
  Scene scene = free_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.spring.table = torque_table({0, 0.4, 1}, {2, 1, 0.5}, {2.5, 1.8, 1});
  hinge.friction.regularization_rate = 1e-9;
  const DenseWing<double> wing(scene);
  WingState<double> state = wing.initial_state();
  const Table<double> out({0, 0.4, 1}, {2, 1, 0.5}, Shape::monotone, Beyond::constant);
  const Table<double> back({0, 0.4, 1}, {2.5, 1.8, 1}, Shape::monotone, Beyond::constant);
  for (const double angle : {0.1, 0.5, 0.99}) {
    state.angles(0) = angle, state.rates(0) = 0.5;
    CHECK(wing.moments(state)(0) == Approx(out.value(angle)));
    state.rates(0) = -0.5;
    CHECK(wing.moments(state)(0) == Approx(back.value(angle)));
  }
}

TEST_CASE("the air on a plate that turns about a point inside it: B = ρ C b (L1⁴ + L2⁴)/8") {
  const Plate plate{{-0.5, 0.1}, {1.5, 0.1}, 2, 1.5};
  const double density = 1.2;
  const Load<double> load = air_on_plate<double>(plate, density, 0.7, Vector2<double>::Zero(), 0.8);
  const double B = density * 1.5 * 2 / 8 * (std::pow(0.5, 4) + std::pow(1.5, 4));
  CHECK(load.moment == Approx(-B * 0.64));
  const double F = density * 1.5 * 2 / 6 * (std::pow(1.5, 3) - std::pow(0.5, 3)) * 0.64;
  CHECK(load.force.norm() == Approx(F));
}

TEST_CASE("conservative features keep the energy of the dense wing, and dissipative ones take it") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.motion = seed % 2 ? BaseMotion::free : BaseMotion::fixed;
    options.friction = false;
    RealFeatures features;
    features.measured = features.dampers = features.air = false;
    const Scene taking = with_real_hinges(random_scene(seed, options), seed + 7, features);
    Scene keeping = taking;
    for (Hinge& hinge : keeping.hinges) {
      if (hinge.stop) hinge.stop->dissipation = 0;
      if (hinge.latch) hinge.latch->damping = 0, hinge.latch->dissipation.reset();
    }
    for (Synchronisation& loop : keeping.synchronisations) loop.damping = 0;
    const WingState<Quad> state = random_state(seed, keeping).cast<Quad>();
    const double size = 1 + static_cast<double>(DenseWing<Quad>(keeping).balance(state).kinetic +
                                                DenseWing<Quad>(keeping).balance(state).potential);
    CAPTURE(seed);
    // differences over ±h of a motion with accelerations up to 1e6: (h Ω)² of the energy's rate
    CHECK(std::abs(power(DenseWing<Quad>(keeping), state)) < 1e-8 * std::abs(size));
    for (const double sense : {1., -1.}) { // a stop gives nothing back either way
      WingState<Quad> moving = state;
      moving.rates *= Quad(sense);
      CHECK(power(DenseWing<Quad>(taking), moving) < 1e-8 * std::abs(size));
    }
  }
}

TEST_CASE("with real hinges, double and quadruple precision agree") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 8);
    const Scene scene = with_real_hinges(random_scene(seed, options), seed + 7);
    const WingState<double> state = random_state(seed + 1000, scene);
    const auto coarse = DenseWing<double>(scene).respond(state);
    const auto fine = DenseWing<Quad>(scene).respond(state.cast<Quad>());
    const auto off = [](const auto& a, const auto& b) {
      const auto exact = b.template cast<double>().eval();
      return (a - exact).norm() / (1 + exact.norm());
    };
    CAPTURE(seed);
    CHECK(off(coarse.moments, fine.moments) < 1e-13);
    CHECK(off(coarse.hinge_accelerations, fine.hinge_accelerations) < 1e-9);
    CHECK(off(coarse.forces, fine.forces) < 1e-9);
  }
}
