/// Bound on the load of a stuck hinge inside a step, above the larger of the loads at its ends.
///
/// The moment on body i at hinge i, from the motion of all that is outward of it (× is the plane's
/// cross product, e_k = (cos θ_k, sin θ_k), and |.| are constants of the wing):
///
///     L_i = J_i θ̈_i + m_i g_i × r̈_i + Σ ( L_c + l_c × Y_c ) over the hinges c on body i           (1)
///
/// | symbol | meaning                                                    | unit |
/// |--------|------------------------------------------------------------|------|
/// | g_i    | from hinge i to the body's centre of mass                  | m    |
/// | l_c    | from hinge i to hinge c                                    | m    |
/// | Y_c    | the force on body c at its hinge (reaction_bound.hpp)      | N    |
///
/// so that, with bounds of the derivatives of θ, and from them of e, r̈ and Y,
///
///     |d²L_i/dt²| ≤ J_i |θ_i⁽⁴⁾| + m_i |g_i| (r⁽⁴⁾ + 2 |ė_i| r⁽³⁾ + |ë_i| r⁽²⁾)
///                   + Σ ( |d²L_c/dt²| + |l_c| (Ÿ_c + 2 |ė_i| Ẏ_c + |ë_i| Y_c) )                    (2)
///
/// and L leaves its chord over an interval of h by at most chord_excess(h) of that
/// (core/number/derivative_bounds.hpp).
///
/// The air adds to L by its magnitude, whichever its sign. On a plate of strength B
/// the normal velocity v = n·ṙ has, at its points, |v| ≤ V, |v̇| ≤ r⁽²⁾ + |ė| V, … and the force
/// ∓B ∫ |v| v along n
///
///     |F| ≤ B V²    |Ḟ| ≤ B (2 V |v̇| + |ė| V²)    |F̈| ≤ B (2 V |v̈| + 2 |v̇|² + 4 |ė| V |v̇| + |ë| V²)    (3)
///
/// The friction that holds a hinge balances L and the moments of the loops on it (loop_bulge.hpp).
#pragma once

#include "core/dense/step.hpp"
#include "core/events/loop_bulge.hpp"
#include "core/mechanics/system.hpp"
#include "core/number/derivative_bounds.hpp"

#include <vector>

namespace wingspread {

template <class T> class HeldLoadBound {
public:
  /// Bounds a step. Cost O(n), about an evaluation.
  template <class Topology, BaseMotion M>
  void over_step(const System<T, Topology, M>& system, const Step<T>& step) {
    const auto& tree = system.topology();
    const Wing<T>& wing = system.wing();
    bodies_.assign(tree.bodies() + 1, Bounds{});
    const DifferenceScale<T> scale(step.h);
    start_at_base(system, step, scale);
    tree.outward([&](int i) {
      const Bounds& parent = bodies_[tree.parent_of(i)];
      Bounds& own = bodies_[i];
      const Quintic<T> angle =
          step.coordinate(system.layout().angle(i), system.layout().freedoms());
      for (int k = 0; k < 6; ++k) own.path[k] = parent.path[k] + angle[k];
      own.turn(derivative_bounds_beyond_rounding(own.path, scale));
      const T arm = length(wing.bodies[i].arm);
      own.hinge = added(parent.hinge, arm, parent.direction);
      const T center = length(wing.bodies[i].center), mass = wing.bodies[i].mass;
      const Derivatives mass_center = added(own.hinge, center, own.direction);
      own.force = added(own.force, mass, mass_center);
      own.moment = fused(wing.bodies[i].central_inertia, own.angle_fourth,
                         mass * center * own.turned_with(mass_center));
      if (wing.plates.empty()) return;
      own.speed = fused(arm, parent.rate, parent.speed);
      if (any(wing.plates[i].strength > T(0))) add_air(wing.plates[i], own);
    });
    tree.inward([&](int i) {
      const Bounds& own = bodies_[i];
      Bounds& parent = bodies_[tree.parent_of(i)];
      parent.force = added(parent.force, T(1), own.force);
      parent.moment = parent.moment +
                      fused(length(wing.bodies[i].arm), parent.turned_with(own.force), own.moment);
    });
    h_ = step.h, weight_ = chord_excess(step.h);
    add_loops(system, step);
  }

  /// Largest excess of |L_i| over the loads at the step's ends, N·m. Between s = a and b: times (b − a)².
  [[nodiscard]] T rise(int i) const { return weight_ * bodies_[i].moment; }

  /// Largest excess over the whole step of the friction that holds hinge i.
  [[nodiscard]] T most_friction(int i) const {
    return loops_.empty() ? rise(i) : T(rise(i) + loops_[i].over(T(1)));
  }

  /// Largest excess of the friction that holds hinge i, between s = a and b. Where a loop may go slack or pass a
  /// knot in the step, its bound is that of the interval a … b.
  [[nodiscard]] Inside<T> friction(int i, const T& a, const T& b) const {
    Bulge<T> bulge{rise(i)};
    if (loops_.empty()) return bulge(a, b);
    if (loops_[i].is_smooth()) return (bulge += loops_[i])(a, b);
    Inside<T> inside = bulge(a, b);
    for (const HeldLoop& held : held_) {
      if (!joins(*held.loop, i)) continue;
      const LoopBulges<T> bulges = loop_bulges(*held.loop, part_of(held.angle_of_first, a, b),
                                               part_of(held.angle_of_second, a, b), h_ * (b - a));
      const Bulge<T>& own = held.loop->first == i ? bulges.first : bulges.second;
      inside.most = inside.most + own.over(T(1)), inside.smooth = inside.smooth && own.is_smooth();
    }
    return inside;
  }

private:
  /// Bounds of a vector's second, third and fourth derivative; for a force: of the force and its first two.
  struct Derivatives {
    T second = T(0), third = T(0), fourth = T(0);
  };

  struct HeldLoop {
    const LoopTerms<T>* loop;
    Quintic<T> angle_of_first, angle_of_second;
  };

  struct Bounds {
    Quintic<T> path{};     ///< θ
    T rate = T(0);         ///< |ė| = |θ̇|
    T angle_fourth = T(0); ///< |θ⁽⁴⁾|
    Derivatives direction; ///< of e
    Derivatives hinge;     ///< of the hinge's point
    Derivatives force;     ///< Y
    T moment = T(0);       ///< |d²L/dt²|
    T speed = T(0);        ///< of the hinge's point; only where there is air

    void turn(const DerivativeBounds<T>& angle) {
      const T square = angle.first * angle.first;
      rate = angle.first, angle_fourth = angle.fourth;
      direction.second = angle.second + square;
      direction.third = angle.third + angle.first * fused(T(3), angle.second, square);
      direction.fourth = fourth_of_direction(angle);
    }
    /// Bound of |d²/dt² (e × v)|. @param v bounds of v and its first two derivatives
    [[nodiscard]] T turned_with(const Derivatives& v) const {
      return fused(direction.second, v.second, fused(T(2) * rate, v.third, v.fourth));
    }
  };

  [[nodiscard]] static T length(const Vec2<T>& v) {
    using std::sqrt;
    return sqrt(dot(v, v));
  }
  [[nodiscard]] static Derivatives added(const Derivatives& a, const T& by, const Derivatives& b) {
    return {fused(by, b.second, a.second), fused(by, b.third, a.third),
            fused(by, b.fourth, a.fourth)};
  }

  /// Adds the force by (3) and its moment about the hinge, whose lever along n is constant.
  static void add_air(const PlateTerms<T>& plate, Bounds& own) {
    const T reach = larger(length(plate.from), length(plate.from + plate.along));
    const Derivatives point = added(own.hinge, reach, own.direction);
    const T V = fused(reach, own.rate, own.speed);
    const T v1 = fused(own.rate, V, point.second);
    const T v2 = fused(own.direction.second, V, fused(T(2) * own.rate, point.second, point.third));
    const T square = V * V, change = T(2) * V * v1, bend = T(2) * fused(V, v2, v1 * v1);
    const Derivatives force{
        square, fused(own.rate, square, change),
        fused(own.direction.second, square, fused(T(2) * own.rate, change, bend))};
    own.force = added(own.force, plate.strength, force);
    own.moment = fused(plate.strength * reach, bend, own.moment);
  }

  template <class Topology, BaseMotion M>
  void add_loops(const System<T, Topology, M>& system, const Step<T>& step) {
    const std::vector<LoopTerms<T>>& loops = system.wing().loops;
    if (loops.empty()) return;
    const Layout& at = system.layout();
    loops_.assign(at.bodies + 1, Bulge<T>{T(0)}), held_.clear();
    for (const LoopTerms<T>& loop : loops) {
      if (!any(system.is_locked(loop.first) || system.is_locked(loop.second))) continue;
      held_.push_back({&loop, step.coordinate(at.angle(loop.first), at.freedoms()),
                       step.coordinate(at.angle(loop.second), at.freedoms())});
      const LoopBulges<T> bulges =
          loop_bulges(loop, held_.back().angle_of_first, held_.back().angle_of_second, step.h);
      loops_[loop.first] += bulges.first, loops_[loop.second] += bulges.second;
    }
  }

  template <class Topology, BaseMotion M>
  void start_at_base(const System<T, Topology, M>& system, const Step<T>& step,
                     const DifferenceScale<T>& scale) {
    Bounds& base = bodies_[0];
    if constexpr (M == BaseMotion::free) {
      const int n = system.layout().freedoms();
      for (const int k : {0, 1}) {
        const DerivativeBounds<T> b =
            derivative_bounds_beyond_rounding(step.coordinate(k, n), scale);
        base.hinge = added(base.hinge, T(1), {b.second, b.third, b.fourth});
        base.speed = base.speed + b.first;
      }
      base.hinge.second = base.hinge.second + length(system.wing().base.gravity);
      base.path = step.coordinate(2, n);
    }
    if constexpr (M == BaseMotion::prescribed) {
      const BaseTerms<T>& given = system.wing().base;
      const CubicBounds<T> push = push_of_base(given, system.work().driven, step.t, step.h);
      base.hinge = {push.value, push.first, push.second};
      base.speed = fused(push.value + length(given.gravity), step.h,
                         length(system.base_velocity(step.x, step.t)));
      base.path = turn_of_base(given, system.work().driven, step.t, step.h);
    }
    base.turn(derivative_bounds_beyond_rounding(base.path, scale));
  }

  std::vector<Bounds> bodies_;  ///< 0 … n
  std::vector<Bulge<T>> loops_; ///< 1 … n: of the loops; empty where there are none
  std::vector<HeldLoop> held_;  ///< the loops on stuck hinges
  T h_ = T(0), weight_ = T(0);
};

} // namespace wingspread
