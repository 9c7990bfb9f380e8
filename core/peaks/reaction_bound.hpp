/// Bound on the reaction force inside a step, above the larger of the forces at its ends.
///
/// The force on body i at its hinge accelerates everything outward of it. With e_k = (cos θ_k,
/// sin θ_k) and all vectors in their bodies' frames (|.| are constants of the wing),
///
///     Y_i = Σ m_j r̈_j = μ_i r̈ of hinge i + Σ σ_k × ë_k over k = i and outward of it            (1)
///     r̈ of hinge i = r̈ of the base + Σ l_c × ë_p over the hinges c from the base to i, p: parent
///
/// | symbol | meaning                                                              | unit |
/// |--------|----------------------------------------------------------------------|------|
/// | μ_i    | mass of body i and of all outward of it                              | kg   |
/// | l_c    | from the parent's hinge to hinge c                                   | m    |
/// | σ_k    | first moment about hinge k: its body, and μ_c at each hinge c on it  | kg·m |
///
/// A function exceeds its chord by at most C = chord_excess(h) of its largest fourth derivative in the dense
/// output (core/number/derivative_bounds.hpp), and a chord is nowhere longer than at one of its ends. So
///
///     |Y_i| ≤ larger |Y_i| at an end + C (μ_i A_i + B_i)                                       (2)
///     A_i = A_p + |l_i| W_p        B_i = |σ_i| W_i + Σ B_j over the children                   (3)
///     W_k ≥ |d⁴e_k/dt⁴| = |i θ⁽⁴⁾ − 4 θ̇ θ⃛ − 3 θ̈² − 6 i θ̇² θ̈ + θ̇⁴|                              (4)
///
/// with the derivatives of θ_k bounded by the Bernstein coefficients of the step's quintics. The forces at the ends
/// are the method's own.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/system.hpp"
#include "core/number/derivative_bounds.hpp"

#include <vector>

namespace wingspread {

/// Constants of a body and its hinge in (2) and (3).
template <class T> struct Lever {
  T mass;        ///< μ
  T arm;         ///< |l|
  Vec2<T> sigma; ///< own frame
  T moment;      ///< |σ|
};

/// @param levers 0 … n
template <class T, class Topology>
void set_levers(const Wing<T>& wing, const Topology& tree, std::vector<Lever<T>>& levers) {
  using std::sqrt;
  levers.assign(tree.bodies() + 1, {T(0), T(0), {T(0), T(0)}, T(0)});
  tree.inward([&](int i) {
    const BodyTerms<T>& body = wing.bodies[i];
    Lever<T>&own = levers[i], &parents = levers[tree.parent_of(i)];
    own.mass = own.mass + body.mass;
    own.sigma = own.sigma + body.mass_moment;
    own.arm = sqrt(dot(body.arm, body.arm));
    own.moment = sqrt(dot(own.sigma, own.sigma));
    parents.mass = parents.mass + own.mass;
    parents.sigma = fused(own.mass, body.arm, parents.sigma);
  });
}

template <class T> class ReactionBound {
public:
  void resize(int bodies) {
    paths_.resize(bodies + 1);
    A_.assign(bodies + 1, T(0)), W_.assign(bodies + 1, T(0));
    B_.assign(bodies + 1, T(0));
  }

  /// Cost O(n), less than an evaluation.
  template <class Topology, BaseMotion M>
  void over_step(const System<T, Topology, M>& system, const std::vector<Lever<T>>& levers,
                 const Step<T>& step) {
    const auto& tree = system.topology();
    const Layout& at = system.layout();
    const Scale scale(step.h);
    start_at_base(system, step, scale);
    tree.outward([&](int i) __attribute__((always_inline)) {
      const int p = tree.parent_of(i);
      const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
      for (int k = 0; k < 6; ++k) paths_[i][k] = paths_[p][k] + angle[k];
      W_[i] = of_turning(paths_[i], scale);
      A_[i] = fused(levers[i].arm, W_[p], A_[p]);
      B_[i] = T(0);
    });
    const T weight = chord_excess(step.h);
    tree.inward([&](int i) __attribute__((always_inline)) {
      const int p = tree.parent_of(i);
      B_[i] = fused(levers[i].moment, W_[i], B_[i]);
      B_[p] = B_[p] + B_[i];
      W_[i] = weight * fused(levers[i].mass, A_[i], B_[i]);
    });
  }

  /// Largest excess of |Y_i| over the forces at the step's ends, N. Over a part of the step: times the part's
  /// square.
  [[nodiscard]] const T& rise(int i) const { return W_[i]; }

private:
  using Scale = DifferenceScale<T>;

  /// A and W of the base, and its angle.
  template <class Topology, BaseMotion M>
  void start_at_base(const System<T, Topology, M>& system, const Step<T>& step,
                     const Scale& scale) {
    paths_[0].fill(T(0));
    A_[0] = W_[0] = B_[0] = T(0);
    if constexpr (M == BaseMotion::free) {
      const int n = system.layout().freedoms();
      for (const int k : {0, 1})
        A_[0] = A_[0] + derivative_bounds(step.coordinate(k, n), scale).fourth;
      paths_[0] = step.coordinate(2, n);
      W_[0] = of_turning(paths_[0], scale);
    }
    if constexpr (M == BaseMotion::prescribed) { // without a table the origin's r̈ is constant
      const BaseTerms<T>& base = system.wing().base;
      if (base.table) A_[0] = push_of_base(base, system.work().driven, step.t, step.h).second;
      paths_[0] = turn_of_base(base, system.work().driven, step.t, step.h);
      W_[0] = of_turning(paths_[0], scale);
    }
  }

  [[nodiscard, gnu::always_inline]] static inline T of_turning(const Quintic<T>& angle,
                                                               const Scale& scale) {
    return fourth_of_direction(derivative_bounds(angle, scale));
  }

  std::vector<Quintic<T>> paths_; ///< θ over the step, 0 … n
  std::vector<T> A_, W_, B_;      ///< of (3) and (4); after over_step, W_ holds the excess
};

} // namespace wingspread
