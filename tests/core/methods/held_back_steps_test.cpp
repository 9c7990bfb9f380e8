#include "core/methods/held_back_steps.hpp"
#include "core/number/pack.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

/// A phase begins at step 0; steps longer than 1 are held back.
[[nodiscard]] HeldBackSteps<double> fresh(double wait_until = 0) { return {1, wait_until, {}}; }

/// Number of steps of h until another method is considered; 0: never in 100 steps.
[[nodiscard]] int steps_until_leave(HeldBackSteps<double> rule, double h) {
  for (int step = 1; step <= 100; ++step) {
    if (rule.may_leave(h, step)) return step;
    rule.accepted(true, h, {step * h, 12.0 * step, static_cast<double>(step)});
  }
  return 0;
}

} // namespace

TEST_CASE("another method is considered after ten held-back steps in a row, not before the wait is "
          "over") {
  REQUIRE(steps_until_leave(fresh(), 1.5) == 10);
  REQUIRE(steps_until_leave(fresh(37), 1.5) == 37);
  REQUIRE(steps_until_leave(fresh(), 1.0) == 0); // as long as the limit: free
}

TEST_CASE("a step that is not held back resets the count, and is remembered") {
  HeldBackSteps<double> rule = fresh();
  for (int step = 1; step <= 9; ++step) rule.accepted(true, 1.5, {1.5 * step, 0, double(step)});
  REQUIRE(rule.last_free.steps == 0);
  rule.accepted(true, 0.5, {14, 120, 10});
  REQUIRE(rule.last_free.time == 14);
  REQUIRE(rule.last_free.evaluations == 120);
  REQUIRE_FALSE(rule.may_leave(1.5, 19));
  REQUIRE(rule.may_leave(1.5, 20));
  rule.accepted(false, 0.5, {15, 132, 11}); // in no lane
  REQUIRE(rule.last_free.steps == 10);
}

TEST_CASE("the lanes of a pack follow the rule as runs alone do") {
  using P = Pack<2>;
  oracle::Draws draws(7);
  HeldBackSteps<double> alone[2] = {fresh(), fresh(25)};
  HeldBackSteps<P> packs{P(1.0), P(0.0), {P(0.0), P(0.0), P(0.0)}};
  packs.wait_until.v[1] = 25;
  P steps(0.0);
  int left = 0;
  for (int round = 1; round <= 400; ++round) {
    P h(0.0), accepted(0.0);
    for (int lane = 0; lane < 2; ++lane) {
      h.v[lane] = draws.uniform(0, 1) < 0.1 ? 0.5 : 2;
      accepted.v[lane] = draws.uniform(0, 1) < 0.8 ? 1 : 0;
    }
    const P next = steps + P(1.0), time(0.25 * round), evaluations(12.0 * round);
    const P::Mask leaves = packs.may_leave(h, next);
    steps = steps + accepted;
    packs.accepted(accepted > P(0.0), h, {time, evaluations, steps});
    for (int lane = 0; lane < 2; ++lane) {
      CAPTURE(round, lane);
      REQUIRE((leaves.bits[lane] != 0) == alone[lane].may_leave(h.v[lane], next.v[lane]));
      left += leaves.bits[lane] != 0;
      alone[lane].accepted(accepted.v[lane] > 0, h.v[lane],
                           {time.v[lane], evaluations.v[lane], steps.v[lane]});
      REQUIRE(packs.last_free.time.v[lane] == alone[lane].last_free.time);
      REQUIRE(packs.last_free.evaluations.v[lane] == alone[lane].last_free.evaluations);
      REQUIRE(packs.last_free.steps.v[lane] == alone[lane].last_free.steps);
    }
  }
  REQUIRE(left > 50); // often enough to compare
}
