// Motors: closed forms, tables of the rate, releases, braking, energy, proofs of the early end, and lanes.
#include "tests/core/deployment/real_runs.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr double I = panel_inertia;

Motor at_rate(double rate, double gain, double limit) {
  return {.rate = rate, .gain = gain, .torque_limit = limit};
}

Motor by_table(std::vector<double> time, std::vector<double> rates, double gain, double limit,
               Interpolation interpolation = Interpolation::linear) {
  Motor motor{.time = time, .rates = rates, .interpolation = interpolation};
  motor.table = std::make_shared<Curve>(time, rates, interpolation);
  motor.gain = gain, motor.torque_limit = limit;
  return motor;
}

/// A panel 1 rad before its latch, at rest, with a motor and nothing else.
Scene driven(const Motor& motor) {
  Scene scene = thrown_panel(0);
  scene.hinges[0].motor = motor;
  return scene;
}

/// I ẍ = c (r − ẋ) from rest, and a constant torque beside the motor: rate and way at t.
struct Spin {
  double rate, way;
};
Spin spun_up(double r, double c, double t) {
  const double fall = -std::expm1(-c * t / I);
  return {r * fall, r * (t - I / c * fall)};
}

/// The same with the limit T < c r.
Spin spun_up_within(double r, double c, double T, double t) {
  const double t_1 = I / T * (r - T / c);
  if (t <= t_1) return {T * t / I, T * t * t / (2 * I)};
  const double s = t - t_1, left = std::exp(-c * s / I);
  return {r - T / c * left, T * t_1 * t_1 / (2 * I) + r * s - T * I / (c * c) * (1 - left)};
}

template <class Motion> Arrival arrival_of(double way, const Motion& motion) {
  const double t = root_between(1e-6, 1e3, [&](double at) { return motion(at).way - way; });
  return {t, motion(t).rate};
}

void check(const Scene& scene, const Arrival& exact, double energy, double tolerance = 1e-9) {
  for (const Scene& way : {scene, other_sense(scene)}) {
    const Outcome out = run_everywhere(way, 1e-11, 60);
    check_arrival(out, exact, tolerance);
    REQUIRE(out.motor_energy.size() == 1);
    CAPTURE(out.motor_energy[0], energy);
    CHECK(relative(out.motor_energy[0], energy) < tolerance);
  }
}

double kinetic(const Arrival& at) { return 0.5 * I * at.rate * at.rate; }

} // namespace

TEST_CASE("every method reads a motor's table at the times of its stages") {
  // I ẍ = c (a t − ẋ) from rest
  constexpr double a = 0.2, c = 3, tau = I / c;
  const Arrival exact = arrival_of(1, [](double t) {
    const double fall = -std::expm1(-t / tau);
    return Spin{a * (t - tau * fall), a * (0.5 * t * t - tau * (t - tau * fall))};
  });
  const Scene scene = driven(by_table({0, 100}, {0, 100 * a}, c, 1e6));
  for (const MethodInfo& method : methods()) {
    if (method.name == "taylor") continue; // no series with a motor
    Integration how = within(1e-10, 60);
    how.method = method.name, how.step = 0.002;
    const bool exact_order = method.name != "rosenbrock_w"; // order 2
    CAPTURE(method.name);
    Goal goal;
    goal.first_latch_only = true;
    check_arrival(Deployment().run(scene, how, goal), exact, exact_order ? 1e-8 : 1e-6);
  }
}

TEST_CASE("an implicit method steps over the time constant of a motor while its command changes") {
  // after a few I/c the rate is a (t − I/c), and the way a t²/2 − a I t/c + a I²/c²
  constexpr double a = 0.2;
  for (const double c : {1e3, 1e5, 1e7})
    for (const char* method : {"seulex", "rosenbrock_w"}) {
      const double tau = I / c, t = tau + std::sqrt(2 / a - tau * tau);
      Integration how = within(1e-6, 60);
      how.method = method;
      Goal goal;
      goal.first_latch_only = true;
      const Outcome out =
          Deployment().run(driven(by_table({0, 100}, {0, 100 * a}, c, 1e9)), how, goal);
      CAPTURE(c, method, out.work.steps);
      check_arrival(out, {t, a * (t - tau)}, 1e-5);
      CHECK(out.work.steps < 150);
    }
}

TEST_CASE("the work of a motor with a stiff gain is right in the long steps of implicit methods") {
  RandomScene options;
  options.bodies = 2, options.reach = 0.5;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene scene = random_scene(seed, options);
    scene.base = {};
    for (Hinge& hinge : scene.hinges) hinge.latch.reset(), hinge.friction = {};
    scene.hinges[0].motor = by_table({0, 2, 4}, {0, 0.3, 0.1}, 1e5, 1e4);
    Integration how = within(1e-10, 4);
    how.method = "dop853";
    const Outcome explicitly = Deployment().run(scene, how, {});
    REQUIRE(explicitly.status != Status::failed);
    const double exact = explicitly.motor_energy.at(0);
    for (const char* method : {"seulex", "rosenbrock_w", "auto"}) {
      how = within(1e-6, 4), how.method = method;
      const Outcome out = Deployment().run(scene, how, {});
      CAPTURE(seed, method, out.work.steps, exact, out.motor_energy[0]);
      CHECK(relative(out.motor_energy[0], exact) < 1e-4);
    }
  }
}

TEST_CASE("a motor spins an inertia up to its rate, and gives it the kinetic energy") {
  for (const double r : {0.05, 0.5, 2.0})
    for (const double c : {0.3, 3.0, 30.0}) {
      const Arrival exact = arrival_of(1, [&](double t) { return spun_up(r, c, t); });
      if (exact.time > 55) continue;
      CAPTURE(r, c);
      check(driven(at_rate(r, c, 1e6)), exact, kinetic(exact));
    }
}

TEST_CASE("within its torque limit a motor accelerates an inertia uniformly, then by its gain") {
  for (const double share : {0.1, 0.5, 0.9})
    for (const double c : {3.0, 30.0}) {
      const double r = 0.4, T = share * c * r;
      const Arrival exact = arrival_of(1, [&](double t) { return spun_up_within(r, c, T, t); });
      CAPTURE(share, c);
      check(driven(at_rate(r, c, T)), exact, kinetic(exact));
    }
}

TEST_CASE("every method meets the closed form of a motor with a limit") {
  const double r = 0.4, c = 6, T = 0.7;
  const Arrival exact = arrival_of(1, [&](double t) { return spun_up_within(r, c, T, t); });
  for (const MethodInfo& method : methods()) {
    CAPTURE(method.name);
    Integration how = within(1e-9, 30);
    how.method = std::string(method.name), how.step = 1e-4;
    const Outcome out = Deployment().run(driven(at_rate(r, c, T)), how, {});
    REQUIRE(out.latches.size() == 1);
    CHECK(relative(out.latches[0].time, exact.time) < 1e-6);
    CHECK(relative(out.latches[0].rates[0], exact.rate) < 1e-6);
    CHECK(relative(out.motor_energy[0], kinetic(exact)) < 1e-5);
  }
}

TEST_CASE("a motor follows a table of its rate from the release of its hinge on") {
  const double c = 5, a = 0.1, ramp = 2, R = a * ramp; // a ramp, then a constant rate
  const auto motion = [&](double t) -> Spin {
    const auto on_ramp = [&](double u) -> Spin {
      const double fall = -std::expm1(-c * u / I), k = I / c;
      return {a * (u - k * fall), a * (u * u / 2 - k * u + k * k * fall)};
    };
    if (t <= ramp) return on_ramp(t);
    const auto [v, x] = on_ramp(ramp);
    const double s = t - ramp, fall = -std::expm1(-c * s / I);
    return {R - (R - v) * (1 - fall), x + R * s - (R - v) * I / c * fall};
  };
  const Arrival exact = arrival_of(1, motion);
  const Motor motor = by_table({0, ramp}, {0, R}, c, 1e6);
  check(driven(motor), exact, kinetic(exact));
  for (const double T0 : {0.3, 4.0}) {
    Scene held = driven(motor);
    held.hinges[0].release = Release{.time = T0};
    check(held, {T0 + exact.time, exact.rate}, kinetic(exact));
  }
  Motor scaled = by_table({0, ramp}, {0, R / 4}, c, 1e6);
  scaled.scale = 4;
  check(driven(scaled), exact, kinetic(exact));
}

TEST_CASE("a spring that a motor governs: the motor takes what the spring gives too much") {
  const double c = 40, r = 0.05, tau = 2;
  Scene scene = driven(at_rate(r, c, 1e6));
  scene.hinges[0].spring.torque_stowed = scene.hinges[0].spring.torque_latched = tau;
  const Arrival exact = arrival_of(1, [&](double t) { return spun_up(r + tau / c, c, t); });
  check(scene, exact, kinetic(exact) - tau * 1);
  // a motor that may not exert enough lets the spring run away
  scene.hinges[0].motor->torque_limit = 0.5;
  const Outcome out = run_everywhere(scene, 1e-11, 60);
  CHECK(out.latches[0].rates[0] > 0.9);
  CHECK(relative(kinetic({0, out.latches[0].rates[0]}), tau + out.motor_energy[0]) < 1e-9);
}

TEST_CASE("a motor with a gain or limit of zero changes no bit") {
  Scene scene = latching_panel();
  const Outcome without = Deployment().run(scene, within(1e-9, 30), {});
  for (const Motor& motor : {at_rate(1, 0, 5), at_rate(1, 5, 0)}) {
    scene.hinges[0].motor = motor;
    const Outcome with = run_everywhere(scene, 1e-9, 30);
    CHECK(with.motor_energy[0] == 0);
    CHECK(relative(with.latches[0].time, without.latches[0].time) < 1e-9);
    CHECK(relative(with.peak_moment[0].value, without.peak_moment[0].value) < 1e-7);
  }
}

TEST_CASE("a run whose motors have constant commands ends early with its peaks") {
  for (const double limit : {0.5, 3.0, 1e6}) {
    Scene scene = latching_panel();
    scene.hinges[0].motor = at_rate(0.3, 4, limit);
    CAPTURE(limit);
    const Outcome early = run_everywhere(scene, 1e-9, 2000);
    CHECK(early.status == Status::deployed);
    CHECK(early.peaks_final);
    CHECK(early.t_end < 60);
    const Outcome late = run_everywhere(scene, 1e-9, 100, true);
    CHECK(early.peak_moment[0].value == late.peak_moment[0].value);
    CHECK(early.peak_force[0].value == late.peak_force[0].value);
    CHECK(early.motor_energy == late.motor_energy);
  }
}

TEST_CASE("the energy of a motor on a hinge without a latch is that up to t_end") {
  Scene scene = latching_panel();
  scene.bodies.push_back({"other_panel", 10, 0.5});
  Hinge other = scene.hinges[0];
  other.name = "other", other.child = 1, other.parent_point = {3, 1};
  other.latch.reset();
  other.spring = {0, 0};
  other.motor = at_rate(0.01, 40, 3);
  other.friction.viscous = 2;
  scene.hinges.push_back(other);
  const Goal latches{.peak_moment = false, .peak_force = false, .audit = false};
  // I ẍ = c (r₀ − ẋ) − b ẋ: ẋ = r (1 − e^(−at)) with r = r₀ c/(c + b) and a = (c + b)/I
  const double t_end = 40, r = 0.01 * 40 / (40 + 2), share = (40 + 2) / I;
  const Outcome out = Deployment().run(scene, within(1e-11, t_end), latches);
  CHECK(out.status == Status::deployed);
  CHECK(out.t_end == t_end);
  const double rate = -r * std::expm1(-share * t_end);
  const double friction = 2 * r * r *
                          (t_end + 2 * std::expm1(-share * t_end) / share -
                           0.5 * std::expm1(-2 * share * t_end) / share);
  CHECK(relative(out.motor_energy[1], 0.5 * I * rate * rate + friction) < 1e-8);
}

TEST_CASE("no run ends before the last knot of its motors' tables") {
  Scene scene = latching_panel();
  scene.hinges[0].motor = by_table({0, 40}, {0.3, -0.3}, 4, 3);
  const Outcome out = run_everywhere(scene, 1e-9, 100);
  CHECK(out.peaks_final);
  CHECK(out.t_end > 40);
  const Outcome late = run_everywhere(scene, 1e-9, 100, true);
  CHECK(out.peak_moment[0].value == late.peak_moment[0].value);
}

TEST_CASE("a stuck hinge is torn loose by a rising command") {
  Scene scene = driven(by_table({0, 10}, {0, 1}, 2, 1e6));
  scene.hinges[0].friction.model = FrictionModel::exact;
  scene.hinges[0].friction.coulomb = 0.5, scene.hinges[0].friction.static_level = 0.6;
  const Outcome out = run_everywhere(scene, 1e-10, 60);
  // c r(t) = 0.6 at t = 3; then I ẍ = c (r − ẋ) − 0.5
  const double c = 2, a = 0.1, k = I / c;
  const auto motion = [&](double t) -> Spin {
    const double u = t - 3, fall = -std::expm1(-c * u / I), b = (0.6 - 0.5) / c;
    return {a * (u - k * fall) + b * fall,
            a * (u * u / 2 - k * u + k * k * fall) + b * (u - k * fall)};
  };
  const double t = root_between(3.01, 10, [&](double at) { return motion(at).way - 1; });
  CHECK(relative(out.latches[0].time, t) < 1e-8);
  CHECK(relative(out.latches[0].rates[0], motion(t).rate) < 1e-8);
}

TEST_CASE("before the latch a motor's peak moment is a closed form: at the start, at its limit, "
          "braking, rising") {
  constexpr double spring = 0.02; // beside the motor, so that its sign counts
  const auto check_peak = [](Scene scene, double t_end, double peak) {
    scene.hinges[0].spring.torque_stowed = scene.hinges[0].spring.torque_latched = spring;
    for (const Scene& way : {scene, other_sense(scene)}) {
      const Outcome out = run_everywhere(way, 1e-11, t_end, true);
      REQUIRE(out.latches.empty());
      REQUIRE(out.peak_moment.size() == 1);
      CHECK(relative(out.peak_moment[0].value, peak) < 1e-9);
    }
  };
  for (const double c : {0.3, 3.0}) {
    CAPTURE(c);
    check_peak(driven(at_rate(0.05, c, 1e6)), 2, spring + c * 0.05);
    check_peak(driven(at_rate(0.05, c, 0.01)), 2, spring + 0.01);
    Scene thrown = thrown_panel(0.2); // faster than the motor, which brakes it
    thrown.hinges[0].motor = at_rate(0.05, c, 1e6);
    check_peak(thrown, 1, c * (0.2 - 0.05) - spring);
    // commanded a t, it lags: I ẍ = f + c (a t − ẋ) has ẍ = a + (f/I − a) exp(−c t/I), which rises
    const double a = 0.05, end = 2;
    check_peak(driven(by_table({0, 10}, {0, 10 * a}, c, 1e6)), end,
               I * (a + (spring / I - a) * std::exp(-c * end / I)));
  }
}
