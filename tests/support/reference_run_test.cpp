#include "tests/support/random_scenes.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

ReferenceOptions tight(double tolerance, double t_end) {
  ReferenceOptions options;
  options.rtol = options.atol = tolerance;
  options.t_end = t_end;
  return options;
}

ReferenceOutcome adams(const Scene& scene, double t_end) {
  return cvode_run(scene, tight(1e-12, t_end));
}

ReferenceOutcome bdf(const Scene& scene, double t_end) {
  ReferenceOptions options = tight(1e-12, t_end);
  options.stiff = true;
  return cvode_run(scene, options);
}

ReferenceOutcome extended(const Scene& scene, double t_end) {
  return high_precision_run<long double>(scene, tight(1e-16, t_end));
}

using Run = ReferenceOutcome (*)(const Scene&, double);

/// A CVODE run in double at 1e-12 is good to about 1e-8; the long double one to far less.
struct Reference {
  const char* name;
  Run run;
  double tolerance;
};
constexpr Reference references[] = {
    {"adams", adams, 1e-8}, {"bdf", bdf, 3e-8}, {"extended", extended, 1e-13}};

/// The latching panel's moment a time t after the latch, at φ = 0 with the rate `rate`:
/// I φ̈ = M = T − k φ − d φ̇ in the deploying sense (underdamped).
double ringing_moment(double t, double rate) {
  const double inertia = 3, stiffness = 1e4, damping = 100, torque = 2;
  const double decay = damping / (2 * inertia);
  const double omega = std::sqrt(stiffness / inertia - decay * decay);
  const double rest = torque / stiffness;
  // φ − rest = e^(−δt) (A cos ωt + B sin ωt), A = −rest, B = (rate − δ rest)/ω
  const double a = -rest, b = (rate - decay * rest) / omega;
  const double c = std::cos(omega * t), s = std::sin(omega * t), e = std::exp(-decay * t);
  const double angle = rest + e * (a * c + b * s);
  const double speed = e * ((b * omega - decay * a) * c - (a * omega + decay * b) * s);
  return torque - stiffness * angle - damping * speed;
}

} // namespace

TEST_CASE("a panel on a linear spring swings as a cosine") {
  const double omega = std::sqrt(2 / (pi / 2) / 3);
  for (const Reference& reference : references) {
    INFO(reference.name);
    const ReferenceOutcome outcome = reference.run(harmonic_panel(), 10);
    CHECK(outcome.latches.empty());
    CHECK(std::abs(outcome.final.angles(0) - pi / 2 * std::cos(10 * omega)) < reference.tolerance);
    CHECK(std::abs(outcome.final.rates(0) + pi / 2 * omega * std::sin(10 * omega)) <
          reference.tolerance);
    CHECK(outcome.peak_moment[0].value == Approx(2).epsilon(1e-12));
    // centripetal at the middle: m c φ̇²
    const double fastest = pi / 2 * omega;
    CHECK(outcome.peak_force[0].value == Approx(10 * 0.5 * fastest * fastest).epsilon(1e-8));
    CHECK(outcome.energy_drift < reference.tolerance);
  }
}

TEST_CASE("a panel under a constant moment latches when it should, and rings as it should") {
  const double time = std::sqrt(2 * 3 * (pi / 2) / 2);
  const double rate = std::sqrt(2 * 2 * (pi / 2) / 3);
  double peak = 0;
  for (double t = 0; t < 0.2; t += 1e-6) peak = std::max(peak, std::abs(ringing_moment(t, rate)));
  for (const Reference& reference : references) {
    INFO(reference.name);
    const ReferenceOutcome outcome = reference.run(latching_panel(), 3);
    REQUIRE(outcome.latches.size() == 1);
    CHECK(std::abs(outcome.latches[0].time - time) < reference.tolerance);
    CHECK(std::abs(outcome.latches[0].rates[0] + rate) < reference.tolerance);
    CHECK(outcome.peak_moment[0].value == Approx(peak).epsilon(1e-8)); // a 1 µs grid's
  }
}

TEST_CASE("the seed scene gives the figures") {
  // produced there by DOP853 at rtol 1e-11 with a dense mass matrix; half a unit of the last digit
  for (const Reference& reference : references) {
    INFO(reference.name);
    const ReferenceOutcome outcome = reference.run(seed_scene(), 12);
    REQUIRE(outcome.latches.size() == 3);
    const double times[] = {4.819271, 6.047369, 6.794189};
    const double rates[] = {-1.267827, 0.732120, -1.160431};
    const double peaks[] = {250.4651, 84.6102, 115.9431};
    for (int i = 0; i < 3; ++i) {
      CHECK(outcome.latches[i].hinge == i);
      CHECK(std::abs(outcome.latches[i].time - times[i]) < 0.6e-6);
      CHECK(std::abs(outcome.latches[i].rates[i] - rates[i]) < 0.6e-6);
      CHECK(std::abs(outcome.peak_moment[i].value - peaks[i]) < 0.6e-4);
    }
    CHECK(outcome.peak_moment[2].time == outcome.latches[2].time); // d·|φ̇| at t⁺
    CHECK(outcome.energy_drift < reference.tolerance);
    CHECK(outcome.final_balance.kinetic + outcome.final_balance.potential <
          outcome.initial_balance.kinetic + outcome.initial_balance.potential);
  }
}

TEST_CASE("the reference integrators agree on the seed scene") {
  const ReferenceOutcome fine = extended(seed_scene(), 12);
  for (const Reference& reference : {references[0], references[1]}) {
    INFO(reference.name);
    const double relative = 2 * reference.tolerance;
    const ReferenceOutcome outcome = reference.run(seed_scene(), 12);
    for (int i = 0; i < 3; ++i) {
      CHECK(std::abs(outcome.latches[i].time - fine.latches[i].time) < reference.tolerance);
      CHECK(outcome.peak_moment[i].value == Approx(fine.peak_moment[i].value).epsilon(relative));
      CHECK(outcome.peak_force[i].value == Approx(fine.peak_force[i].value).epsilon(relative));
    }
    CHECK((outcome.final.angles - fine.final.angles).norm() < reference.tolerance);
    CHECK((outcome.final.rates - fine.final.rates).norm() < reference.tolerance);
  }
  // quadruple precision at 1e-20 (numbers to 16 digits, 27 s)
  CHECK(std::abs(fine.latches[0].time - 4.819270880750506) < 1e-14);
  CHECK(std::abs(fine.latches[2].time - 6.79418932636815) < 1e-14);
  CHECK(fine.peak_moment[0].value == Approx(250.465119691995).epsilon(1e-14));
  CHECK(fine.peak_force[0].value == Approx(337.0287544117168).epsilon(1e-14));
}

TEST_CASE("quadruple precision keeps the energy to what it is asked") {
  ReferenceOptions options = tight(1e-22, 0.5);
  const ReferenceOutcome outcome = high_precision_run<Quad>(seed_scene(), options);
  CHECK(outcome.energy_drift < 1e-20);
}

TEST_CASE("a free tumbling spacecraft keeps both momenta through its latches") {
  for (const Reference& reference : references) {
    INFO(reference.name);
    const ReferenceOutcome outcome = reference.run(two_wing_free_spacecraft(), 12);
    CHECK(outcome.latches.size() == 6);
    CHECK(outcome.momentum_drift < 10 * reference.tolerance); // kg·m/s: masses of 10 and 200 kg
    CHECK(outcome.spin_drift < 10 * reference.tolerance);
    CHECK(outcome.energy_drift < reference.tolerance);
  }
}

TEST_CASE("a symmetric spacecraft latches in pairs, at one instant, and does not turn") {
  for (const Reference& reference : references) {
    INFO(reference.name);
    const ReferenceOutcome outcome = reference.run(symmetric_tree(), 6);
    REQUIRE(outcome.latches.size() == 4);
    for (int pair : {0, 2}) {
      CHECK(outcome.latches[pair].time == outcome.latches[pair + 1].time);
      CHECK(outcome.latches[pair].hinge + 2 == outcome.latches[pair + 1].hinge);
    }
    CHECK(std::abs(outcome.final.base_angle) < reference.tolerance);
    CHECK(std::abs(outcome.spin_drift) < reference.tolerance);
  }
}

TEST_CASE("random deployments agree between the multistep and the one-step reference") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed) % 3;
    options.mass_lower = 2;
    options.mass_upper = 20;
    const Scene scene = random_scene(seed, options);
    const ReferenceOutcome coarse = adams(scene, 2);
    const ReferenceOutcome fine = extended(scene, 2);
    INFO("seed " << seed);
    REQUIRE(coarse.latches.size() == fine.latches.size());
    for (std::size_t i = 0; i < fine.latches.size(); ++i) {
      CHECK(coarse.latches[i].hinge == fine.latches[i].hinge);
      CHECK(std::abs(coarse.latches[i].time - fine.latches[i].time) < 1e-8);
    }
    CHECK((coarse.final.angles - fine.final.angles).norm() < 1e-7);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
      CHECK(coarse.peak_moment[i].value == Approx(fine.peak_moment[i].value).epsilon(1e-6));
      CHECK(coarse.peak_force[i].value == Approx(fine.peak_force[i].value).epsilon(1e-6));
    }
  }
}

TEST_CASE("a hinge that passes its latch and comes back within one step is caught") {
  // The harmonic panel turns back at −π/2. A latch 1e-6 before this angle is passed only for 2√(2·1e-6/0.667) s, within
  // one step. A latch just beyond it is never reached.
  Scene scene = harmonic_panel();
  const double omega = std::sqrt(2 / (pi / 2) / 3);
  scene.hinges[0].latch = Latch{10, 1};
  for (const double short_of : {1e-6, -1e-6}) {
    const double travel = pi - short_of; // of the new latched angle; the spring keeps its line
    scene.hinges[0].latched = pi / 2 - travel;
    scene.hinges[0].spring = {2, 2 - travel * 2 / (pi / 2)};
    for (const Reference& reference : references) {
      INFO(reference.name << ", " << short_of);
      const ReferenceOutcome outcome = reference.run(scene, 6);
      REQUIRE(outcome.latches.size() == (short_of > 0 ? 1u : 0u));
      if (short_of < 0) continue;
      const double time = std::acos(1 - travel / (pi / 2)) / omega;
      CHECK(std::abs(outcome.latches[0].time - time) < 1e-4); // ill-conditioned: √ of the error
    }
  }
}

TEST_CASE("the smoothed latch tends to the event latch, linearly") {
  const ReferenceOutcome event = adams(seed_scene(), 8);
  double last = 0;
  for (const double smoothing : {1e-4, 1e-3}) {
    ReferenceOptions options = tight(1e-12, 8);
    options.smoothing = smoothing;
    const ReferenceOutcome outcome = cvode_run(seed_scene(), options);
    REQUIRE(outcome.latches.size() == 3);
    const double change = outcome.peak_moment[0].value / event.peak_moment[0].value - 1;
    CHECK(std::abs(change) < 20 * smoothing);
    if (last != 0) CHECK(change / last == Approx(10).epsilon(0.1));
    last = change;
  }
}

TEST_CASE("both references resolve a smoothed latch") {
  ReferenceOptions options = tight(1e-12, 8);
  options.smoothing = 1e-3;
  const ReferenceOutcome coarse = cvode_run(seed_scene(), options);
  options.rtol = options.atol = 1e-13;
  const ReferenceOutcome fine = high_precision_run<long double>(seed_scene(), options);
  for (int i = 0; i < 3; ++i)
    CHECK(coarse.peak_moment[i].value == Approx(fine.peak_moment[i].value).epsilon(1e-6));
}
