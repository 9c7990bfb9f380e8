// How far from rest the laws of a wing's linear model hold.
#include "tests/core/proofs/latched_wing.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE(
    "the linear model holds up to the nearest stop, window's end or stowed angle on either side") {
  int far = 0, near = 0, windows = 0;
  for (int seed = 1; seed <= 300; ++seed) {
    Draws draws(seed);
    Scene scene = latching_panel();
    Hinge& hinge = scene.hinges[0];
    const double sense = draws.sign(), way = draws.uniform(0.5, 3), share = draws.uniform(0, 1);
    hinge.stowed = draws.uniform(-1, 1), hinge.latched = hinge.stowed + sense * way;
    hinge.friction = {}, hinge.friction.viscous = 1;
    const bool latches = draws.chance(0.5);
    const double rest = latches ? hinge.latched : hinge.stowed + sense * share * way;
    double room = std::numeric_limits<double>::infinity();
    if (latches) {
      hinge.spring = {};
      room = way;
    } else {
      hinge.latch.reset();
      pull_towards(hinge, rest, draws.log_uniform(1, 100));
    }
    const auto edge = [&](double angle, int& drawn) {
      drawn += std::abs(angle - rest) < room;
      room = std::min(room, std::abs(angle - rest));
    };
    if (draws.chance(0.5)) {
      hinge.stop = Stop{1e4, 0, draws.uniform(0.01, 2)};
      edge(hinge.stowed - sense * hinge.stop->gap, near);
    }
    if (draws.chance(0.5)) {
      hinge.far_stop = Stop{1e4, 0, draws.uniform(0.01, 2)};
      edge(hinge.latched + sense * hinge.far_stop->gap, far);
    }
    if (draws.chance(0.3)) {
      Damper& damper = hinge.damper.emplace();
      damper.coefficient = 0.1;
      damper.window = {rest + draws.uniform(-2, 2), rest + draws.uniform(-2, 2)};
      for (const double end : *damper.window) edge(end, windows);
    }
    const Latched<BaseMotion::fixed> wing(scene);
    CAPTURE(seed, latches, sense, rest);
    REQUIRE(wing.has_model);
    CHECK(wing.model.angles(0) == Approx(rest).margin(1e-12));
    if (room < 1e300)
      CHECK(wing.model.room(0) == Approx(room).epsilon(1e-9));
    else
      CHECK(wing.model.room(0) == room);
  }
  for (const int drawn : {far, near, windows}) CHECK(drawn > 30);
}
