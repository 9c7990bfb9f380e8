/// The O(n) recursion while exact friction locks some hinges. Symbols and equations: recursion.hpp, (1)-(7).
///
/// A locked hinge keeps φ̈ = 0: two bodies move as one. Its axis moment depends on the parent's rotation, so
/// that a moment n crosses the hinge as well as a force,
///
///     f = K a + H α_p + b          K = A    H = h    b = c                                 (8)
///     n = Hᵀ a + N α_p + m         N = I    m = d                                          (9)
///
/// and a parent gathers, besides (3) and (4), from its children j
///
///     h += H          I += 2 qᵀ H + N          d += m − ω² Hᵀ l                           (10)
///
/// A free hinge has H = 0, N = 0 and m = τ, with which (8)-(10) are the equations of recursion.hpp. The same
/// expressions serve both, and a free hinge's numbers have the bits of `gather` and `accelerate`. So lanes with and
/// without locked hinges can share a pack.
#pragma once

#include "core/mechanics/recursion.hpp"

namespace wingspread {

/// The moment that crosses a locked hinge beside the force of (6): n = Hᵀ a + N α_p + m.
template <class T> struct Crossing {
  Vec2<T> H; ///< kg·m
  T N;       ///< kg·m²
  T m;       ///< N·m
};

/// The inward pass at body i; 0 is a free base. @pre the pass has been made at its children
/// @param locked whether hinge i is; for a pack: in which lanes
template <class T, class Topology, class Frames>
void gather_with_locks(const Wing<T>& wing, const Topology& tree, Frames& frames,
                       std::vector<Crossing<T>>& crossings, int i, const Truth<T>& locked) {
  BodyFrame<T>& own = frames[i];
  const T mass = wing.bodies[i].mass;
  Sym2<T> A{mass, T(0), mass};
  Vec2<T> h = turned(own.mass_moment);
  T I = wing.bodies[i].inertia;
  Vec2<T> c = scaled(own.minus_rate_squared, own.mass_moment);
  T load = select(locked, T(0), own.moment); // τ_i − d, or −d
  tree.for_each_child(i, [&](int j) {
    const BodyFrame<T>& child = frames[j];
    const Crossing<T>& crossing = crossings[j];
    const Sym2<T>& K = child.stiffness;
    const Vec2<T> q = turned(child.arm);
    const Vec2<T> b = fused(own.minus_rate_squared, K * child.arm, child.bias);
    A = A + K;
    h = h + K * q + crossing.H;
    I = fused(K.xx, q.x * q.x, I) + fused(K.yy, q.y * q.y, K.xy * (T(2) * q.x * q.y));
    I = I + fused(T(2), dot(q, crossing.H), crossing.N);
    c = c + b;
    load = (load - crossing.m) - dot(q, b);
    load = fused(T(-own.minus_rate_squared), dot(crossing.H, child.arm), load);
  });
  const T free_inverse = tree.is_leaf(i) ? wing.bodies[i].minus_inverse : T(-1) / I;
  const T minus_inverse = select(locked, T(0), free_inverse);
  own.coupling = scaled(minus_inverse, h);
  own.free_acceleration = -(load * minus_inverse);
  own.stiffness = {fused(h.x * h.x, minus_inverse, A.xx), fused(h.x * h.y, minus_inverse, A.xy),
                   fused(h.y * h.y, minus_inverse, A.yy)};
  own.bias = fused(own.free_acceleration, h, c);
  crossings[i] = {{select(locked, h.x, T(0)), select(locked, h.y, T(0))},
                  select(locked, I, T(0)),
                  select(locked, T(-load), own.moment)};
}

/// The outward pass at body i. @return φ̈_i, rad/s²: 0 of a locked hinge
template <BaseMotion M, class T, class Topology, class Frames>
[[nodiscard]] T accelerate_with_locks(const Topology& tree, Frames& frames, int i,
                                      const Truth<T>& locked) {
  const T relative = accelerate<M>(tree, frames, i);
  T& own = frames[i].angular_acceleration;
  own = select(locked, frames[tree.parent_of(i)].angular_acceleration, own);
  return select(locked, T(0), relative);
}

/// (8): the force on body i at its hinge, inertial axes, N. @pre the outward pass has been made
template <class T>
[[nodiscard]] Vec2<T> hinge_force(const BodyFrame<T>& own, const Crossing<T>& crossing,
                                  const T& parents_acceleration) {
  return hinge_force(own) + scaled(parents_acceleration, crossing.H);
}

/// (9): the axis moment on body i, N·m; of a locked hinge, the moment that holds it.
template <class T>
[[nodiscard]] T axis_moment(const BodyFrame<T>& own, const Crossing<T>& crossing,
                            const T& parents_acceleration) {
  return dot(crossing.H, own.acceleration) + fused(crossing.N, parents_acceleration, crossing.m);
}

/// The axis moments of all hinges less the air's, 1 … n, N·m. @param air 1 … n, or empty where there is none
template <class T, class Topology, class Frames>
void find_axis_moments(const Topology& tree, const Frames& frames,
                       const std::vector<Crossing<T>>& crossings, const std::vector<T>& air,
                       std::vector<T>& moments) {
  for (int i = 1; i <= tree.bodies(); ++i) {
    const T& parents = frames[tree.parent_of(i)].angular_acceleration;
    moments[i] = axis_moment(frames[i], crossings[i], parents);
    if (!air.empty()) moments[i] = moments[i] - air[i];
  }
}

} // namespace wingspread
