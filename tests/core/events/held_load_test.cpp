// The bound on what a locked hinge bears inside a step, against loads found from positions alone.
#include "core/events/held_load.hpp"
#include "tests/core/dense/any_motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;

namespace {

template <BaseMotion M> void check_random_wings() {
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    oracle::Draws draws(900 + k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 6, options.branching = k % 2 == 0, options.motion = M;
    const Scene scene = oracle::random_scene(1700 + k, options);
    const oracle::AnyMotion<M> motion(scene, 140 + k, draws.log_uniform(1e-3, 0.3),
                                      draws.log_uniform(0.01, 3));
    HeldLoadBound<double> bound;
    bound.over_step(motion.system, motion.step);
    const auto taken = [&](double from, double to) {
      return oracle::part_taken(
          motion.wing.size(), from, to, [&](double s) { return motion.loads(s); },
          [&](int i) { return bound.rise(i); });
    };
    CAPTURE(k);
    const double whole = taken(0, 1);
    CHECK(whole < 0.75 + 1e-6); // without the 4/3
    CHECK(taken(0, 0.5) < 0.75 + 1e-6);
    CHECK(taken(0.75, 1) < 0.75 + 1e-6);
    most = std::max(most, whole);
  }
  CHECK(most > 0.05); // it is not twenty times too large everywhere
}

} // namespace

TEST_CASE("what a locked hinge bears rises no more inside a step than the bound says") {
  SECTION("fixed base") { check_random_wings<BaseMotion::fixed>(); }
  SECTION("prescribed base") { check_random_wings<BaseMotion::prescribed>(); }
  SECTION("free base") { check_random_wings<BaseMotion::free>(); }
}
