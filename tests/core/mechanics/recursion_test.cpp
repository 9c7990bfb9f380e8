// The recursion against an independent dense formulation (absolute angles, Jacobians, LDLᵀ).
#include "core/mechanics/recursion.hpp"
#include "tests/core/mechanics/evaluated_wing.hpp"
#include "tests/support/random_scenes.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Largest deviation of accelerations and of forces, each relative to the largest of its kind.
template <class T, class Reference>
std::pair<double, double> largest_deviations(const Evaluated<T>& got,
                                             const WingResponse<Reference>& expected) {
  return {acceleration_deviation(got, expected), force_deviation(got, expected)};
}

} // namespace

TEST_CASE("accelerations and hinge forces agree with a dense solve over random trees and chains") {
  // 1200 scenes of 1-30 bodies, all base motions, masses over three decades, latches engaged at
  // random. The reference is solved in quad, so that what deviates is the recursion's own error: a
  // few hundred roundings, amplified by the spread of masses.
  double worst = 0, worst_force = 0;
  for (std::uint64_t seed = 0; seed < 1200; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 30);
    options.branching = seed % 2 == 0;
    const Scene scene = oracle::random_scene(seed, options);
    const auto state = oracle::random_state(seed + 10'000, scene);
    // quad costs milliseconds for a small wing, and most scenes are small enough
    const auto [acceleration, force] =
        options.bodies <= 12
            ? largest_deviations(evaluate<double>(scene, state),
                                 oracle::DenseWing<Quad>(scene).respond(state.cast<Quad>()))
            : largest_deviations(
                  evaluate<double>(scene, state),
                  oracle::DenseWing<long double>(scene).respond(state.cast<long double>()));
    worst = std::max(worst, acceleration);
    worst_force = std::max(worst_force, force);
    CAPTURE(seed, options.bodies);
    REQUIRE(acceleration < 1e-12);
    REQUIRE(force < 1e-12);
  }
  WARN("worst relative deviation: accelerations " << worst << ", forces " << worst_force);
}

TEST_CASE("a thousand bodies agree with a dense solve") {
  for (const bool branching : {false, true}) {
    oracle::RandomScene options;
    options.bodies = 1000;
    options.branching = branching;
    options.mass_lower = 1, options.mass_upper = 10;
    const Scene scene = oracle::random_scene(7, options);
    const auto state = oracle::random_state(8, scene);
    const auto [acceleration, force] = largest_deviations(
        evaluate<double>(scene, state),
        oracle::DenseWing<long double>(scene).respond(state.cast<long double>()));
    CAPTURE(branching, acceleration, force);
    CHECK(acceleration < 1e-10);
    CHECK(force < 1e-10);
  }
}

TEST_CASE("the same kernel serves double, long double and quad") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 8);
    const Scene scene = oracle::random_scene(seed, options);
    const auto state = oracle::random_state(seed + 500, scene);
    const auto exact = oracle::DenseWing<Quad>(scene).respond(state.cast<Quad>());
    CAPTURE(seed);
    CHECK(largest_deviations(evaluate<double>(scene, state), exact).first < 1e-12);
    CHECK(largest_deviations(evaluate<long double>(scene, state), exact).first < 1e-15);
    // quad against quad, compared in quad
    const auto quad = evaluate<Quad>(scene, state);
    Quad worst = 0, largest = 0;
    for (int i = 0; i < static_cast<int>(quad.hinge.size()); ++i) {
      REQUIRE(isfinite(quad.hinge[i]));
      worst = std::max<Quad>(worst, abs(quad.hinge[i] - exact.hinge_accelerations[i]));
      largest = std::max<Quad>(largest, abs(exact.hinge_accelerations[i]));
    }
    CHECK(static_cast<double>(Quad(worst / largest)) < 1e-29);
  }
}

TEST_CASE("a chain known to the compiler gives the bits of the tree") {
  const Scene scene = oracle::seed_scene();
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> one, other;
  System<double, Tree, BaseMotion::fixed> tree(wing, std::nullopt, one);
  System<double, Chain<3>, BaseMotion::fixed> chain(wing, std::nullopt, other);
  State<double> x, a, b;
  tree.start(x);
  a = b = x;
  for (int k = 0; k < 6; ++k) x[k] += 0.1 * (k + 1);
  tree(x, a, 0.0);
  chain(x, b, 0.0);
  CHECK(a == b);
}
