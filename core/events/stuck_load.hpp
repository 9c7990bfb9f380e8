/// Bound on the load of a stuck hinge inside a step, above the larger of the loads at its ends.
///
/// The load is a scalar: axes that turn with any body f show the same one. Seen from them, body k has turned by
/// δ_k = θ_k − θ_f, and its arms accelerate by z = i θ̈_k − θ̇_k² times themselves, in complex numbers. So the
/// moment on body i at hinge i, from the motion of all that is outward of it (× is the plane's cross product,
/// and |.| are constants of the wing), is
///
///     L_i = J_i θ̈_i + m_i g_i × a_i + Σ ( L_c + l_c × Y_c ) over the hinges c on body i           (1)
///     a_i = a + Σ l_p z_p e^{iδ_p} over the arms p from the base to the centre of body i
///
/// | symbol | meaning                                                             | unit |
/// |--------|---------------------------------------------------------------------|------|
/// | g_i    | from hinge i to the body's centre of mass                           | m    |
/// | l_c    | from hinge i to hinge c                                             | m    |
/// | Y_c    | the force on body c at its hinge (reaction_bound.hpp)               | N    |
/// | a      | acceleration that the base's origin feels; of a free base without   | m/s² |
/// |        | air minus that of the common centre of mass relative to the base    |      |
///
/// A vector with bounds V, V̇, V̈ in axes that turn by δ against f's has in those of f
///
///     V,    V̇ + |δ̇| V,    V̈ + 2 |δ̇| V̇ + (|δ̈| + δ̇²) V                                              (2)
///
/// Seen from f = i, a load that is constant has the bound 0: a wing that turns as one body, or hangs on a body that
/// turns steadily. Seen from inertial axes a push has the least bound. Each bound holds, so the lesser does. L leaves
/// its chord over an interval of h by at most chord_excess(h) of it (core/number/derivative_bounds.hpp).
///
/// The air adds to L by its magnitude, whichever its sign. On a plate of strength B
/// the normal velocity v = n·ṙ has, at its points, |v| ≤ V, and by (2) |v̇| and |v̈|; and the force
/// ∓B ∫ |v| v along n
///
///     |F| ≤ B V²    |Ḟ| ≤ 2 B V |v̇|    |F̈| ≤ 2 B (V |v̈| + |v̇|²)                                   (3)
///
/// The friction that holds a hinge balances L and the moments of the loops on it (loop_bulge.hpp) and of its motor, which
/// at φ̇ = 0 changes by at most c |ẇ|.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/loop_bulge.hpp"
#include "core/mechanics/system.hpp"
#include "core/number/derivative_bounds.hpp"

#include <vector>

namespace wingspread {

template <class T> class HeldLoadBound {
public:
  /// Bounds a step, seen from inertial axes. Cost O(n), about an evaluation.
  template <class Topology, BaseMotion M>
  void over_step(const System<T, Topology, M>& system, const Step<T>& step) {
    const auto& tree = system.topology();
    const DifferenceScale<T> scale(step.h);
    bodies_.resize(tree.bodies() + 1);
    bodies_[0].path = path_of_base(system, step);
    bodies_[0].angle = derivative_bounds_beyond_rounding(bodies_[0].path, scale);
    tree.outward([&](int i) {
      Bounds& own = bodies_[i];
      own.hinge = step.coordinate(system.layout().angle(i), system.layout().freedoms());
      own.path = sum(bodies_[tree.parent_of(i)].path, own.hinge);
      own.angle = derivative_bounds_beyond_rounding(own.path, scale);
    });
    h_ = step.h, weight_ = chord_excess(step.h);
    for (Bounds& own : bodies_) own.turn(own.angle.first, own.angle.second);
    find_moments(system, step, {T(0), T(0), T(0), T(0)});
    loads_.resize(bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) loads_[i] = bodies_[i].moment;
    add_loops(system, step);
    add_motors(system, step);
  }

  /// Narrows the bound for hinge i: seen from body i. Cost as that of over_step. @pre over_step
  template <class Topology, BaseMotion M>
  void narrow(const System<T, Topology, M>& system, const Step<T>& step, int i) {
    const auto& tree = system.topology();
    const DifferenceScale<T> scale(step.h);
    Quintic<T>& base = bodies_[0].turned;
    base.fill(T(0)); // the hinges from i to the base turn it back
    for (int k = i; k != 0; k = tree.parent_of(k))
      for (int c = 0; c < 6; ++c) base[c] = base[c] - bodies_[k].hinge[c];
    const auto turn = [&](Bounds& own) {
      const DerivativeBounds<T> bounds = derivative_bounds(own.turned, scale);
      own.turn(bounds.first, bounds.second);
    };
    turn(bodies_[0]);
    tree.outward([&](int k) {
      bodies_[k].turned = sum(bodies_[tree.parent_of(k)].turned, bodies_[k].hinge);
      if (k == i) bodies_[k].turned.fill(T(0)); // but for rounding it is
      turn(bodies_[k]);
    });
    find_moments(system, step, bodies_[i].angle);
    loads_[i].bend = smaller(loads_[i].bend, bodies_[i].moment.bend);
  }

  /// Largest excess of |L_i| over the loads at the step's ends, N·m. Between s = a and b: times (b − a)².
  [[nodiscard]] T rise(int i) const { return weight_ * loads_[i].bend; }

  /// The sum of the magnitudes that L_i consists of, at most, N·m: rounding and errors of integration are parts of it.
  [[nodiscard]] T size(int i) const { return loads_[i].size; }

  /// Bounds the excess of the friction that holds hinge i over the larger of its values at two fractions of the step.
  [[nodiscard]] Bulge<T> friction(int i) const {
    Bulge<T> bulge{rise(i), of_motor(i)};
    if (!loops_.empty()) bulge += loops_[i];
    return bulge;
  }
  /// The same over the whole step.
  [[nodiscard]] T most_friction(int i) const { return friction(i).over(T(1)); }

  /// The same between s = a and b. Where a loop may go slack or pass a knot in the step, its bound is that of the
  /// interval a … b.
  [[nodiscard]] Inside<T> friction(int i, const T& a, const T& b) const {
    if (loops_.empty() || loops_[i].is_smooth()) return friction(i)(a, b);
    Inside<T> inside = Bulge<T>{rise(i), of_motor(i)}(a, b);
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
  /// Bounds of a vector and its first two derivatives, seen from f.
  struct Derivatives {
    T value = T(0), first = T(0), second = T(0);
  };

  /// (2)
  struct Turn {
    T rate = T(0), bend = T(0); ///< |δ̇|, |δ̈| + δ̇²

    [[nodiscard]] Derivatives operator()(const Derivatives& v) const {
      return {v.value, fused(rate, v.value, v.first),
              fused(bend, v.value, fused(T(2) * rate, v.first, v.second))};
    }
  };

  struct Moment {
    T size = T(0), bend = T(0); ///< |L|, |d²L/dt²|
  };

  struct HeldLoop {
    const LoopTerms<T>* loop;
    Quintic<T> angle_of_first, angle_of_second;
  };

  struct Bounds {
    Quintic<T> hinge{}, path{}, turned{}; ///< relative angle, θ, δ
    DerivativeBounds<T> angle{};          ///< of θ
    Turn seen;                            ///< of δ
    Derivatives along;                    ///< of z e^{iδ}
    Derivatives acceleration;             ///< of the hinge's point, less a
    Derivatives velocity;                 ///< of the hinge's point, only where there is air
    Derivatives force;                    ///< Y
    Moment moment;                        ///< of L

    void turn(const T& rate, const T& acceleration_) {
      seen = {rate, fused(rate, rate, acceleration_)};
      along = seen({fused(angle.first, angle.first, angle.second),
                    fused(T(2) * angle.first, angle.second, angle.third),
                    fused(T(2), fused(angle.second, angle.second, angle.first * angle.third),
                          angle.fourth)});
    }
    /// Of i θ̇ e^{iδ}.
    [[nodiscard]] Derivatives swing() const {
      return seen({angle.first, angle.second, angle.third});
    }
  };

  [[nodiscard]] static Derivatives added(const Derivatives& a, const T& by, const Derivatives& b) {
    return {fused(by, b.value, a.value), fused(by, b.first, a.first),
            fused(by, b.second, a.second)};
  }
  [[nodiscard]] static Quintic<T> sum(const Quintic<T>& a, const Quintic<T>& b) {
    Quintic<T> c;
    for (int k = 0; k < 6; ++k) c[k] = a[k] + b[k];
    return c;
  }

  /// @param angle of θ_f
  template <class Topology, BaseMotion M>
  void find_moments(const System<T, Topology, M>& system, const Step<T>& step,
                    const DerivativeBounds<T>& angle) {
    const auto& tree = system.topology();
    const Wing<T>& wing = system.wing();
    const Turn axes{angle.first, fused(angle.first, angle.first, angle.second)};
    const bool in_air = !wing.plates.empty();
    Bounds& base = bodies_[0];
    base.acceleration = base.force = {}, base.moment = {};
    if (in_air) base.velocity = axes(velocity_of_base(system, step));
    Derivatives all; // Σ m a_k, less a
    T mass = wing.bodies[0].mass;
    tree.outward([&](int i) {
      const Bounds& parent = bodies_[tree.parent_of(i)];
      Bounds& own = bodies_[i];
      const T arm = wing.bodies[i].arm_length;
      own.acceleration = added(parent.acceleration, arm, parent.along);
      all = added(all, wing.bodies[i].mass,
                  added(own.acceleration, wing.bodies[i].center_length, own.along));
      mass = mass + wing.bodies[i].mass;
      if (in_air) own.velocity = added(parent.velocity, arm, parent.swing());
    });
    const bool alone = M == BaseMotion::free && !in_air;
    const Derivatives felt =
        alone ? added({}, T(1) / mass, all) : axes(acceleration_of_base(system, step));
    tree.outward([&](int i) {
      Bounds& own = bodies_[i];
      const BodyTerms<T>& body = wing.bodies[i];
      const T center = body.center_length;
      const Derivatives a = added(added(own.acceleration, T(1), felt), center, own.along);
      own.force = added({}, body.mass, a);
      own.moment = {T(0), T(0)};
      add_moment(own, body.mass * center, a);
      own.moment.size = fused(body.central_inertia, own.angle.second, own.moment.size);
      own.moment.bend = fused(body.central_inertia, own.angle.fourth, own.moment.bend);
      if (in_air && any(wing.plates[i].strength > T(0))) add_air(wing.plates[i], own);
    });
    tree.inward([&](int i) {
      const Bounds& own = bodies_[i];
      Bounds& parent = bodies_[tree.parent_of(i)];
      parent.force = added(parent.force, T(1), own.force);
      parent.moment.size = parent.moment.size + own.moment.size;
      parent.moment.bend = parent.moment.bend + own.moment.bend;
      add_moment(parent, wing.bodies[i].arm_length, own.force);
    });
  }

  /// Adds the moment of a vector with a lever fixed to the body.
  static void add_moment(Bounds& own, const T& lever, const Derivatives& vector) {
    own.moment.size = fused(lever, vector.value, own.moment.size);
    own.moment.bend = fused(lever, own.seen(vector).second, own.moment.bend);
  }

  /// Adds the force by (3) and its moment about the hinge, whose lever along n is constant.
  static void add_air(const PlateTerms<T>& plate, Bounds& own) {
    const T reach = larger(length(plate.from), length(plate.from + plate.along));
    const Derivatives v = own.seen(added(own.velocity, reach, own.swing()));
    const Derivatives force{v.value * v.value, T(2) * v.value * v.first,
                            T(2) * fused(v.value, v.second, v.first * v.first)};
    own.force = added(own.force, plate.strength, own.seen(force));
    own.moment.size = fused(plate.strength * reach, force.value, own.moment.size);
    own.moment.bend = fused(plate.strength * reach, force.second, own.moment.bend);
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
  void add_motors(const System<T, Topology, M>& system, const Step<T>& step) {
    const std::vector<MotorTerms<T>>& motors = system.wing().motors;
    motors_.assign(motors.size(), T(0));
    for (std::size_t i = 1; i < motors.size(); ++i) {
      const MotorPiece<T>& piece = system.work().motors[i];
      const T change = cubic_bounds(shifted(piece.rate, T(step.t - piece.from)), step.h).first;
      motors_[i] = T(0.5) * step.h * piece.runs * motors[i].gain * change;
    }
  }
  /// Largest excess of a motor's moment on a stuck hinge over that at the step's ends, N·m. Over a part: times the part.
  [[nodiscard]] T of_motor(int i) const { return motors_.empty() ? T(0) : motors_[i]; }

  // ---- the base, in inertial axes

  template <class Topology, BaseMotion M>
  [[nodiscard]] static Quintic<T> path_of_base(const System<T, Topology, M>& system,
                                               const Step<T>& step) {
    if constexpr (M == BaseMotion::free) return step.coordinate(2, system.layout().freedoms());
    if constexpr (M == BaseMotion::prescribed)
      return turn_of_base(system.wing().base, system.work().driven, step.t, step.h);
    return {};
  }

  /// Of the acceleration that its origin feels.
  template <class Topology, BaseMotion M>
  [[nodiscard]] static Derivatives acceleration_of_base(const System<T, Topology, M>& system,
                                                        const Step<T>& step) {
    const BaseTerms<T>& given = system.wing().base;
    Derivatives felt;
    if constexpr (M == BaseMotion::free) {
      const Derivatives v = velocity_of_base(system, step);
      felt = {v.first + length(given.gravity), v.second, T(0)};
      for (const int k : {0, 1}) felt.second = felt.second + bounds_of(system, step, k).fourth;
    }
    if constexpr (M == BaseMotion::prescribed) {
      const CubicBounds<T> push = push_of_base(given, system.work().driven, step.t, step.h);
      felt = {push.value, push.first, push.second};
    }
    if constexpr (M == BaseMotion::fixed) felt.value = length(given.gravity);
    return felt;
  }

  template <class Topology, BaseMotion M>
  [[nodiscard]] static Derivatives velocity_of_base(const System<T, Topology, M>& system,
                                                    const Step<T>& step) {
    Derivatives v;
    if constexpr (M == BaseMotion::free)
      for (const int k : {0, 1}) {
        const DerivativeBounds<T> b = bounds_of(system, step, k);
        v = added(v, T(1), {b.first, b.second, b.third});
      }
    if constexpr (M == BaseMotion::prescribed) {
      const BaseTerms<T>& given = system.wing().base;
      const CubicBounds<T> push = push_of_base(given, system.work().driven, step.t, step.h);
      const T most = push.value + length(given.gravity);
      v = {fused(most, step.h, length(system.base_velocity(step.x, step.t))), most, push.first};
    }
    return v;
  }

  template <class AnySystem>
  [[nodiscard]] static DerivativeBounds<T> bounds_of(const AnySystem& system, const Step<T>& step,
                                                     int k) {
    return derivative_bounds_beyond_rounding(step.coordinate(k, system.layout().freedoms()),
                                             DifferenceScale<T>(step.h));
  }

  std::vector<Bounds> bodies_;  ///< 0 … n
  std::vector<Moment> loads_;   ///< 1 … n
  std::vector<Bulge<T>> loops_; ///< 1 … n: of the loops; empty where there are none
  std::vector<HeldLoop> held_;  ///< the loops on stuck hinges
  std::vector<T> motors_;       ///< 1 … n: of_motor; empty where there are none
  T h_ = T(0), weight_ = T(0);
};

} // namespace wingspread
