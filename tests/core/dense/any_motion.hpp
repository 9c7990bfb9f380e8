/// Random motions of a wing over a step, and their forces and moments, computed from positions alone.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/system.hpp"
#include "tests/support/body_loads.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

namespace wingspread::oracle {

using Point = std::complex<long double>;

/// A random motion of a wing over a step: quintics through random angles, rates and accelerations at its ends.
template <BaseMotion M> struct AnyMotion {
  AnyMotion(const Scene& drawn, std::uint64_t seed, double h, double swing)
      : scene(drawn), wing(make_wing<double>(scene, outward_order(scene))),
        system(with_numbers(scene)) {
    oracle::Draws draws(seed);
    const Layout& at = system.layout();
    step.t = draws.uniform(0, 3), step.h = h;
    system.enter_piece(step.t);
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

  /// Coordinate k of the layout at s: base position, base angle or relative angle of a body.
  [[nodiscard]] long double coordinate(int k, long double s) const {
    const Quintic<double> p = step.coordinate(k, system.layout().freedoms());
    Quintic<long double> q;
    std::copy(p.begin(), p.end(), q.begin());
    return value(q, s);
  }

  struct Place {
    std::vector<Point> hinge, center; ///< of bodies 0 … n; center: of mass
    std::vector<long double> angle;
  };
  [[nodiscard]] Place place(long double s) const {
    const BaseTerms<double>& base = wing.base;
    const long double t = step.t + s * step.h;
    std::vector<Point> hinge(wing.size() + 1), center(wing.size() + 1);
    std::vector<long double> angle(wing.size() + 1, 0);
    if (M == BaseMotion::free)
      hinge[0] = {coordinate(0, s), coordinate(1, s)}, angle[0] = coordinate(2, s);
    if (M == BaseMotion::prescribed && base.table) {
      const DrivenPiece<double>& piece = system.work().driven; // also used beyond its knots
      const long double u = t - piece.from;
      const auto twice = [&](const std::array<double, 4>& c) {
        return u * u * (c[0] / 2.0L + u * (c[1] / 6.0L + u * (c[2] / 12.0L + u * c[3] / 20.0L)));
      };
      angle[0] = piece.angle + u * piece.rate + twice(piece.turning);
      hinge[0] =
          Point(piece.velocity.x * u + twice(piece.x), piece.velocity.y * u + twice(piece.y));
    } else if (M == BaseMotion::prescribed) {
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
    return {hinge, center, angle};
  }

  /// |Y_i| at s, by differences of positions.
  [[nodiscard]] std::vector<double> forces(double s) const {
    const long double d = 1e-4L, wide = d * step.h;
    const auto before = place(s - d).center, at = place(s).center, after = place(s + d).center;
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

  /// |moment| of hinge i on the bodies outward of it, at s, by differences of positions.
  [[nodiscard]] std::vector<double> loads(double s) const {
    std::vector<double> result = moments(s);
    for (double& moment : result) moment = std::abs(moment);
    return result;
  }

  /// The same moments with their signs: the bodies' inertia, minus the loads of gravity and air on them. On a free base
  /// without air the wing falls as its common centre of mass does, whatever the coordinates of the base.
  [[nodiscard]] std::vector<double> moments(double s) const {
    const long double d = 1e-4L, wide = d * step.h;
    const Place before = place(s - d), at = place(s), after = place(s + d);
    std::vector<double> result(wing.size() + 1);
    Point gravity(wing.base.gravity.x, wing.base.gravity.y);
    if (M == BaseMotion::free && wing.plates.empty()) {
      const auto fall = [&](const Place& now) {
        long double mass = wing.bodies[0].mass;
        Point sum = mass * now.hinge[0];
        for (int j = 1; j <= wing.size(); ++j) {
          sum += static_cast<long double>(wing.bodies[j].mass) * now.center[j];
          mass += wing.bodies[j].mass;
        }
        return sum / mass;
      };
      gravity = (fall(before) - 2.0L * fall(at) + fall(after)) / (wide * wide);
    }
    for (int i = 1; i <= wing.size(); ++i) {
      long double sum = 0;
      for (int j = i; j <= wing.size(); ++j) {
        int k = j;
        while (k > i) k = wing.tree.parent_of(k);
        if (k != i) continue;
        const BodyTerms<double>& body = wing.bodies[j];
        const Point a = (before.center[j] - 2.0L * at.center[j] + after.center[j]) / (wide * wide);
        const Point lever = at.center[j] - at.hinge[i];
        sum += static_cast<long double>(body.mass) * std::imag(std::conj(lever) * (a - gravity));
        sum += static_cast<long double>(body.central_inertia) *
               (before.angle[j] - 2.0L * at.angle[j] + after.angle[j]) / (wide * wide);
        const Load<double> air = of_air(j, before, at, after, 2 * wide);
        sum -= std::imag(std::conj(lever) * Point(air.force.x(), air.force.y())) + air.moment;
      }
      result[i] = static_cast<double>(sum);
    }
    return result;
  }

  Scene scene;
  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  Step<double> step;

private:
  /// The load of the air on body j, by the oracle's law.
  [[nodiscard]] Load<double> of_air(int j, const Place& before, const Place& at, const Place& after,
                                    long double apart) const {
    const Body& body = scene.bodies[scene.hinges[wing.hinge_of[j]].child];
    if (!body.plate) return {Vector2<double>::Zero(), 0};
    const Point v = (after.center[j] - before.center[j]) / apart;
    return air_on_plate<double>(*body.plate, scene.environment.air_density,
                                static_cast<double>(at.angle[j]),
                                {static_cast<double>(v.real()), static_cast<double>(v.imag())},
                                static_cast<double>((after.angle[j] - before.angle[j]) / apart));
  }

  System<double, Tree, M> with_numbers(const Scene& drawn) {
    set_parameters(wing, drawn);
    return {wing, std::nullopt, work};
  }
};

/// The largest rise of `values` inside [from, to] above their values at its ends, as a share of the bound.
/// @param values values(s): of hinges 1 … n
/// @param rise rise(i): the bound of the rise over the whole step; it scales with the square of the interval
template <class Values, class Rise>
double part_taken(int hinges, double from, double to, const Values& values, const Rise& rise) {
  const auto first = values(from), last = values(to);
  double most = 0;
  for (int k = 1; k < 32; ++k) {
    const auto inside = values(from + (to - from) * k / 32);
    for (int i = 1; i <= hinges; ++i)
      most = std::max(most, (inside[i] - std::max(first[i], last[i])) /
                                ((to - from) * (to - from) * rise(i)));
  }
  return most;
}

/// Seeds of random wings and motions.
struct MotionSeeds {
  int steps, scenes, motions;
};

/// Checks on random wings in motion that a hinge's load rises inside a step by at most 3/4 of a bound: the bound has a
/// factor of 4/3 in reserve.
/// @param values values(motion, s): the loads of hinges 1 … n at s
/// @param bound bound(motion) → an object with rise(i), the bound of the rise over the whole step
/// @return the largest share of the bound that any load takes
template <BaseMotion M, class Values, class Bound>
double most_taken_by_random_wings(const MotionSeeds& seeds, const Values& values,
                                  const Bound& bound) {
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    Draws draws(seeds.steps + k);
    RandomScene options;
    options.bodies = 1 + k % 6, options.branching = k % 2 == 0, options.motion = M;
    const AnyMotion<M> motion(random_scene(seeds.scenes + k, options), seeds.motions + k,
                              draws.log_uniform(1e-3, 0.3), draws.log_uniform(0.01, 3));
    const auto found = bound(motion);
    const auto taken = [&](double from, double to) {
      return part_taken(
          motion.wing.size(), from, to, [&](double s) { return values(motion, s); },
          [&](int i) { return found.rise(i); });
    };
    CAPTURE(k);
    const double whole = taken(0, 1);
    CHECK(whole < 0.75 + 1e-6); // 1/(4/3)
    CHECK(taken(0, 0.5) < 0.75 + 1e-6);
    CHECK(taken(0.75, 1) < 0.75 + 1e-6);
    most = std::max(most, whole);
  }
  return most;
}

} // namespace wingspread::oracle
