// Springs and harnesses by tables: whole runs against linear laws and quadratures.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/random_cases.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The torque's own line, over thrice the hinge's way: an accordion's hinges turn beyond its ends.
void tabulate_line(const Hinge& hinge, HingeTorque& torque, int knots, Interpolation how) {
  std::vector<double> angles, values;
  for (int k = 0; k < knots; ++k) {
    const double x = -1 + 3. * k / (knots - 1);
    angles.push_back(hinge.stowed + (hinge.latched - hinge.stowed) * x);
    values.push_back(torque.torque_stowed + (torque.torque_latched - torque.torque_stowed) * x);
  }
  torque.table = torque_table(angles, values, how);
}

Scene tabulated(Scene scene, int knots, Interpolation how) {
  for (Hinge& hinge : scene.hinges) {
    tabulate_line(hinge, hinge.spring, knots, how);
    tabulate_line(hinge, hinge.harness, knots, how);
  }
  return scene;
}

/// The seed wing with harnesses.
Scene wing_with_harness() {
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges)
    hinge.harness.torque_stowed = 0.02, hinge.harness.torque_latched = 0.06;
  return scene;
}

void check_equal(const Outcome& out, const Outcome& exact, double tolerance) {
  REQUIRE(out.latches.size() == exact.latches.size());
  for (std::size_t k = 0; k < exact.latches.size(); ++k) {
    const LatchEvent &a = out.latches[k], &b = exact.latches[k];
    CHECK(a.hinge == b.hinge);
    CHECK(relative(a.time, b.time) < tolerance);
    CHECK(relative(a.rates[a.hinge], b.rates[b.hinge]) < 10 * tolerance);
  }
  for (std::size_t i = 0; i < exact.peak_moment.size(); ++i)
    CHECK(relative(out.peak_moment[i].value, exact.peak_moment[i].value) < 10 * tolerance);
}

const std::vector<double> curve_angles{0, 0.15, 0.4, 0.5, 0.8, 1};
const std::vector<double> curve_torques{2, 1.9, 1.1, 1.05, 0.6, 0.2};
const std::vector<double> stowing_torques{2.6, 2.3, 1.8, 1.6, 1.3, 1};

/// From rest under a torque: I ω²/2 = W(φ), t = ∫ dφ/ω with φ = u².
Arrival driven(const Table<double>& torque, double inertia) {
  const auto slowness = [&](double u) {
    return u == 0 ? std::sqrt(2 * inertia / torque.value(0))
                  : 2 * u * std::sqrt(inertia / (2 * torque.integral(0, u * u)));
  };
  double time = 0, from = 0; // smooth from knot to knot
  for (const double knot : torque.knots()) {
    if (knot <= 0) continue;
    using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
    time += Rule::integrate(slowness, from, std::sqrt(knot), 5, 1e-13);
    from = std::sqrt(knot);
  }
  return {time, std::sqrt(2 * torque.integral(0, 1) / inertia)};
}

Scene driven_panel() {
  Scene scene = free_panel();
  scene.hinges[0].latch = Latch{};
  return scene;
}

} // namespace

TEST_CASE("a linear law entered as a table gives the linear law's result") {
  const Scene scene = wing_with_harness();
  const Outcome exact = run(scene, 1e-11, 12, false);
  REQUIRE(exact.latches.size() == 3);
  for (const Interpolation how : {Interpolation::linear, Interpolation::monotone})
    for (const int knots : {2, 3, 8}) {
      CAPTURE(static_cast<int>(how), knots);
      check_equal(run_everywhere(tabulated(scene, knots, how), 1e-11, 12), exact, 1e-9);
    }
}

TEST_CASE("a spring's table drives as its integral says") {
  for (const Interpolation how : {Interpolation::monotone, Interpolation::linear}) {
    Scene scene = driven_panel();
    scene.hinges[0].spring.table = torque_table(curve_angles, curve_torques, how);
    const Table<double> torque(curve_angles, curve_torques, how, Beyond::constant);
    CAPTURE(static_cast<int>(how));
    check_arrival(run_everywhere(scene, 1e-11, 5), driven(torque, panel_inertia), 1e-8);
    // against the hinge's other sense the table's angles descend
    std::vector<double> angles = curve_angles;
    for (double& angle : angles) angle *= -1;
    Scene other = other_sense(scene);
    other.hinges[0].spring.table = torque_table(angles, curve_torques, how);
    check_arrival(run_everywhere(other, 1e-11, 5), driven(torque, panel_inertia), 1e-8);
  }
}

TEST_CASE("no step leaps over a detent in a table, however narrow") {
  Draws draws(17);
  for (int k = 0; k < random_cases(200, 12); ++k) {
    const double half_width = draws.log_uniform(1e-5, 1e-2), at = draws.uniform(0.05, 0.9);
    const double depth = draws.chance(0.5) ? draws.uniform(-0.5, 0)
                                           : draws.uniform(0, std::min(100.0, 0.05 / half_width));
    const std::vector<double> angles{0, at - half_width, at, at + half_width, 1};
    const std::vector<double> torques{1, 1, 1 + depth, 1, 1};
    for (const Interpolation how : {Interpolation::monotone, Interpolation::linear}) {
      Scene scene = driven_panel();
      scene.hinges[0].spring.table = torque_table(angles, torques, how);
      const Table<double> torque(angles, torques, how, Beyond::constant);
      const Arrival exact = driven(torque, panel_inertia);
      CAPTURE(k, half_width, at, depth, static_cast<int>(how));
      check_arrival(run_everywhere(scene, 1e-9, 5), exact, 1e-7);
      for (const std::string method : {"dop853", "dopri5", "cash_karp54", "seulex"}) {
        Integration within_limits = within(1e-6, 5);
        within_limits.method = method;
        CAPTURE(method);
        check_arrival(Deployment().run(scene, within_limits, latches_only), exact, 2e-6);
      }
    }
  }
}

TEST_CASE("beyond its ends a table is constant") {
  Scene scene = driven_panel();
  scene.hinges[0].spring.table = torque_table({0.3, 0.6}, {2, 1}, Interpolation::linear);
  const Table<double> torque({0, 0.3, 0.6, 1}, {2, 2, 1, 1}, Interpolation::linear,
                             Beyond::constant);
  check_arrival(run_everywhere(scene, 1e-11, 5), driven(torque, panel_inertia), 1e-8);
}

TEST_CASE("scale and offset disperse a whole curve, of linear laws and of tables") {
  const double scale = 1.3, offset = 0.25;
  Scene scene = wing_with_harness(), exact = scene;
  for (Hinge& hinge : scene.hinges) {
    hinge.spring.scale = scale, hinge.spring.offset = offset;
    hinge.harness.scale = 0.5, hinge.harness.offset = 0.01;
  }
  for (Hinge& hinge : exact.hinges)
    for (auto* torque : {&hinge.spring.torque_stowed, &hinge.spring.torque_latched})
      *torque = scale * *torque + offset;
  for (Hinge& hinge : exact.hinges)
    for (auto* torque : {&hinge.harness.torque_stowed, &hinge.harness.torque_latched})
      *torque = 0.5 * *torque + 0.01;
  check_equal(run_everywhere(scene, 1e-11, 12), run(exact, 1e-11, 12, false), 1e-9);

  Scene table = driven_panel();
  table.hinges[0].spring.table = torque_table(curve_angles, curve_torques);
  table.hinges[0].spring.scale = scale, table.hinges[0].spring.offset = offset;
  std::vector<double> torques = curve_torques;
  for (double& torque : torques) torque = scale * torque + offset;
  const Table<double> whole(curve_angles, torques, Interpolation::monotone, Beyond::constant);
  check_arrival(run_everywhere(table, 1e-11, 5), driven(whole, panel_inertia), 1e-8);
}

TEST_CASE("friction's scale is of all that friction does") {
  Scene scene = seed_scene(), exact = scene;
  for (Hinge& hinge : scene.hinges) {
    hinge.friction.coulomb = 0.05, hinge.friction.viscous = 0.2, hinge.friction.scale = 0.5;
    hinge.friction.regularization_rate = 1e-2;
  }
  for (Hinge& hinge : exact.hinges) {
    hinge.friction.coulomb = 0.025, hinge.friction.viscous = 0.1;
    hinge.friction.regularization_rate = 1e-2;
  }
  check_equal(run_everywhere(scene, 1e-11, 20), run(exact, 1e-11, 20, false), 1e-9);
  for (Scene* each : {&scene, &exact})
    for (Hinge& hinge : each->hinges) hinge.friction.model = FrictionModel::exact;
  check_equal(run_everywhere(scene, 1e-11, 20), run(exact, 1e-11, 20, false), 1e-9);
}

TEST_CASE("a torque test both ways: a hinge that deploys has the deploying curve") {
  Scene scene = driven_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.spring.table = torque_table(curve_angles, curve_torques, stowing_torques);
  hinge.friction.model = FrictionModel::exact;
  const Table<double> out(curve_angles, curve_torques, Interpolation::monotone, Beyond::constant);
  check_arrival(run_everywhere(scene, 1e-11, 5), driven(out, panel_inertia), 1e-8);
  // friction's own level adds to it
  hinge.friction.coulomb = 0.1;
  std::vector<double> less = curve_torques;
  for (double& torque : less) torque -= 0.1;
  const Table<double> net(curve_angles, less, Interpolation::monotone, Beyond::constant);
  check_arrival(run_everywhere(scene, 1e-11, 5), driven(net, panel_inertia), 1e-8);
}

TEST_CASE("a hinge thrown back against its measured spring has the stowing curve, and sticks") {
  Scene scene = free_panel(0.5, -0.3);
  Hinge& hinge = scene.hinges[0];
  // level: drive 0.2, friction 1: it stops where 0.3² I/2 = ∫ of the torque against stowing, and stays
  hinge.spring.table = torque_table({0, 1}, {-0.8, -0.8}, {1.2, 1.2}, Interpolation::linear);
  hinge.friction.model = FrictionModel::exact;
  const Outcome out = run_everywhere(scene, 1e-11, 3, true);
  const double way = 0.3 * 0.3 * panel_inertia / 2 / 1.2;
  CHECK(relative(0.5 - out.final.angles[0], way) < 1e-8);
  CHECK(out.final.rates[0] == 0);
  CHECK(relative(out.overtravel[0], way) < 1e-8);
}

TEST_CASE("a table costs as much as a linear law, and a little more at its knots") {
  const Scene linear = wing_with_harness();
  const auto cost = [](const Scene& scene) {
    Integration how = within(1e-8, 12);
    how.method = "dop853"; // tables have no series
    return Deployment().run(scene, how, {}).work.rhs_evaluations;
  };
  const long usual = cost(linear);
  const long smooth = cost(tabulated(linear, 10, Interpolation::monotone));
  CAPTURE(usual, smooth);
  CHECK(smooth < 2 * usual);
  Scene curved = linear;
  for (Hinge& hinge : curved.hinges) {
    std::vector<double> angles;
    for (const double x : curve_angles)
      angles.push_back(hinge.stowed + (hinge.latched - hinge.stowed) * x);
    hinge.spring.table = torque_table(angles, curve_torques);
  }
  const long bent = cost(curved);
  CAPTURE(bent);
  CHECK(bent < 3 * usual);
}
