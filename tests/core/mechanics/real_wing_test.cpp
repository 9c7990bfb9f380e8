// The right-hand side of wings with real hinges against the independent dense formulation: tables by
// Hermite's basis, the air by Gauss's points, loops and stops in their textbook form.
#include "tests/core/mechanics/evaluated_wing.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

Scene random_real_scene(std::uint64_t seed, int bodies, const RealFeatures& features = {}) {
  RandomScene options;
  options.bodies = bodies;
  options.branching = seed % 2 == 0;
  return with_real_hinges(random_scene(seed, options), seed + 20'000, features);
}

/// What the energies are off between two states: potentials have their zeros where they like.
template <class T>
double energy_deviation(const Scene& scene, const WingState<double>& state, Evaluated<T> got) {
  WingState<double> other = random_state(1, scene);
  other.engagement = state.engagement;
  if (scene.base.motion == BaseMotion::prescribed)
    other.base_angle = state.base_angle, other.base_rate = state.base_rate;
  const Evaluated<T> there = evaluate<T>(scene, other);
  const DenseWing<Quad> wing(scene);
  const auto a = wing.balance(state.cast<Quad>()), b = wing.balance(other.cast<Quad>());
  Deviation energies;
  energies.note(got.kinetic, a.kinetic);
  energies.scale = std::max({energies.scale, std::abs(static_cast<double>(a.potential)),
                             std::abs(static_cast<double>(b.potential))});
  energies.note(T(got.potential - there.potential), Quad(a.potential - b.potential));
  return energies.relative();
}

} // namespace

TEST_CASE(
    "with real hinges, accelerations, forces, moments and energies agree with a dense solve") {
  double worst[] = {0, 0, 0, 0};
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const int bodies = 1 + static_cast<int>(seed % 9);
    const Scene scene = random_real_scene(seed, bodies);
    const auto state = random_state(seed + 10'000, scene);
    const auto exact = DenseWing<Quad>(scene).respond(state.cast<Quad>());
    const auto got = evaluate<double>(scene, state);
    const double off[] = {acceleration_deviation(got, exact), force_deviation(got, exact),
                          moment_deviation(got, exact), energy_deviation(scene, state, got)};
    CAPTURE(seed, bodies, static_cast<int>(scene.base.motion));
    CHECK(off[0] < 1e-12);
    CHECK(off[1] < 1e-12);
    CHECK(off[2] < 1e-13);
    CHECK(off[3] < 1e-13);
    for (int k = 0; k < 4; ++k) worst[k] = std::max(worst[k], off[k]);
  }
  WARN("worst relative deviation: accelerations " << worst[0] << ", forces " << worst[1]
                                                  << ", moments " << worst[2] << ", energies "
                                                  << worst[3]);
}

TEST_CASE("each feature of real hinges by itself agrees with a dense solve") {
  const RealFeatures none{false, false, false, false, false, false,
                          false, false, false, false, false};
  bool RealFeatures::*const each[] = {
      &RealFeatures::tables,  &RealFeatures::measured, &RealFeatures::scales,
      &RealFeatures::dampers, &RealFeatures::stops,    &RealFeatures::backlash,
      &RealFeatures::loops,   &RealFeatures::gravity,  &RealFeatures::air};
  for (int feature = 0; feature < 9; ++feature)
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      RealFeatures features = none;
      features.*each[feature] = true;
      const Scene scene = random_real_scene(seed, 4, features);
      const auto state = random_state(seed + 10'000, scene);
      const auto exact = DenseWing<Quad>(scene).respond(state.cast<Quad>());
      const auto got = evaluate<double>(scene, state);
      CAPTURE(feature, seed, static_cast<int>(scene.base.motion));
      CHECK(acceleration_deviation(got, exact) < 1e-12);
      CHECK(force_deviation(got, exact) < 1e-12);
      CHECK(moment_deviation(got, exact) < 1e-13);
      CHECK(energy_deviation(scene, state, got) < 1e-13);
    }
}

TEST_CASE("with real hinges, the same kernel serves long double and quad") {
  // tables keep their cubics in double; all else follows the number
  RealFeatures features;
  features.tables = features.measured = false;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_real_scene(seed, 1 + static_cast<int>(seed % 6), features);
    const auto state = random_state(seed + 500, scene);
    const auto exact = DenseWing<Quad>(scene).respond(state.cast<Quad>());
    CAPTURE(seed);
    CHECK(acceleration_deviation(evaluate<long double>(scene, state), exact) < 1e-15);
    const auto quad = evaluate<Quad>(scene, state);
    CHECK(acceleration_deviation(quad, exact) < 1e-28);
    CHECK(moment_deviation(quad, exact) < 1e-29);
    CHECK(energy_deviation(scene, state, quad) < 1e-28);
  }
}

// The proofs of an early end rely on this bound.
TEST_CASE("no angle has more friction than a hinge's bound, with levels that are measured too") {
  int measured = 0;
  double most = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Draws draws(seed);
    Scene scene = random_real_scene(seed, 3);
    for (Hinge& hinge : scene.hinges)
      if (draws.chance(0.7)) hinge.friction.model = FrictionModel::exact;
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    for (int i = 1; i <= wing.size(); ++i) {
      const HingeTerms<double>& hinge = wing.hinges[i];
      double largest = 0;
      for (int k = 0; k <= 400; ++k) {
        const double travel = (k / 200.0 - 0.5) * (hinge.latched - hinge.stowed);
        x[system.layout().angle(i)] = hinge.stowed + travel;
        largest = std::max(largest, system.static_limit(x, i));
      }
      CAPTURE(seed, i);
      CHECK(largest <= hinge.most_static() * (1 + 1e-12));
      CHECK(hinge.most_static() <= hinge.most_friction());
      if (!(hinge.measured_exact > 0)) continue;
      ++measured, most = std::max(most, largest / hinge.most_static());
    }
  }
  CHECK(measured > 10);
  CHECK(most > 0.9);
}
