// Conserved quantities of a run: energy without dissipation, momenta of a free spacecraft, and results that do
// not depend on its position.
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

TEST_CASE("energy before the first latch drifts less than 1e-9 at the defaults") {
  for (const Scene& scene : {oracle::seed_scene(), oracle::two_wing_free_spacecraft()}) {
    const Outcome out = Deployment().run(scene, {}, {});
    REQUIRE(!out.latches.empty());
    CAPTURE(out.energy.drift_before_first_latch, out.energy.initial);
    CHECK(out.energy.drift_before_first_latch < 1e-9 * std::abs(out.energy.initial));
    CHECK(out.energy.drift_before_first_latch > 0); // it is measured
  }
}

TEST_CASE("ten thousand undamped periods drift no more than the tolerance lets them", "[long]") {
  const double omega = std::sqrt(2 / (pi / 2) / panel_inertia), energy = 0.5 * 2 * (pi / 2);
  for (const MethodInfo& method : methods()) {
    const bool slow = method.order > 0 && method.order < 5; // for so tight a tolerance
    const bool long_run = method.name == "auto" || method.name == "dopri5";
    const double periods = slow ? 100 : long_run ? 10'000 : 1000;
    Integration how = within(1e-9, periods * 2 * pi / omega, 1e-2);
    how.method = method.name, how.max_steps = 100'000'000;
    Goal goal = latches_only;
    goal.audit = true;
    const Outcome out = Deployment().run(harmonic_panel(), how, goal);
    CAPTURE(method.name, out.reason, out.work.steps);
    if (method.name == "runge_kutta4" && gave_up(out)) continue;
    REQUIRE(out.status == Status::timed_out);
    // phase and amplitude; the energy is quadratic in the amplitude
    const double off = astray(how, out.work.steps, pi / 2);
    CHECK(std::abs(out.final.angles[0] - pi / 2) < off);
    CHECK(std::abs(out.final.rates[0]) < off);
    CHECK(out.energy.drift_before_first_latch < 2 * energy * off / (pi / 2));
    CHECK(off < 0.1); // the bound means something
  }
}

TEST_CASE("a free spacecraft keeps both momenta to round-off at any tolerance") {
  const Scene scene = oracle::two_wing_free_spacecraft();
  const oracle::DenseWing<long double> wing(scene);
  const auto before = wing.balance(wing.initial_state());
  for (const double rtol : {1e-4, 1e-8}) {
    const Outcome out = run(scene, rtol, 10);
    auto state = wing.initial_state();
    for (int i = 0; i < wing.size(); ++i)
      state.angles[i] = out.final.angles[i], state.rates[i] = out.final.rates[i];
    state.base_position = out.final.base_position.cast<long double>();
    state.base_velocity = out.final.base_velocity.cast<long double>();
    state.base_angle = out.final.base_angle, state.base_rate = out.final.base_rate;
    const auto after = wing.balance(state);
    // relative to the sum of the parts' magnitudes, of which the total is a difference
    const long double size = before.linear_momentum.norm() + std::abs(before.angular_momentum) + 1;
    CHECK(static_cast<double>((after.linear_momentum - before.linear_momentum).norm() / size) <
          1e-12);
    CHECK(static_cast<double>(std::abs(after.angular_momentum - before.angular_momentum) / size) <
          1e-12);
  }
}

TEST_CASE("a tumbling free spacecraft keeps both momenta to round-off with every method") {
  const Scene scene = two_wing_free_spacecraft();
  const DenseWing<long double> wing(scene);
  const WingBalance<long double> before = wing.balance(wing.initial_state());
  const long double size = before.linear_momentum.norm() + std::abs(before.angular_momentum);
  for (const double rtol : {1e-5, 1e-8})
    with_every_method(
        scene, within(rtol, 8, 1e-4), to_the_end, MayGiveUp::fixed_step, [&](const Outcome& out) {
          CHECK(out.latches.size() == 6);
          const WingBalance<long double> after = wing.balance(state_of(out, wing));
          CHECK((after.linear_momentum - before.linear_momentum).norm() < 1e-12L * size);
          CHECK(std::abs(after.angular_momentum - before.angular_momentum) < 1e-12L * size);
        });
}

TEST_CASE("where a free spacecraft is and how fast it flies changes nothing in its wings") {
  Scene scene = oracle::two_wing_free_spacecraft();
  const Outcome here = run(scene, 1e-8, 10);
  for (const auto& [position, velocity] : {std::pair(1e5, 0.0), {7e6, 7500.0}, {1e8, 0.0}}) {
    scene.base.position.x() = position, scene.base.velocity.y() = velocity;
    const Outcome out = run(scene, 1e-8, 10);
    REQUIRE(out.latches.size() == here.latches.size());
    for (std::size_t k = 0; k < here.latches.size(); ++k)
      CHECK(relative(out.latches[k].time, here.latches[k].time) < 1e-7);
    for (std::size_t i = 0; i < here.peak_moment.size(); ++i)
      CHECK(relative(out.peak_moment[i].value, here.peak_moment[i].value) < 1e-6);
  }
}
