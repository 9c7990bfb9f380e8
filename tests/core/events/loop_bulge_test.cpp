// How far a loop's moments leave their chords: against samples and differences of the moments.
#include "core/events/loop_bulge.hpp"
#include "tests/core/laws/loop_over_step.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The largest share of its bound that a moment's excess, or its second derivative, takes.
struct BulgeTaken {
  double excess = 0, second = 0;
};

BulgeTaken bulge_taken(const LoopOverStep& step, int i) {
  const LoopBulges<double> bulges = loop_bulges(step.loop, step.a, step.b, step.h);
  const Bulge<double>& bulge = i == 1 ? bulges.first : bulges.second;
  constexpr int parts = 200;
  std::array<double, parts + 1> m;
  double size = 0;
  for (int k = 0; k <= parts; ++k)
    m[k] = std::abs(step.moment(i, k / double(parts))), size = std::max(size, m[k]);
  const double rounding = 1e-11 * (size + step.loop.stiffness);
  BulgeTaken most;
  for (int k = 1; k < parts; ++k)
    most.excess = std::max(most.excess, (m[k] - std::max(m[0], m[parts]) - rounding) /
                                            (bulge.over(1) + rounding));
  if (!bulge.is_smooth()) return most;
  for (int k = 1; k < parts; ++k) {
    const double s = k / double(parts), ds = 1e-3;
    const double bend =
        step.moment(i, s - ds) - 2 * step.moment(i, s) + step.moment(i, s + ds); // (h ds)²
    const double bound = bulge.bend / chord_excess(1.0) * ds * ds;
    most.second = std::max(most.second, (std::abs(bend) - 1e-3 * rounding) / (bound + rounding));
  }
  return most;
}

} // namespace

TEST_CASE("a loop's moments leave their chords by no more than their bulges: random loops") {
  std::array<double, 2> second{};
  int smooth = 0, kinked = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    const LoopOverStep step(seed);
    for (const int i : {1, 2}) {
      const BulgeTaken taken = bulge_taken(step, i);
      CAPTURE(seed, i, taken.excess, taken.second);
      CHECK(taken.excess <=
            (taken.second > 0 ? 0.75 : 1) + 1e-6); // of a bend a quarter is in reserve
      CHECK(taken.second <= 1 + 1e-3);
      ++(taken.second > 0 ? smooth : kinked);
      second[i - 1] = std::max(second[i - 1], taken.second);
    }
  }
  CHECK(std::min(smooth, kinked) > 400);
  CHECK(std::min(second[0], second[1]) > 0.9);
}

TEST_CASE("a loop's bulges are nearly taken where the gear changes all the time") {
  BulgeTaken most[2];
  for (std::uint64_t seed = 1; seed <= 400; ++seed)
    for (const int i : {1, 2}) {
      const BulgeTaken taken = bulge_taken(bent_loop(seed), i);
      CAPTURE(seed, i, taken.excess, taken.second);
      CHECK(taken.excess <= 0.75 + 1e-6);
      CHECK(taken.second <= 1 + 1e-3);
      most[i - 1].second = std::max(most[i - 1].second, taken.second);
    }
  CHECK(std::min(most[0].second, most[1].second) > 0.9);
}

// A moment that rises until a strand goes slack drops by ½ D ė there. If both are alike, it takes two thirds of its bound,
// lean and jump together: it rises by X above its start and then drops by J, of X/2 + J.
TEST_CASE("a loop's bulges are nearly taken where a strand goes slack late in the step") {
  BulgeTaken most[2];
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    LoopOverStep step = bent_loop(seed);
    Draws draws(seed + 900);
    LoopTerms<double>& loop = step.loop;
    const double ahead =
        draws.chance(0.5) ? 0 : draws.log_uniform(0.1, 10); // of e at the start, rad
    for (double& angle : step.b) angle -= loop.sense_b * ahead;
    loop.damping = 0, loop.slack_beyond = never_slack;
    const int i = 1 + draws.below(2);
    const double s = draws.uniform(0.8, 0.98), before = step.moment(i, 0), at = step.moment(i, s);
    const double rise = std::abs(at) - std::abs(before), size = std::abs(step.state(s).elastic);
    loop.damping = 1;
    const double drop =
        0.5 * std::abs(step.state(s).viscous * on_hinge(loop, i, step.state(s).gear));
    loop.damping = draws.log_uniform(0.3, 3) * rise / drop;
    loop.slack_beyond = size;
    const LoopBulges<double> bulges = loop_bulges(loop, step.a, step.b, step.h);
    CHECK_FALSE((i == 1 ? bulges.first : bulges.second).is_smooth());
    for (const int hinge : {1, 2}) {
      const double taken = bulge_taken(step, hinge).excess;
      CAPTURE(seed, i, hinge, taken, ahead);
      CHECK(taken <= 2.0 / 3 + 1e-3);
      if (hinge == i) most[i - 1].excess = std::max(most[i - 1].excess, taken);
    }
  }
  CHECK(std::min(most[0].excess, most[1].excess) > 0.5);
}
