// The bound on what hinge forces do inside a step, against forces found from positions alone.
#include "core/mechanics/system.hpp"
#include "core/peaks/reaction_bound.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

using namespace wingspread;

namespace {

using Point = std::complex<long double>;

/// Any motion of a wing over a step, by the quintics through random jets at its ends.
template <BaseMotion M> struct Motion {
  Motion(const Scene& scene, std::uint64_t seed, double h, double swing)
      : wing(make_wing<double>(scene, outward_order(scene))), system(with_numbers(scene)) {
    oracle::Draws draws(seed);
    const Layout& at = system.layout();
    step.t = draws.uniform(0, 3), step.h = h;
    for (State<double>* x : {&step.x, &step.dxdt, &step.x1, &step.dxdt1}) x->assign(at.size(), 0);
    for (int k = 0; k < at.freedoms(); ++k) {
      const int r = k + at.freedoms();
      const double angle = draws.uniform(-3, 3), rate = draws.uniform(-1, 1);
      step.x[k] = angle, step.x1[k] = angle + h * (rate + draws.uniform(-swing, swing));
      step.x[r] = step.dxdt[k] = rate + draws.uniform(-swing, swing);
      step.x1[r] = step.dxdt1[k] = rate + draws.uniform(-swing, swing);
      step.dxdt[r] = draws.uniform(-swing, swing) / h;
      step.dxdt1[r] = draws.uniform(-swing, swing) / h;
    }
  }

  /// Of the base's angle, or of body i's relative one, or of the base's place.
  [[nodiscard]] long double coordinate(int k, long double s) const {
    const Quintic<double> p = step.coordinate(k, system.layout().freedoms());
    Quintic<long double> q;
    std::copy(p.begin(), p.end(), q.begin());
    return value(q, s);
  }

  /// Centres of mass, 1 … n.
  [[nodiscard]] std::vector<Point> centers(long double s) const {
    const BaseTerms<double>& base = wing.base;
    const long double t = step.t + s * step.h;
    std::vector<Point> hinge(wing.size() + 1), center(wing.size() + 1);
    std::vector<long double> angle(wing.size() + 1, 0);
    if (M == BaseMotion::free)
      hinge[0] = {coordinate(0, s), coordinate(1, s)}, angle[0] = coordinate(2, s);
    if (M == BaseMotion::prescribed) {
      angle[0] = base.angle + t * (base.rate + base.angular_acceleration * t / 2);
      hinge[0] = Point(base.acceleration.x, base.acceleration.y) * (t * t / 2);
    }
    const auto along = [](const Vec2<double>& v, long double turn) {
      return Point(v.x, v.y) * std::polar(1.0L, turn);
    };
    for (int i = 1; i <= wing.size(); ++i) {
      const int p = wing.tree.parent_of(i);
      angle[i] = angle[p] + coordinate(system.layout().angle(i), s);
      hinge[i] = hinge[p] + along(wing.bodies[i].arm, angle[p]);
      center[i] = hinge[i] + along(wing.bodies[i].center, angle[i]);
    }
    return center;
  }

  /// |Y_i| at s, by differences of positions.
  [[nodiscard]] std::vector<double> forces(double s) const {
    const long double d = 1e-4L, wide = d * step.h;
    const auto before = centers(s - d), at = centers(s), after = centers(s + d);
    std::vector<Point> sum(wing.size() + 1);
    std::vector<double> result(wing.size() + 1);
    for (int i = wing.size(); i >= 1; --i) {
      sum[i] += static_cast<long double>(wing.bodies[i].mass) *
                (before[i] - 2.0L * at[i] + after[i]) / (wide * wide);
      sum[wing.tree.parent_of(i)] += sum[i];
      result[i] = static_cast<double>(std::abs(sum[i]));
    }
    return result;
  }

  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  Step<double> step;

private:
  System<double, Tree, M> with_numbers(const Scene& scene) {
    set_parameters(wing, scene);
    return {wing, wing.tree, std::nullopt, work};
  }
};

/// Largest part of the rise that any force takes above the ends of an interval of the step.
template <BaseMotion M> double taken(const Motion<M>& motion, double from, double to, double part) {
  std::vector<Lever<double>> levers;
  set_levers(motion.wing, motion.wing.tree, levers);
  ReactionBound<double> bound;
  bound.resize(motion.wing.size());
  bound.over_step(motion.system, levers, motion.step);
  const auto first = motion.forces(from), last = motion.forces(to);
  double most = 0;
  for (int k = 1; k < 32; ++k) {
    const auto inside = motion.forces(from + (to - from) * k / 32);
    for (int i = 1; i <= motion.wing.size(); ++i)
      most = std::max(most, (inside[i] - std::max(first[i], last[i])) / (part * bound.rise(i)));
  }
  return most;
}

template <BaseMotion M> void check_random_wings() {
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    oracle::Draws draws(300 + k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 6, options.branching = k % 2 == 0, options.motion = M;
    const Scene scene = oracle::random_scene(700 + k, options);
    const Motion<M> motion(scene, 40 + k, draws.log_uniform(1e-3, 0.3), draws.log_uniform(0.01, 3));
    CAPTURE(k);
    const double whole = taken(motion, 0, 1, 1);
    CHECK(whole < 0.75 + 1e-6); // without the 4/3
    CHECK(taken(motion, 0, 0.5, 0.25) < 0.75 + 1e-6);
    CHECK(taken(motion, 0.75, 1, 1. / 16) < 0.75 + 1e-6);
    most = std::max(most, whole);
  }
  CHECK(most > 0.1); // it is no ten times too large everywhere
}

} // namespace

TEST_CASE("a hinge force rises no more inside a step than the bound says: fixed base") {
  check_random_wings<BaseMotion::fixed>();
}
TEST_CASE("a hinge force rises no more inside a step than the bound says: prescribed base") {
  check_random_wings<BaseMotion::prescribed>();
}
TEST_CASE("a hinge force rises no more inside a step than the bound says: free base") {
  check_random_wings<BaseMotion::free>();
}

TEST_CASE(
    "the bound on a hinge force is attained by a swing of half a period, and by none longer") {
  // a panel swings by 1e-3 rad about where the step's middle finds it: only its acceleration counts
  Motion<BaseMotion::fixed> motion(oracle::harmonic_panel(), 1, 1, 0);
  for (const double turns : {0.25, 0.5, 0.75, 0.95}) {
    const double half = std::numbers::pi * turns, w = 2 * half, size = 1e-3;
    motion.step.x = {size * std::cos(half), size * w * std::sin(half)};
    motion.step.x1 = {size * std::cos(half), -size * w * std::sin(half)};
    motion.step.dxdt = {motion.step.x[1], -w * w * motion.step.x[0]};
    motion.step.dxdt1 = {motion.step.x1[1], -w * w * motion.step.x1[0]};
    std::vector<Lever<double>> levers;
    set_levers(motion.wing, motion.wing.tree, levers);
    ReactionBound<double> bound;
    bound.resize(1);
    bound.over_step(motion.system, levers, motion.step);
    const double lever = levers[1].moment * size * w * w; // N, at the middle of the true swing
    CAPTURE(turns);
    CHECK(lever - lever * std::abs(std::cos(half)) < bound.rise(1));
    CHECK(1.1 * (lever + lever) > bound.rise(1));
  }
}
