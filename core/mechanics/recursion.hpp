/// The O(n) recursion: hinge moments in, accelerations and hinge forces out. Stateless.
///
/// It is Vereshchagin's [Yudintsev, eqs. 3-5] with each hinge's own freedom eliminated beforehand.
/// There a body adds the 3×3 matrix  M* − M* S U⁻¹ Sᵀ M*  and a vector to its parent, which C_iᵀ
/// moves to the parent's centre of mass. Referred to the hinge's own point instead, S = (0; 1), so
/// that row and column of the angle vanish: once its axis moment is known, only a force crosses a
/// revolute hinge. There remains
///
///     f_i = K_i a_i + b_i      the force on body i at its hinge; a_i: that point's acceleration
///
/// with K_i symmetric, 2×2: five numbers a hinge. With axes fixed in inertial space, and for body i
///
/// | symbol  | meaning                                                | shape   | unit            |
/// |---------|--------------------------------------------------------|---------|-----------------|
/// | θ, ω    | absolute angle and rate                                |         | rad, rad/s      |
/// | g       | from the hinge to the centre of mass, −c_ii            | 2       | m               |
/// | l_j     | from the hinge to the child hinge j, c_ij − c_ii       | 2       | m               |
/// | q_j     | e3 × l_j                                               | 2       | m               |
/// | a, α    | acceleration of the hinge's point; angular, ω̇          | 2, 1    | m/s², rad/s²    |
/// | τ_i     | moment of hinge i: +τ on body i, −τ on its parent      |         | N·m             |
/// | A, h, I | the articulated inertia M* about the hinge, in blocks  | 2×2,2,1 | kg, kg·m, kg·m² |
/// | c, d    | force and moment that the motion needs where a = α = 0 | 2, 1    | N, N·m          |
/// | U_i     | of the source, SᵀM*S: the number I here                |         | kg·m²           |
///
/// Newton and Euler about the hinge, the children's forces eliminated by a_j = a + α q_j − ω² l_j:
///
///     f = A a + h α + c                                                                    (1)
///     τ_i − Σ τ_j = I α + hᵀ a + d                                                         (2)
///     A = m E2 + Σ K_j        h = e3 × m g + Σ K_j q_j    I = J + m g² + Σ q_jᵀ K_j q_j    (3)
///     c = −ω² m g + Σ b'_j    d = Σ q_jᵀ b'_j             b'_j = b_j − ω² K_j l_j          (4)
///
/// and α eliminated from (1) by (2), with u = (τ_i − Σ τ_j − d)/I and e = h/I:
///
///     α = u − eᵀ a                                                                         (5)
///     K = A − h eᵀ            b = c + h u                                                  (6)
///
/// A free base is a body whose "hinge" carries no force: K_0 a_0 + b_0 = 0.                 (7)
///
/// About 75 flops, one division and one sine-cosine a body.
#pragma once

#include "core/mechanics/wing.hpp"

#include <type_traits>

namespace wingspread {

/// One body in the passes; axes fixed in inertial space.
template <class T> struct BodyFrame {
  T angle, rate;          ///< θ, ω
  SineCosine<T> rotation; ///< of θ
  T minus_rate_squared;   ///< −ω²
  Vec2<T> mass_moment;    ///< m g
  Vec2<T> arm;            ///< l of this body's hinge, in its parent
  T moment;               ///< τ_i: input of the inward pass
  Sym2<T> stiffness;      ///< K_i, kg
  Vec2<T> bias;           ///< b_i, N
  Vec2<T> coupling;       ///< −e, 1/m
  T free_acceleration;    ///< u, rad/s²
  Vec2<T> acceleration;   ///< a_i, m/s²
  T angular_acceleration; ///< α_i, rad/s²
};

/// Force on body i at its hinge, inertial axes, N. Valid after the outward pass.
template <class T> [[nodiscard]] Vec2<T> hinge_force(const BodyFrame<T>& frame) {
  return fused(frame.stiffness, frame.acceleration, frame.bias);
}

/// Whether body i hangs on a fixed base, so that its hinge's point is at rest.
template <BaseMotion M, class Topology>
[[nodiscard, gnu::always_inline]] inline bool on_fixed_base(const Topology& tree, int i) {
  return M == BaseMotion::fixed && tree.parent_of(i) == 0;
}

/// Absolute angle and rate of body i from its parent's and its own relative ones.
/// Frames: any array of BodyFrame<T>, 0 … n, here as below.
template <BaseMotion M, class T, class Topology, class Frames>
[[gnu::always_inline]] inline void turn(const Topology& tree, Frames& frames, int i,
                                        const T& relative_angle, const T& relative_rate) {
  const BodyFrame<T>& parent = frames[tree.parent_of(i)];
  BodyFrame<T>& own = frames[i];
  const bool first = on_fixed_base<M>(tree, i);
  own.angle = first ? relative_angle : parent.angle + relative_angle;
  own.rate = first ? relative_rate : parent.rate + relative_rate;
  own.minus_rate_squared = -(own.rate * own.rate);
  own.rotation = sine_cosine(own.angle);
}

/// Vectors of body i in inertial axes [Yudintsev, eq. 2], once all have been turned.
template <BaseMotion M, class T, class Topology, class Frames>
[[gnu::always_inline]] inline void place(const Wing<T>& wing, const Topology& tree, Frames& frames,
                                         int i) {
  BodyFrame<T>& own = frames[i];
  own.mass_moment = rotated(own.rotation, wing.bodies[i].mass_moment);
  own.arm = on_fixed_base<M>(tree, i)
                ? wing.bodies[i].arm
                : rotated(frames[tree.parent_of(i)].rotation, wing.bodies[i].arm);
}

/// The inward pass at body i: (3), (4), (6). @pre the pass has been made at its children
template <class T, class Topology, class Frames>
[[gnu::always_inline]] inline void gather(const Wing<T>& wing, const Topology& tree, Frames& frames,
                                          int i) {
  BodyFrame<T>& own = frames[i];
  const T mass = wing.bodies[i].mass;
  Sym2<T> A{mass, T(0), mass};
  Vec2<T> h = turned(own.mass_moment);
  T I = wing.bodies[i].inertia;
  Vec2<T> c = scaled(own.minus_rate_squared, own.mass_moment);
  T load = own.moment; // τ_i − Σ τ_j − d of (2)
  tree.for_each_child(
      i, [&](int j) __attribute__((always_inline)) {
        const BodyFrame<T>& child = frames[j];
        const Sym2<T>& K = child.stiffness;
        const Vec2<T> q = turned(child.arm);
        const Vec2<T> b = fused(own.minus_rate_squared, K * child.arm, child.bias);
        A = A + K; // (3)
        h = h + K * q;
        I = fused(K.xx, q.x * q.x, I) +
            fused(K.yy, q.y * q.y,
                  K.xy * (T(2) * q.x * q.y)); // qᵀ K q, the shortest way from K to I
        c = c + b;                            // (4)
        load = (load - child.moment) - dot(q, b);
      });
  const T minus_inverse = tree.is_leaf(i) ? wing.bodies[i].minus_inverse : T(-1) / I;
  own.coupling = scaled(minus_inverse, h); // −e, then u of (5) and K, b of (6)
  own.free_acceleration = -(load * minus_inverse);
  own.stiffness = {fused(h.x * h.x, minus_inverse, A.xx), fused(h.x * h.y, minus_inverse, A.xy),
                   fused(h.y * h.y, minus_inverse, A.yy)};
  own.bias = fused(own.free_acceleration, h, c);
}

/// The outward pass at body i: (5). @return φ̈_i, rad/s²
template <BaseMotion M, class Topology, class Frames>
[[nodiscard, gnu::always_inline]] inline auto accelerate(const Topology& tree, Frames& frames,
                                                         int i) {
  const auto& parent = frames[tree.parent_of(i)];
  auto& own = frames[i];
  using T = std::decay_t<decltype(own.angle)>;
  if (on_fixed_base<M>(tree, i)) {
    own.acceleration = {T(0), T(0)};
    own.angular_acceleration = own.free_acceleration;
    return own.angular_acceleration;
  }
  const Vec2<T> carried = fused(parent.minus_rate_squared, own.arm, parent.acceleration);
  own.acceleration = fused(parent.angular_acceleration, turned(own.arm), carried);
  own.angular_acceleration = fused_dot(own.coupling, own.acceleration, own.free_acceleration);
  return T(own.angular_acceleration - parent.angular_acceleration);
}

/// Sets a_0 and α_0 of a free base by (7). @pre its inward pass has been made
template <class T> inline void accelerate_free_base(BodyFrame<T>& base) {
  const Sym2<T>& K = base.stiffness;
  const T inverse = T(1) / fused(K.xx, K.yy, -(K.xy * K.xy));
  base.acceleration = {inverse * fused(K.xy, base.bias.y, -(K.yy * base.bias.x)),
                       inverse * fused(K.xy, base.bias.x, -(K.xx * base.bias.y))};
  base.angular_acceleration = fused_dot(base.coupling, base.acceleration, base.free_acceleration);
}

} // namespace wingspread
