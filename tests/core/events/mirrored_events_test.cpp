// Events of mirrored wings: what happens left happens right at the same instant, so that neither side bears alone, and
// no rounding turns the spacecraft.
#include "core/deployment.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

using Pairs = std::vector<std::pair<int, int>>; ///< left and right

/// The hinges of symmetric_tree() that mirror each other.
Pairs pairs_of(const Scene& scene) {
  Pairs pairs;
  for (int i = 0; i < std::ssize(scene.hinges); ++i)
    for (int k = i + 1; k < std::ssize(scene.hinges); ++k)
      if ((scene.hinges[i].parent == base_index) == (scene.hinges[k].parent == base_index))
        pairs.emplace_back(i, k);
  return pairs;
}

/// Gives both hinges of a pair the same laws, some of which jump at events.
void give_laws(Scene& scene, const std::pair<int, int>& pair, Draws& draws) {
  Latch latch{draws.log_uniform(1e2, 1e5), 0, 0};
  latch.damping = latch.stiffness * draws.log_uniform(1e-3, 3e-2);
  if (draws.chance(0.6)) latch.backlash = draws.log_uniform(1e-3, 2e-2);
  if (draws.chance(0.4)) latch.holding_moment = latch.stiffness * draws.log_uniform(1e-4, 1e-2);
  std::optional<Damper> damper;
  if (draws.chance(0.5)) {
    damper.emplace().coefficient = draws.log_uniform(0.05, 1);
    damper->window = {draws.uniform(0.1, 0.5), draws.uniform(0.6, 0.95)};
  }
  Friction friction;
  friction.model = FrictionModel::exact;
  friction.coulomb = draws.chance(0.6) ? draws.uniform(0.01, 0.2) : 0;
  if (draws.chance(0.5)) friction.static_level = 1.2 * friction.coulomb;
  const std::optional<Stop> stop =
      draws.chance(0.5) ? std::optional(Stop{1e4, draws.uniform(0, 0.5), 0.0}) : std::nullopt;
  for (const int h : {pair.first, pair.second}) {
    Hinge& hinge = scene.hinges[h];
    hinge.latch = latch, hinge.friction = friction, hinge.stop = stop, hinge.damper = damper;
    if (!damper) continue;
    for (double& end : *hinge.damper->window)
      end = hinge.stowed + end * (hinge.latched - hinge.stowed);
  }
}

/// Ties the hinges of either wing by the same damped loop, whose strands go slack.
void tie(Scene& scene, Draws& draws) {
  Synchronisation loop;
  loop.stiffness = draws.log_uniform(10, 1e3);
  loop.damping = loop.stiffness * draws.log_uniform(3e-3, 3e-1);
  loop.preload = loop.stiffness * draws.log_uniform(1e-3, 3e-2);
  const auto travel = [&](int h) {
    return std::abs(scene.hinges[h].latched - scene.hinges[h].stowed);
  };
  for (const int root : {0, 2}) {
    loop.first = root, loop.second = root + 1, loop.ratio = travel(root + 1) / travel(root);
    scene.synchronisations.push_back(loop);
  }
}

double apart(const Peak& left, const Peak& right) {
  return std::abs(left.value - right.value) / std::max({left.value, right.value, 1e-6});
}

} // namespace

TEST_CASE("the peaks of mirrored wings are the same on both sides, by every kind of method") {
  Draws draws(55);
  std::size_t let_go = 0, latched = 0;
  for (int k = 0; k < random_cases(200, 24); ++k) {
    Scene scene = symmetric_tree();
    const Pairs pairs = pairs_of(scene);
    REQUIRE(pairs.size() == 2);
    for (const auto& pair : pairs) give_laws(scene, pair, draws);
    if (draws.chance(0.5)) tie(scene, draws);
    for (const char* method : {"auto", "dopri5", "seulex"}) {
      Integration how = within(1e-8, 5);
      how.method = method;
      const Outcome out = Deployment().run(scene, how, to_the_end);
      CAPTURE(k, method, out.reason);
      REQUIRE(out.status != Status::failed);
      for (const auto& [left, right] : pairs) {
        CHECK(apart(out.peak_force[left], out.peak_force[right]) < 1e-6);
        CHECK(apart(out.peak_moment[left], out.peak_moment[right]) < 1e-6);
      }
      CHECK(std::abs(out.final.base_angle) < 1e-7);
      let_go += out.let_go.size(), latched += out.latches.size();
    }
  }
  CHECK(latched > 100);
  CHECK(let_go > 10);
}
