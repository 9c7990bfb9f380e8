// Samples of a hinge's force at quarters of a step never dismiss a force above its peak.
#include "core/peaks/force_samples.hpp"
#include "tests/core/dense/any_motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace wingspread;
using oracle::AnyMotion;

namespace {

/// CHECKs that no test of the samples excludes the largest force of any hinge, where the peak so far lies just below it.
/// @return the number of hinges whose largest force lies in the first or the last half, above all samples
template <BaseMotion M> int check_motion(const AnyMotion<M>& motion) {
  const int n = motion.wing.size();
  std::vector<Lever<double>> levers;
  set_levers(motion.wing, motion.wing.tree, levers);
  ForceSamples<double> samples;
  samples.resize(n);
  samples.begin(motion.system, levers, motion.step);
  for (int k = 0; k <= samples.last; ++k) {
    const std::vector<double> forces = motion.forces(0.25 * k);
    for (int i = 1; i <= n; ++i) samples.of(i)[k] = forces[i];
  }
  std::vector<double> largest(n + 1, 0);
  for (int k = 0; k <= 64; ++k) {
    const std::vector<double> forces = motion.forces(k / 64.0);
    for (int i = 1; i <= n; ++i) largest[i] = std::max(largest[i], forces[i]);
  }
  int inside = 0;
  for (int i = 1; i <= n; ++i) {
    std::vector<PeakOf<double>> peaks(n + 1);
    for (PeakOf<double>& peak : peaks) peak.value = 1e300; // of the other hinges nothing is asked
    // differences of positions have 1e-5 or so
    peaks[i].value = largest[i] * (1 - 1e-4);
    const auto& f = samples.of(i);
    if (std::max(f[0], f[samples.last]) >= peaks[i].value) continue;
    CAPTURE(i, largest[i], f[0], f[1], f[2], f[3], f[4]);
    CHECK(samples.may_rise(peaks));
    if (f[samples.middle] >= peaks[i].value) continue;
    ++inside;
    CHECK(samples.may_rise_in_a_half(peaks));
    bool wanted = false;
    for (int k = 0; k <= samples.last; ++k) wanted = wanted || samples.wants_search(i, k, peaks[i]);
    CHECK(wanted);
  }
  return inside;
}

template <BaseMotion M> int check_random_motions() {
  int inside = 0;
  for (int k = 0; k < 150; ++k) {
    oracle::Draws draws(9100 + k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 4, options.branching = k % 2 == 0, options.motion = M;
    const AnyMotion<M> motion(oracle::random_scene(9400 + k, options), 9700 + k,
                              draws.log_uniform(1e-3, 0.3), draws.log_uniform(0.01, 3));
    CAPTURE(k);
    inside += check_motion(motion);
  }
  return inside;
}

} // namespace

TEST_CASE("no force above its peak inside a step is dismissed by its samples: random motions") {
  CHECK(check_random_motions<BaseMotion::fixed>() >= 20);
  CHECK(check_random_motions<BaseMotion::prescribed>() >= 20);
  CHECK(check_random_motions<BaseMotion::free>() >= 20);
}

// A panel swings a little, as fast as the step resolves: its force has a crest half-way to the step's middle, and none of
// the samples at the ends and in the middle shows it.
TEST_CASE("no force above its peak inside a step is dismissed by its samples: crests of a swing") {
  int inside = 0;
  for (const double turns : {0.5, 0.7, 0.9})
    for (const double crest : {0.15, 0.25, 0.35, 0.65, 0.75, 0.85}) {
      AnyMotion<BaseMotion::fixed> motion(oracle::harmonic_panel(), 1, 1, 0);
      const double w = 2 * std::numbers::pi * turns, size = 1e-3;
      const auto set = [&](State<double>& x, State<double>& dxdt, double s) {
        const double angle = size * std::cos(w * (s - crest)),
                     rate = -size * w * std::sin(w * (s - crest));
        x = {angle, rate}, dxdt = {rate, -w * w * angle};
      };
      set(motion.step.x, motion.step.dxdt, 0), set(motion.step.x1, motion.step.dxdt1, 1);
      CAPTURE(turns, crest);
      inside += check_motion(motion);
    }
  CHECK(inside >= 4);
}

// Of a parabola the vertex is exact, of other forces it is an estimate: so a spacing is allowed for.
TEST_CASE(
    "a force that rises to an end is sampled beside it unless its vertex is a spacing beyond") {
  ForceSamples<double> samples;
  samples.resize(1);
  int searched = 0, dismissed = 0;
  for (int k = 0; k < 400; ++k) {
    oracle::Draws draws(9900 + k);
    const double beyond = draws.log_uniform(1e-3, 2), size = draws.log_uniform(0.1, 10);
    for (const int end : {0, samples.last}) {
      const double vertex = end == 0 ? -beyond : 1 + beyond;
      for (int q = 0; q <= samples.last; ++q)
        samples.of(1)[q] = 100 - size * std::pow(0.25 * q - vertex, 2);
      const PeakOf<double> peak{samples.of(1)[end] - 1e-3, 0};
      CAPTURE(beyond, end);
      if (std::abs(beyond - 0.25) > 1e-3)
        CHECK(samples.wants_search(1, end, peak) == (beyond < 0.25));
      (beyond < 0.25 ? searched : dismissed) += 1;
    }
  }
  CHECK(searched > 100);
  CHECK(dismissed > 100);
}
