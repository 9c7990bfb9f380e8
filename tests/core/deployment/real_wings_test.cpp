// Whole wings with real hinges against the dense formulation, run by another method.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/random_cases.hpp"

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// Latches, peaks, overtravel and how it ends.
void check_run(const Outcome& out, const ReferenceOutcome& exact, double latches, double peaks) {
  compare(out, exact, latches, peaks);
  for (std::size_t i = 0; i < exact.overtravel.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(out.overtravel[i] - exact.overtravel[i].value) < 10 * latches);
    CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 10 * latches);
  }
}

double largest_overtravel(const Outcome& out) {
  return *std::max_element(out.overtravel.begin(), out.overtravel.end());
}

} // namespace

TEST_CASE("the yoke wing without stops goes through itself, and says so", "[long]") {
  const Scene scene = yoke_wing();
  const Outcome out = run_everywhere(scene, 1e-10, 60);
  CHECK(out.latches.size() == 5);
  const double degrees = largest_overtravel(out) * 180 / pi;
  CAPTURE(degrees);
  CHECK((degrees > 25 && degrees < 40));
  CHECK(relative(largest_overtravel(out), out.overtravel[2]) == 0); // the second between panels
  const ReferenceOutcome exact = real_reference(scene, out.t_end);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(std::abs(out.overtravel[i] - exact.overtravel[i].value) < 1e-7);
}

TEST_CASE("the yoke wing with stops latches as the dense formulation says", "[long]") {
  const Scene scene = yoke_wing_with_stops();
  const double t_end = Deployment().run(scene, within(1e-8, 100), {}).t_end;
  const ReferenceOutcome exact = real_reference(scene, t_end);
  REQUIRE(exact.latches.size() == 5);
  const Outcome out = run_everywhere(scene, 1e-11, t_end, true);
  check_run(out, exact, 1e-8, 1e-6);
  CHECK(largest_overtravel(out) < 2 * pi / 180);
  // the order, or a rate, is another than without
  const Outcome through = run(yoke_wing(), 1e-8, 100, false);
  bool other = false;
  for (std::size_t k = 0; k < 5; ++k)
    other = other || through.latches[k].hinge != out.latches[k].hinge ||
            std::abs(through.latches[k].rates[through.latches[k].hinge] -
                     out.latches[k].rates[out.latches[k].hinge]) > 0.5;
  CHECK(other);
}

TEST_CASE("random wings with real hinges on every base agree with the reference", "[long]") {
  const auto cases = static_cast<std::uint64_t>(random_cases(24, 6));
  std::size_t latches = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = static_cast<BaseMotion>(seed % 3);
    const Scene scene = with_real_hinges(random_scene(seed, options), seed);
    CAPTURE(seed, options.bodies, seed % 3);
    const Outcome out = run_everywhere(scene, 1e-11, 2, true);
    check_run(out, real_reference(scene, 2), 1e-8, 1e-6);
    latches += out.latches.size();
  }
  CHECK(latches >= 10 * cases / 24);
}

TEST_CASE("conservative real hinges keep the energy up to the first latch") {
  RealFeatures features;
  features.measured = features.dampers = features.air = false;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.friction = false;
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = seed % 2 ? BaseMotion::free : BaseMotion::fixed;
    Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
    for (Hinge& hinge : scene.hinges)
      if (hinge.stop) hinge.stop->dissipation = 0;
    for (Synchronisation& loop : scene.synchronisations) loop.damping = 0;
    const Outcome out = run(scene, 1e-10, 1.5);
    const auto balance = DenseWing<double>(scene).balance(DenseWing<double>(scene).initial_state());
    const double size = 1 + balance.kinetic + std::abs(balance.potential);
    CAPTURE(seed, size, out.energy.drift_before_first_latch);
    CHECK(out.energy.drift_before_first_latch < 1e-7 * size);
    CHECK(out.energy.drift_before_first_latch > 0);
  }
}
