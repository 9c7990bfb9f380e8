// The bound on what a locked hinge bears inside a step, against loads found from positions alone.
#include "core/events/held_load.hpp"
#include "tests/core/dense/any_motion.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

template <BaseMotion M> void check_random_wings() {
  const double most = oracle::most_taken_by_random_wings<M>(
      {900, 1700, 140},
      [](const oracle::AnyMotion<M>& motion, double s) { return motion.loads(s); },
      [](const oracle::AnyMotion<M>& motion) {
        HeldLoadBound<double> bound;
        bound.over_step(motion.system, motion.step);
        return bound;
      });
  CHECK(most > 0.05); // it is not twenty times too large everywhere
}

} // namespace

TEST_CASE("what a locked hinge bears rises no more inside a step than the bound says") {
  SECTION("fixed base") { check_random_wings<BaseMotion::fixed>(); }
  SECTION("prescribed base") { check_random_wings<BaseMotion::prescribed>(); }
  SECTION("free base") { check_random_wings<BaseMotion::free>(); }
}
