// A hinge that sticks against a loop, and is let go between the ends of steps.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/core/events/regularized_limit.hpp"
#include "tests/core/events/rubbed_wings.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Two discs: the first swings as φ = sin ωt/ω, and by a loop of ratio 1 it pulls the second, which
/// sticks on it, by K φ. What holds that bears (K + J ω²)|φ|, almost all of it the loop's.
struct LoopedSwing {
  double J1 = 2, J2 = 0.01, spring = 3, K = 5;

  [[nodiscard]] double omega() const { return std::sqrt((spring + K) / (J1 + J2)); }
  [[nodiscard]] double most() const { return (K + J2 * omega() * omega()) / omega(); }
  /// @param share of the most that the friction bears
  [[nodiscard]] Scene scene(double share) const {
    Scene scene = coaxial_discs(J1, J2);
    scene.hinges[0].latched = 50, scene.hinges[0].initial_rate = 1;
    scene.hinges[1].latched = 50;
    pull_towards(scene.hinges[0], 0, spring);
    rub(scene.hinges[1], 0.2 * share * most(), share * most());
    Synchronisation loop;
    loop.name = "cable", loop.first = 0, loop.second = 1, loop.stiffness = K;
    scene.synchronisations = {loop};
    return scene;
  }
};

/// When the second hinge begins to move; −1 if it does not.
double let_go(const Scene& scene, const Integration& how) {
  double last = -1;
  bool moved = false;
  const Observer watch = [&](const Sample& sample) {
    if (sample.rates[1] == 0 && !moved) last = sample.t;
    moved = moved || sample.rates[1] != 0;
  };
  const Outcome out = Deployment().run(scene, how, to_the_end, watch);
  REQUIRE(out.status == Status::timed_out);
  return moved ? last : -1;
}

} // namespace

TEST_CASE("a loop tears a stuck hinge loose between the ends of steps") {
  const LoopedSwing swing;
  const double quarter = std::numbers::pi / 2 / swing.omega();
  int judged = 0;
  for (const double less : {1e-2, 1e-3, 1e-4, 1e-6})
    for (const char* method : {"auto", "dopri5", "dop853", "bulirsch_stoer", "seulex"})
      for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) {
        Integration how = within(rtol, 1.9 * quarter);
        how.method = method;
        if (10 * rtol > less) continue; // the motion itself is not known so well
        const double exact = std::asin(1 - less) / swing.omega();
        const double found = let_go(swing.scene(1 - less), how);
        CAPTURE(less, method, rtol, exact, quarter);
        CHECK(found == Approx(exact).margin(100 * rtol / std::sqrt(less)));
        CHECK(let_go(swing.scene(1 + less), how) == -1);
        ++judged;
      }
  CHECK(judged >= 40);
}

TEST_CASE("wings with loops whose hinges stick agree with the reference", "[long]") {
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    RandomScene options;
    options.bodies = 2 + static_cast<int>(seed % 3), options.motion = BaseMotion::fixed;
    options.friction = false, options.mass_lower = 1, options.mass_upper = 20;
    RealFeatures features;
    features.air = features.gravity = features.stops = features.backlash = features.measured =
        false;
    features.dampers = features.preloads = false;
    features.stiffest = 300;
    Scene scene = with_real_hinges(random_scene(seed + 60, options), seed + 70, features);
    Draws draws(seed);
    for (Hinge& hinge : scene.hinges)
      if (draws.chance(0.7)) rub(hinge, draws.uniform(0.2, 1), draws.uniform(1, 2));
    const ReferenceOutcome exact = real_reference(scene, 1.5);
    CAPTURE(seed);
    const Outcome out = run_everywhere(scene, 1e-10, 1.5, true);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i)
      CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-6);
    ++compared;
  }
  CHECK(compared == 12);
}

namespace {

/// Hinges that stick, joined by loops of which a strand may go slack.
Scene slackening(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 2 + static_cast<int>(seed % 3), options.motion = BaseMotion::fixed;
  options.mass_lower = 1, options.mass_upper = 20;
  RealFeatures features;
  features.tables = features.measured = features.scales = features.dampers = features.windows =
      features.stops = features.backlash = features.gravity = features.air = false;
  Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
  for (Hinge& hinge : scene.hinges) {
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = 0.2, hinge.friction.viscous = 2;
  }
  return scene;
}

} // namespace

TEST_CASE(
    "a strand that may go slack in the step in which a hinge is let go leaves no run in vain") {
  int with_loops = 0;
  for (std::uint64_t seed = 100; seed < 300; ++seed) {
    const Scene scene = slackening(seed);
    with_loops += !scene.synchronisations.empty();
    const Outcome out = Deployment().run(scene, within(1e-7, 10), {});
    CAPTURE(seed, out.reason);
    CHECK(out.status != Status::failed);
  }
  CHECK(with_loops > 100);
}

TEST_CASE(
    "hinges that stick between loops that go slack move as in the limit of regularized friction",
    "[long]") {
  for (const std::uint64_t seed :
       {159, 198, 239, 254, 413, 514}) { // strands slacken where one is let go
    const Scene scene = slackening(seed);
    const Outcome out = Deployment().run(scene, within(1e-10, 6), to_the_end);
    const ReferenceOutcome limit = regularized_run(scene, 1e-7, 6);
    CAPTURE(seed, out.reason);
    REQUIRE(out.status != Status::failed);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i)
      CHECK(std::abs(out.final.angles[i] - limit.final.angles(i)) < 3e-6); // it creeps for 6 s
  }
}
