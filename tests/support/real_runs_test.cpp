// The reference runs with real hinges against closed forms.
#include "tests/support/closed_forms.hpp"
#include "tests/support/real_closed_forms.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

ReferenceOutcome real_extended(const Scene& scene, double t_end) {
  ReferenceOptions options;
  options.t_end = t_end;
  options.rtol = 1e-14, options.atol = 1e-15;
  return high_precision_run<long double>(scene, options);
}

/// A panel with a damper and an initial rate of 1 rad/s, 1 rad before a latch that exerts no moment.
Scene braked(const Damper& damper) {
  Scene scene = free_panel(0, 1);
  scene.hinges[0].damper = damper;
  scene.hinges[0].latch = Latch{};
  return scene;
}

void check(const ReferenceOutcome& out, const Arrival& exact) {
  REQUIRE(out.latches.size() == 1);
  CHECK(out.latches[0].time == Approx(exact.time).epsilon(1e-12));
  CHECK(out.latches[0].rates[0] == Approx(exact.rate).epsilon(1e-12));
}

} // namespace

TEST_CASE("reference runs with dampers give their closed forms") {
  Damper damper;
  damper.coefficient = 2;
  check(real_extended(braked(damper), 2), viscous_arrival(panel_inertia, 2, 1, 1));
  damper.law = DamperLaw::power, damper.coefficient = 1, damper.exponent = 0.45;
  check(real_extended(braked(damper), 3), power_law_arrival(panel_inertia, 1, 0.45, 1, 1));
  damper.law = DamperLaw::eddy_current, damper.peak_torque = 1, damper.peak_rate = 0.4;
  check(real_extended(braked(damper), 3), eddy_current_arrival(panel_inertia, 1, 0.4, 1, 1));
}

TEST_CASE("a reference run through a damper's window takes what it takes, no more") {
  Damper damper;
  damper.coefficient = 2, damper.window = {0.3, 0.6};
  const Arrival inside = viscous_arrival(panel_inertia, 2, 1, 0.3);
  check(real_extended(braked(damper), 3), {0.3 + inside.time + 0.4 / inside.rate, inside.rate});
}

TEST_CASE("a reference run bounces off a stop") {
  Scene scene = free_panel(0.4, -1);
  Hinge& hinge = scene.hinges[0];
  hinge.latch = Latch{};
  hinge.stop = Stop{1e4, 0, 0.05};
  const double w = std::sqrt(1e4 / panel_inertia);
  const ReferenceOutcome out = real_extended(scene, 1.5);
  check(out, {0.1 + pi / w + 1, 1});
  CHECK(out.overtravel[0].value == Approx(0.05 + 1 / w).epsilon(1e-12));
  CHECK(out.peak_moment[0].value == Approx(1e4 / w).epsilon(1e-12));
  hinge.stop->dissipation = 0.5;
  const ReferenceOutcome lossy = real_extended(scene, 3);
  REQUIRE(lossy.latches.size() == 1);
  CHECK(lossy.latches[0].rates[0] == Approx(hunt_crossley_rebound(0.5, 1)).epsilon(1e-12));
  CHECK(lossy.overtravel[0].value ==
        Approx(0.05 + hunt_crossley_depth(panel_inertia, 1e4, 0.5, 1)).epsilon(1e-12));
}

TEST_CASE("a reference run plays in a latch's backlash") {
  Scene scene = free_panel(0, 1);
  scene.hinges[0].latch = Latch{1e3, 0, 0.1};
  const ReferenceOutcome out = real_extended(scene, 3);
  const Played exact = backlash_motion(panel_inertia, 1e3, 0.1, 1, 2);
  CHECK(std::abs(out.final.angles(0) - 1 - exact.angle) < 1e-12);
  CHECK(std::abs(out.final.rates(0) - exact.rate) < 1e-11);
}

TEST_CASE("a reference run swings as a pendulum, and loses to the air what it should") {
  Scene scene = free_panel(-pi / 2 + 1.2);
  Hinge& hinge = scene.hinges[0];
  hinge.latched = -pi / 2, hinge.latch = Latch{};
  scene.environment.gravity = {0, -9.81};
  Arrival exact = pendulum_arrival(panel_inertia, 10 * 9.81 * 0.5, 1.2);
  exact.rate *= -1;
  const ReferenceOutcome out = real_extended(scene, 1);
  check(out, exact);
  CHECK(out.energy_drift < 1e-12);

  scene = free_panel(0, 1);
  scene.hinges[0].latch = Latch{};
  scene.environment.air_density = 1.2;
  scene.bodies[0].plate = Plate{{-0.5, 0}, {1, 0}, 2, 1.5};
  const double B = 1.2 * 1.5 * 2 * std::pow(1.5, 4) / 8;
  check(real_extended(scene, 3), drag_arrival(panel_inertia, B, 1, 1));
}

TEST_CASE("reference runs of equal panels tend to those that a rigid loop keeps in step") {
  const RigidPanels rigid{2, 5.5, 1.1};
  const Arrival limit = rigid.latch();
  CHECK(limit.time == Approx(7.579898).epsilon(1e-7));
  CHECK(limit.rate == Approx(0.6239366).epsilon(1e-7));
  CHECK(RigidPanels{3, 10, 2}.latch().time == Approx(25.783141).epsilon(4e-8));
  CHECK(RigidPanels{3, 10, 2}.latch().rate == Approx(0.2604871).epsilon(4e-7));
  double before = 0;
  for (const double stiffness : {1e3, 4e3}) {
    EqualPanels panels{2, 5.5, 1.1, stiffness, 0.5 * std::sqrt(stiffness)};
    ReferenceOptions options;
    options.t_end = 7.7, options.stiff = true;
    const ReferenceOutcome out = cvode_run(panels.scene(), options);
    REQUIRE(out.latches.size() == 1);
    const double off = out.latches[0].time - limit.time;
    CAPTURE(stiffness, off);
    CHECK(std::abs(off) < 1 / stiffness);
    if (before != 0) CHECK(before / off == Approx(4).epsilon(0.1)); // K⁻¹, and a little K^(−3/2)
    before = off;
  }
}

TEST_CASE("a reference run on a base that a table drives turns a hinge back by its integral") {
  Scene scene = free_panel(0, 0);
  scene.hinges[0].latch = Latch{};
  scene.base.motion = BaseMotion::prescribed;
  const auto drive = [&](BaseTable::Columns columns) {
    scene.base.table = std::make_shared<const BaseTable>(std::move(columns), Interpolation::linear);
  };
  drive({{0, 5}, {}, {0, -15}, {}}); // α = −3 t: φ = t³/2
  check(real_extended(scene, 2), {std::cbrt(2.), 1.5 * std::cbrt(4.)});
  drive({{0, 0.5, 5}, {}, {}, {0, -1, -1}}); // Ω = −2 t, then −1 rad/s
  check(real_extended(scene, 2), {1.25, 1});
  scene.base.table_scale = 2;
  check(real_extended(scene, 2), {0.75, 2});
  ReferenceOptions options;
  options.t_end = 2;
  const ReferenceOutcome by_cvode = cvode_run(scene, options);
  REQUIRE(by_cvode.latches.size() == 1);
  CHECK(by_cvode.latches[0].time == Approx(0.75).epsilon(1e-9));
}
