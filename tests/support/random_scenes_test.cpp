#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("draws come from the generator's bits alone") {
  // mt19937_64's 10000th output from its default seed is 9981545732273789042 (the C++ standard)
  Draws draws(5489);
  for (int i = 1; i < 10000; ++i) static_cast<void>(draws.uniform(0, 1));
  CHECK(draws.uniform(0, 1) == static_cast<double>(9981545732273789042ULL >> 11) * 0x1p-53);
}

TEST_CASE("draws stay in their ranges") {
  Draws draws(1);
  std::set<int> seen;
  for (int i = 0; i < 1000; ++i) {
    const double value = draws.log_uniform(0.1, 100);
    CHECK((value >= 0.1 && value <= 100));
    CHECK(std::abs(draws.sign()) == 1);
    seen.insert(draws.below(4));
  }
  CHECK(seen == std::set{0, 1, 2, 3});
}

TEST_CASE("random scenes are sound trees of every base motion, the same for the same seed") {
  std::set<BaseMotion> motions;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed) % 30;
    const Scene scene = random_scene(seed, options);
    INFO("seed " << seed);
    CHECK(unphysical(scene).empty());
    CHECK(outward_order(scene).size() == scene.bodies.size());
    CHECK(DenseWing<double>(scene).size() == options.bodies);
    CHECK(random_scene(seed, options).hinges[0].parent_point == scene.hinges[0].parent_point);
    motions.insert(scene.base.motion);
  }
  CHECK(motions.size() == 3);
}

TEST_CASE("a chain does not branch") {
  RandomScene options;
  options.bodies = 20;
  options.branching = false;
  const Scene scene = random_scene(5, options);
  std::set<int> parents;
  for (const Hinge& hinge : scene.hinges) parents.insert(hinge.parent);
  CHECK(parents.size() == 20);
}

TEST_CASE("the named scenes are sound") {
  for (const Scene& scene : {seed_scene(), two_wing_free_spacecraft(), symmetric_tree(),
                             harmonic_panel(), latching_panel()}) {
    INFO(scene.name);
    CHECK(unphysical(scene).empty());
    CHECK(outward_order(scene).size() == scene.hinges.size());
  }
}
