/// The O(n) recursion for (M + E) q̈ = τ: hinges may be locked or carry an inertia E of their own; all rates are 0.
///
/// A hinge with an added inertia E has the moment τ − E φ̈. A locked hinge is the limit E → ∞, for which locked.hpp has
/// the equations of motion. The axis moment then depends on the parent's rotation, so a moment crosses the hinge as
/// well as a force. The source's 3×3 form [Yudintsev, eqs. 3-5; reference: recursion.hpp] is needed; here it is referred
/// to the hinge's point. Symbols continue those of recursion.hpp:
///
/// | symbol  | meaning                                                   | shape   | unit        |
/// |---------|-----------------------------------------------------------|---------|-------------|
/// | E       | inertia added to the hinge's own freedom                  |         | kg·m²       |
/// | U       | I + E, the source's SᵀM*S; 1/U = 0 for a locked hinge     |         | kg·m²       |
/// | α_p     | angular acceleration of the parent                        |         | rad/s²      |
/// | n       | axis moment on body i: f, n cross the hinge               |         | N·m         |
///
///     φ̈ = u − eᵀ a − g α_p         u = (τ − d)/U     e = h/U         g = I/U               (11)
///     f = K a + H α_p + b          K = A − h eᵀ      H = (1 − g) h   b = c + h u           (12)
///     n = Hᵀ a + N α_p + m         N = (1 − g) I     m = d + I u                          (13)
///
/// with sums over the children j of a body, at rates 0,
///
///     h += K q + H     I += qᵀ K q + 2 qᵀ H + N                                           (14)
///     c += b           d += qᵀ b + m                                                      (15)
///
/// (11), (12) and (14) depend on the configuration alone and make the factorization; (13) and (15) are the
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
  // result of the outward pass
  Vec2<T> acceleration;   ///< a of the hinge's point, m/s²
  T angular_acceleration; ///< α, rad/s²
};

/// A hinge in the augmented recursion.
template <class T> struct HingeConstraint {
  T added_inertia = T(0); ///< E, kg·m²
  bool locked = false;
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

/// (11), (12), (14) at body i; 0 is a free base. @pre made at its children; the frames are placed
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
  own.inverse = hinge.locked ? T(0) : T(1) / (own.I + hinge.added_inertia);
  own.e = scaled(own.inverse, own.h);
  own.g = own.I * own.inverse;
  const T one_less_g = hinge.locked ? T(1) : hinge.added_inertia * own.inverse;
  own.K = {fused(-own.h.x, own.e.x, A.xx), fused(-own.h.x, own.e.y, A.xy),
           fused(-own.h.y, own.e.y, A.yy)};
  own.H = scaled(one_less_g, own.h);
  own.N = one_less_g * own.I;
}

/// (13), (15) at body i for a hinge moment τ. @pre made at its children
template <class T, class Topology, class Frames, class Augmented>
void load(const Topology& tree, const Frames& frames, Augmented& bodies, int i, const T& tau) {
  AugmentedFrame<T>& own = bodies[i];
  Vec2<T> c{T(0), T(0)};
  T d(0);
  tree.for_each_child(i, [&](int j) {
    const AugmentedFrame<T>& child = bodies[j];
    c = c + child.b;
    d = d + dot(turned(frames[j].arm), child.b) + child.m;
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

/// (11) at body i. @pre made at its parent. @return φ̈_i, rad/s²
template <class T, class Topology, class Frames>
T accelerate_augmented(const Topology& tree, const Frames& frames,
                       std::vector<AugmentedFrame<T>>& bodies, int i) {
  const AugmentedFrame<T>& parent = bodies[tree.parent_of(i)];
  AugmentedFrame<T>& own = bodies[i];
  own.acceleration = fused(parent.angular_acceleration, turned(frames[i].arm), parent.acceleration);
  const T relative = own.u - dot(own.e, own.acceleration) - own.g * parent.angular_acceleration;
  own.angular_acceleration = parent.angular_acceleration + relative;
  return relative;
}

// ---- passes over a whole wing. @pre its frames have been placed

/// (11), (12), (14). @param hinge hinge(i) → HingeConstraint<T>
template <BaseMotion M, class T, class Topology, class Constraint>
void factorize_all(const Wing<T>& wing, const Topology& tree, Augmented<T>& parts,
                   Constraint&& hinge) {
  tree.inward([&](int i) { factorize(wing, tree, parts.frames, parts.bodies, i, hinge(i)); });
  if constexpr (M == BaseMotion::free)
    factorize(wing, tree, parts.frames, parts.bodies, 0, HingeConstraint<T>{});
}

/// (13), (15) at all bodies, then the accelerations of a free base by (7); another base has none.
/// @param tau tau(i) of hinge i, N·m
template <BaseMotion M, class T, class Topology, class Moment>
void load_all(const Topology& tree, Augmented<T>& parts, Moment&& tau) {
  tree.inward([&](int i) { load(tree, parts.frames, parts.bodies, i, T(tau(i))); });
  AugmentedFrame<T>& base = parts.bodies[0];
  base.acceleration = {T(0), T(0)}, base.angular_acceleration = T(0);
  if constexpr (M == BaseMotion::free) {
    load(tree, parts.frames, parts.bodies, 0, T(0));
    accelerate_free_base(base);
  }
}

} // namespace wingspread
