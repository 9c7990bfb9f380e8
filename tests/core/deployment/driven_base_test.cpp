// Bases driven by a table of time: whole runs against closed forms and the dense formulation.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/random_cases.hpp"

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

void drive(Scene& scene, BaseTable::Columns columns, Interpolation how = Interpolation::linear) {
  scene.base.motion = BaseMotion::prescribed;
  scene.base.table = std::make_shared<const BaseTable>(std::move(columns), how);
}

/// A panel whose hinge lies in the base's origin: when the base turns, the hinge turns back by the same angle.
/// Its latch is 1 rad off.
Scene left_behind(BaseTable::Columns columns, Interpolation how = Interpolation::linear) {
  Scene scene = free_panel();
  scene.hinges[0].latch = Latch{};
  drive(scene, std::move(columns), how);
  return scene;
}

/// Random wings with real hinges on driven bases, which have all that a base can do to them.
Scene random_driven(std::uint64_t seed, double t_end) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 4);
  options.mass_lower = 1, options.mass_upper = 20;
  options.motion = BaseMotion::fixed;
  Scene scene = random_scene(seed, options);
  if (seed % 2) scene = with_real_hinges(scene, seed);
  return driven_by_table(scene, seed, t_end);
}

/// 25 knots that follow a sine.
BaseTable::Columns wave(bool rates) {
  BaseTable::Columns columns;
  for (int k = 0; k <= 24; ++k) {
    columns.time.push_back(0.25 * k);
    const double value = 0.2 * std::sin(2 * columns.time.back());
    columns.acceleration.emplace_back(value, -0.3 * value);
    (rates ? columns.rate : columns.angular_acceleration).push_back(value);
  }
  return columns;
}

} // namespace

TEST_CASE("a ramp of angular acceleration turns a hinge back by its cube") {
  // φ = k t³/6 on a base with α = −k t, up to 1 rad; φ̇ = k t²/2
  for (const double k : {0.5, 3.}) {
    const double time = std::cbrt(6 / k);
    const Arrival exact{time, k * time * time / 2};
    check_arrival(run_everywhere(left_behind({{0, 5}, {}, {0, -5 * k}, {}}), 1e-11, 5), exact,
                  1e-8);
    // the same on ten knots, one of which is the instant itself
    std::vector<double> times, values;
    for (int j = 0; j < 10; ++j) times.push_back(time * j / 5), values.push_back(-k * times.back());
    check_arrival(run_everywhere(left_behind({times, {}, values, {}}), 1e-11, 5), exact, 1e-8);
    const Interpolation cubic = Interpolation::monotone; // through a line: that line
    check_arrival(run_everywhere(left_behind({times, {}, values, {}}, cubic), 1e-11, 5), exact,
                  1e-8);
  }
}

TEST_CASE(
    "a hinge that is carried back from rest, and turns in its first step, tells how far it went") {
  // φ = k t³/6 − a t²/2 on a base with α = a − k t: furthest back at t = 2a/k, after 10 ms
  const double a = 0.3, k = 60;
  Scene scene = left_behind({{0, 5}, {}, {a, a - 5 * k}, {}});
  for (const double rtol : {1e-5, 1e-6, 1e-8, 1e-10, 1e-12}) {
    CAPTURE(rtol);
    CHECK(relative(run_everywhere(scene, rtol, 5).overtravel[0], 2 * a * a * a / (3 * k * k)) <
          1e-5);
  }
}

TEST_CASE("a rate that steps up and down turns a hinge back by its integral") {
  // trapezia: Ω = −2 t to −1 rad/s, held to 1.2 s, and down to 0 at 1.4 s: 1.05 rad at most
  const Scene scene = left_behind({{0, 0.5, 1.2, 1.4}, {}, {}, {0, -1, -1, 0}});
  const Outcome out = run_everywhere(scene, 1e-11, 3);
  const double left = 1 - 0.25 - 0.7; // rad after 1.2 s; then φ = v − 5/2 v², φ̇ = 1 − 5 v
  const double v = (1 - std::sqrt(1 - 10 * left)) / 5;
  check_arrival(out, {1.2 + v, 1 - 5 * v}, 1e-8);
  CHECK(std::abs(out.final.base_rate) < 1e-14);
  Scene scaled = scene; // half as far: the panel keeps the rate 0 that it had
  scaled.base.table_scale = 0.5;
  const Outcome half = run_everywhere(scaled, 1e-11, 3, true);
  CHECK(half.latches.empty());
  CHECK(std::abs(half.final.angles[0] - 0.525) < 1e-9);
  CHECK(std::abs(half.final.base_angle + 0.525) < 1e-14);
}

TEST_CASE("a table of constants moves the base as the constants do") {
  Scene scene = seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.acceleration = {0.2, -0.1}, scene.base.angular_acceleration = 0.05;
  scene.base.angle = 0.4, scene.base.rate = -0.1;
  const Outcome constant = run(scene, 1e-10, 8);
  for (const Interpolation how : {Interpolation::linear, Interpolation::monotone})
    for (const double begin : {-1., 0., 2.}) {
      Scene other = scene;
      drive(other,
            {{begin, begin + 2, begin + 3},
             {{0.2, -0.1}, {0.2, -0.1}, {0.2, -0.1}},
             {0.05, 0.05, 0.05},
             {}},
            how);
      other.base.acceleration = {7, 7}, other.base.angular_acceleration = 7; // which it replaces
      const Outcome out = run_everywhere(other, 1e-10, 8, true);
      REQUIRE(out.latches.size() == constant.latches.size());
      for (std::size_t k = 0; k < out.latches.size(); ++k) {
        CHECK(relative(out.latches[k].time, constant.latches[k].time) < 1e-9);
        CHECK(std::abs(out.latches[k].rates[0] - constant.latches[k].rates[0]) < 1e-9);
      }
      for (int i = 0; i < 3; ++i) {
        CHECK(relative(out.peak_moment[i].value, constant.peak_moment[i].value) < 1e-8);
        CHECK(relative(out.peak_force[i].value, constant.peak_force[i].value) < 1e-8);
      }
      CHECK(std::abs(out.final.base_angle - constant.final.base_angle) < 1e-13);
    }
}

TEST_CASE("motions that a base's table leaves out stay constant") {
  Scene scene = seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.acceleration = {0.2, -0.1}, scene.base.angular_acceleration = 0.05,
  scene.base.rate = 0.1;
  const Outcome constant = run(scene, 1e-10, 7);
  Scene pushed = scene, turned = scene;
  drive(pushed, {{1, 2}, {{0.2, -0.1}, {0.2, -0.1}}, {}, {}});
  drive(turned, {{1, 2}, {}, {0.05, 0.05}, {}});
  for (const Scene& each : {pushed, turned}) {
    const Outcome out = run_everywhere(each, 1e-10, 7, true);
    REQUIRE(out.latches.size() == constant.latches.size());
    for (std::size_t k = 0; k < out.latches.size(); ++k)
      CHECK(relative(out.latches[k].time, constant.latches[k].time) < 1e-9);
    CHECK(std::abs(out.final.base_rate - constant.final.base_rate) < 1e-13);
  }
}

TEST_CASE("random wings on driven bases agree with the reference", "[long]") {
  const auto cases = static_cast<std::uint64_t>(random_cases(24, 6));
  std::size_t latches = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    const Scene scene = random_driven(seed, 2);
    CAPTURE(seed, scene.hinges.size());
    const Outcome out = run_everywhere(scene, 1e-11, 2, true);
    const ReferenceOutcome exact = real_reference(scene, 2);
    compare(out, exact, 1e-8, 1e-6);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i)
      CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-7);
    CHECK(std::abs(out.final.base_angle - exact.final.base_angle) < 1e-10);
    latches += out.latches.size();
  }
  CHECK(latches >= (cases == 24 ? 10 : 1));
}

TEST_CASE("every method ends its steps at the knots of a base's table") {
  Scene scene = seed_scene();
  drive(scene, wave(true)); // its angular acceleration jumps at each
  const ReferenceOutcome exact = real_reference(scene, 4);
  with_every_method(scene, within(1e-8, 4, 1e-3), to_the_end, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      for (int i = 0; i < 3; ++i)
                        CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-5);
                    });
}

TEST_CASE("the knots of a base's table cost a step each, and no more") {
  Scene scene = seed_scene();
  const long without = run(scene, 1e-8, 6).work.rhs_evaluations;
  for (const bool rates : {false, true})
    for (const Interpolation how : {Interpolation::linear, Interpolation::monotone}) {
      drive(scene, wave(rates), how);
      const Outcome out = run(scene, 1e-8, 6);
      CAPTURE(rates, without, out.work.rhs_evaluations, out.work.rejected);
      CHECK(out.work.rhs_evaluations < without + 25 * 2 * 13); // two steps of dop853
    }
}

TEST_CASE("an early end waits for the last knot of a base's table, and loses nothing") {
  Scene scene = seed_scene();
  BaseTable::Columns kick{{0, 9, 9.5, 10}, {}, {}, {0, 0, 2, 0}}; // after the last latch
  drive(scene, kick);
  const Outcome early = run(scene, 1e-8, 200, false), late = run(scene, 1e-8, 200);
  REQUIRE(early.status == Status::deployed);
  CHECK(early.peaks_final);
  CHECK(early.t_end >= 10);
  CHECK(early.t_end < 100);
  for (int i = 0; i < 3; ++i) {
    CHECK(early.peak_moment[i].value == late.peak_moment[i].value);
    CHECK(early.peak_force[i].value == late.peak_force[i].value);
  }
  Scene still = seed_scene();
  CHECK(late.peak_moment[0].value > 1.5 * run(still, 1e-8, 200).peak_moment[0].value);
}

TEST_CASE("a stuck hinge is released when a ramp of its base reaches its friction") {
  // J α = τ at t = τ/(J k); from there φ = k (t − that)³/6
  const double tau = 2, k = 1.5, loose = tau / (panel_inertia * k);
  Scene scene = left_behind({{0, 10}, {}, {0, -10 * k}, {}});
  rub(scene.hinges[0], tau, tau);
  const double time = std::cbrt(6 / k);
  const Outcome out = run_everywhere(scene, 1e-11, 5);
  check_arrival(out, {loose + time, k * time * time / 2}, 1e-7);
  // a brief pulse of 1.2 times the limit, between two knots of which no step would end inside
  Scene pulse =
      left_behind({{0, 1, 1.01, 1.02, 3}, {}, {0, 0, -1.2 * tau / panel_inertia, 0, 0}, {}});
  rub(pulse.hinges[0], tau, tau);
  CHECK(run(pulse, 1e-11, 3).final.angles[0] > 0);
  pulse.base.table_scale = 0.8;
  CHECK(run(pulse, 1e-11, 3).final.angles[0] == 0);
}

TEST_CASE("a wing that rests on its stops rises from them when its base sets out") {
  Scene scene = left_behind({{0, 1, 6}, {}, {0, 0, -5}, {}});
  scene.hinges[0].stop = Stop{500, 0.2, 0};
  const double time = std::cbrt(6.);
  check_arrival(run_everywhere(scene, 1e-11, 5), {1 + time, time * time / 2}, 1e-7);
  scene.base.table_scale = 0;
  CHECK(run(scene, 1e-11, 5).final.angles[0] == 0);
  scene.base.table_scale = -1; // into the stop, and nowhere else
  const Outcome pressed = run_everywhere(scene, 1e-9, 3, true);
  compare(pressed, real_reference(scene, 3), 1e-7, 1e-6);
  CHECK(pressed.overtravel[0] > 1e-3);
}

TEST_CASE("a run in a lane has the bits of the run alone: bases driven by tables") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::vector<Scene> units;
    const Scene drawing = random_driven(seed, 2);
    for (int k = 0; k < 10; ++k) {
      Draws draws(seed * 100 + k);
      Scene unit = drawing;
      unit.base.table_scale *= draws.uniform(0.5, 1.5);
      unit.base.angle += draws.uniform(-0.1, 0.1);
      for (Hinge& hinge : unit.hinges) {
        hinge.spring.scale *= draws.uniform(0.9, 1.1);
        if (seed % 3 == 0) hinge.friction.model = FrictionModel::exact;
      }
      units.push_back(unit);
    }
    CAPTURE(seed);
    Integration how;
    how.rtol = 1e-6, how.atol = 1e-8, how.t_end = 3, how.max_steps = 3000;
    require_equal_bits(units, how, seed % 2 ? Goal{.audit = false} : latches_only);
  }
}
