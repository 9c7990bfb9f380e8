/// The O(n) recursion for hinges that are locked or carry an inertia of their own.
///
/// A hinge with an added inertia E has the moment τ − E φ̈. A locked hinge has the moment that keeps φ̈ = 0, the
/// limit E → ∞. Its axis moment then depends on the parent's rotation, so that a
/// moment crosses the hinge as well as a force, and the source's 3×3 form [Yudintsev, eqs. 3-5] is
/// needed, here referred to the hinge's point as in recursion.hpp, whose symbols and equation
/// numbers (1)-(7) these continue:
///
/// | symbol  | meaning                                                   | shape   | unit        |
/// |---------|-----------------------------------------------------------|---------|-------------|
/// | E       | inertia added to the hinge's own freedom                  |         | kg·m²       |
/// | U       | I + E, the source's SᵀM*S; 1/U = 0 for a locked hinge     |         | kg·m²       |
/// | α_p     | angular acceleration of the parent                        |         | rad/s²      |
/// | n       | axis moment on body i: f, n cross the hinge               |         | N·m         |
///
///     φ̈ = u − eᵀ a − g α_p         u = (τ − d)/U     e = h/U         g = I/U               (8)
///     f = K a + H α_p + b          K = A − h eᵀ      H = (1 − g) h   b = c + h u           (9)
///     n = Hᵀ a + N α_p + m         N = (1 − g) I     m = d + I u                          (10)
///
/// with, in place of (3) and (4), for the children j of a body
///
///     h += K q + H     I += qᵀ K q + 2 qᵀ H + N                                           (11)
///     c += b'          d += qᵀ b' + m − ω² Hᵀ l         b' = b − ω² K l                   (12)
///
/// E = 0 gives g = 1, H = 0, N = 0, m = τ: the equations of recursion.hpp.
///
/// (8), (9), (11) depend on the configuration alone and make the factorization; (10), (12) are the
/// load. So one factorization serves many loads: the stages of a Rosenbrock step.
#pragma once

#include "core/mechanics/recursion.hpp"

#include <vector>

namespace wingspread {

/// One body in the passes, beside its BodyFrame.
template <class T> struct AugmentedFrame {
  // factorization
  Sym2<T> K; ///< kg
  Vec2<T> H; ///< kg·m
  T N;       ///< kg·m²
  Vec2<T> h; ///< kg·m
  T I;       ///< kg·m²
  Vec2<T> e; ///< 1/m
  T g;       ///< 1
  T inverse; ///< 1/U, 0 when locked, 1/(kg·m²)
  // load
  Vec2<T> b; ///< N
  T m;       ///< N·m
  T u;       ///< rad/s²
  // outcome
  Vec2<T> acceleration;   ///< a of the hinge's point, m/s²
  T angular_acceleration; ///< α, rad/s²
};

/// A hinge in the augmented recursion.
template <class T> struct HingeConstraint {
  T added_inertia = T(0); ///< E, kg·m²
  Truth<T> locked = T(0) < T(0);
};

/// Storage of the recursion: all bodies of a wing.
template <class T> struct Augmented {
  std::vector<BodyFrame<T>> frames;      ///< 0 … n
  std::vector<AugmentedFrame<T>> bodies; ///< 0 … n

  void resize(int n) {
    frames.assign(n + 1, BodyFrame<T>{});
    bodies.assign(n + 1, AugmentedFrame<T>{});
  }
};

/// (8), (9), (11) at body i; 0 is a free base. @pre made at its children; the frames are placed
template <class T, class Topology, class Frames, class Augmented>
void factorize(const Wing<T>& wing, const Topology& tree, const Frames& frames, Augmented& bodies,
               int i, const HingeConstraint<T>& hinge) {
  AugmentedFrame<T>& own = bodies[i];
  const T mass = wing.bodies[i].mass;
  Sym2<T> A{mass, T(0), mass};
  own.h = turned(frames[i].mass_moment);
  own.I = wing.bodies[i].inertia;
  tree.for_each_child(i, [&](int j) {
    const AugmentedFrame<T>& child = bodies[j];
    const Vec2<T> q = turned(frames[j].arm), Kq = child.K * q;
    A = A + child.K;
    own.h = own.h + Kq + child.H;
    own.I = own.I + dot(q, Kq) + T(2) * dot(q, child.H) + child.N;
  });
  own.inverse = select(hinge.locked, T(0), T(T(1) / (own.I + hinge.added_inertia)));
  own.e = scaled(own.inverse, own.h);
  own.g = own.I * own.inverse;
  const T rest = select(hinge.locked, T(1), T(hinge.added_inertia * own.inverse)); // 1 − g
  own.K = {fused(-own.h.x, own.e.x, A.xx), fused(-own.h.x, own.e.y, A.xy),
           fused(-own.h.y, own.e.y, A.yy)};
  own.H = scaled(rest, own.h);
  own.N = rest * own.I;
}

/// (10), (12) at body i for a hinge moment τ. @pre made at its children
/// With `moving`, includes the loads of the bodies' rates; without, of τ alone, as in solving (M + E) φ̈ = τ.
template <bool moving, class T, class Topology, class Frames, class Augmented>
void load(const Topology& tree, const Frames& frames, Augmented& bodies, int i, const T& tau) {
  AugmentedFrame<T>& own = bodies[i];
  const T& spin = frames[i].minus_rate_squared;
  Vec2<T> c = moving ? scaled(spin, frames[i].mass_moment) : Vec2<T>{T(0), T(0)};
  T d(0);
  tree.for_each_child(i, [&](int j) {
    const AugmentedFrame<T>& child = bodies[j];
    const Vec2<T>& l = frames[j].arm;
    const Vec2<T> b = moving ? fused(spin, child.K * l, child.b) : child.b;
    c = c + b;
    d = d + dot(turned(l), b) + child.m;
    if (moving) d = fused(spin, dot(child.H, l), d);
  });
  own.u = (tau - d) * own.inverse;
  own.b = fused(own.u, own.h, c);
  own.m = fused(own.I, own.u, d);
}

/// Sets a_0 and α_0 of a free base by (7). @pre its load was made with τ = 0 and E = 0
template <class T> void accelerate_free_base(AugmentedFrame<T>& base) {
  const Sym2<T>& K = base.K;
  const T inverse = T(1) / fused(K.xx, K.yy, -(K.xy * K.xy));
  base.acceleration = {inverse * fused(K.xy, base.b.y, -(K.yy * base.b.x)),
                       inverse * fused(K.xy, base.b.x, -(K.xx * base.b.y))};
  base.angular_acceleration = base.u - dot(base.e, base.acceleration);
}

/// (8) at body i. @pre made at its parent. @return φ̈_i, rad/s²
template <bool moving, class T, class Topology, class Frames>
T accelerate_augmented(const Topology& tree, const Frames& frames,
                       std::vector<AugmentedFrame<T>>& bodies, int i) {
  const int p = tree.parent_of(i);
  const AugmentedFrame<T>& parent = bodies[p];
  AugmentedFrame<T>& own = bodies[i];
  const Vec2<T>& l = frames[i].arm;
  own.acceleration = fused(parent.angular_acceleration, turned(l), parent.acceleration);
  if (moving) own.acceleration = fused(frames[p].minus_rate_squared, l, own.acceleration);
  const T relative = own.u - dot(own.e, own.acceleration) - own.g * parent.angular_acceleration;
  own.angular_acceleration = parent.angular_acceleration + relative;
  return relative;
}

/// The force on body i at its hinge by (9), N. @pre the outward pass has been made
template <class T>
[[nodiscard]] Vec2<T> augmented_force(const AugmentedFrame<T>& own, const T& parents_acceleration) {
  return fused(own.K, own.acceleration, fused(parents_acceleration, own.H, own.b));
}

/// The axis moment on body i by (10), N·m: of a locked hinge, the moment that holds it.
template <class T>
[[nodiscard]] T axis_moment(const AugmentedFrame<T>& own, const T& parents_acceleration) {
  return dot(own.H, own.acceleration) + fused(own.N, parents_acceleration, own.m);
}

// ---- passes over a whole wing. @pre its frames have been placed

/// (8), (9), (11). @param hinge hinge(i) → HingeConstraint<T>
template <BaseMotion M, class T, class Topology, class Constraint>
void factorize_all(const Wing<T>& wing, const Topology& tree, Augmented<T>& parts,
                   Constraint&& hinge) {
  tree.inward([&](int i) { factorize(wing, tree, parts.frames, parts.bodies, i, hinge(i)); });
  if constexpr (M == BaseMotion::free)
    factorize(wing, tree, parts.frames, parts.bodies, 0, HingeConstraint<T>{});
}

/// (10), (12) at all bodies, then the base's accelerations: a free base by (7); another base from its frame with
/// `moving`, else 0.
/// @param tau tau(i) of hinge i, N·m; tau(0) on a free base, asked only with `moving`
/// @param pull external force taken off a free base's, N
template <bool moving, BaseMotion M, class T, class Topology, class Moment>
void load_all(const Topology& tree, Augmented<T>& parts, Moment&& tau,
              const Vec2<T>& pull = {T(0), T(0)}) {
  tree.inward([&](int i) { load<moving>(tree, parts.frames, parts.bodies, i, T(tau(i))); });
  AugmentedFrame<T>& base = parts.bodies[0];
  if constexpr (M == BaseMotion::free) {
    load<moving>(tree, parts.frames, parts.bodies, 0, moving ? T(tau(0)) : T(0));
    base.b = base.b - pull;
    accelerate_free_base(base);
  } else {
    base.acceleration = moving ? parts.frames[0].acceleration : Vec2<T>{T(0), T(0)};
    base.angular_acceleration = moving ? parts.frames[0].angular_acceleration : T(0);
  }
}

} // namespace wingspread
