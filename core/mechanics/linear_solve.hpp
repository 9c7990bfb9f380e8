/// Linear solves with a wing's mass matrix M, by the recursion itself: O(n), no matrix.
///
///     (M + E) q̈ = τ,    E diagonal over the hinges                                             (1)
///
/// A hinge that sticks does not move. Whoever solves owns the storage.
#pragma once

#include "core/mechanics/system.hpp"

namespace wingspread {

/// Damping and stiffness of a hinge in the linear model: what can make the equations stiff.
template <class T> struct Resistance {
  T damping;   ///< N·m·s/rad, ≥ 0
  T stiffness; ///< N·m/rad, ≥ 0
};

/// Those of hinge i at x.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] Resistance<T> resistance(const System<T, Topology, M>& system, const State<T>& x,
                                       int i) {
  const Layout& at = system.layout();
  const LinearLaw<T>& law = system.work().laws[i];
  const HingeTerms<T>& hinge = system.wing().hinges[i];
  Resistance<T> r{law.damping, larger(law.stiffness, T(0))};
  if (hinge.regularized_friction > T(0))
    r.damping = r.damping + regularized_friction_damping(hinge, x[at.rate(i)]);
  if (at.smoothed && hinge.has_latch) {
    const T weight = smooth_step(x[at.latch(i)] / system.epsilon());
    r.damping = fused(weight, hinge.damping, r.damping);
    r.stiffness = fused(weight, hinge.stiffness, r.stiffness);
  }
  return r;
}

template <class T> class LinearSolve {
public:
  /// Factorizes M + E at (x, t) for the added inertias of the hinges, E(i). Cost O(n), about half
  /// an evaluation.
  template <class Topology, BaseMotion M, class AddedInertia>
  void factorize(const System<T, Topology, M>& system, const State<T>& x, const T& t,
                 AddedInertia&& added) {
    factorize_with(system, x, t, [&](int i) {
      return HingeConstraint<T>{added(i), system.sticks(i)};
    });
  }

  /// Factorizes M at (x, t) as if no hinge stuck: for what is to hold once any of them slips.
  template <class Topology, BaseMotion M>
  void factorize_unlocked(const System<T, Topology, M>& system, const State<T>& x, const T& t) {
    factorize_with(system, x, t, [](int) { return HingeConstraint<T>{}; });
  }

  /// Solves (1) with the last factorization: τ(i) of the hinges, none on a free base.
  /// @param qdd freedoms() numbers: those of a free base first
  template <class Topology, BaseMotion M, class Moment>
  void solve(const System<T, Topology, M>& system, Moment&& tau, T* qdd) {
    load_all<false, M>(system.topology(), parts_, tau);
    if constexpr (M == BaseMotion::free) {
      const AugmentedFrame<T>& base = parts_.bodies[0];
      qdd[0] = base.acceleration.x, qdd[1] = base.acceleration.y;
      qdd[2] = base.angular_acceleration;
    }
    system.topology().outward([&](int i) {
      qdd[base_freedoms<M> + i - 1] =
          accelerate_augmented<false>(system.topology(), parts_.frames, parts_.bodies, i);
    });
  }

  /// Where the bodies were at the last factorization, 0 … n.
  [[nodiscard]] const std::vector<BodyFrame<T>>& frames() const { return parts_.frames; }

private:
  /// @param constraint constraint(i) of hinge i
  template <class Topology, BaseMotion M, class Constraint>
  void factorize_with(const System<T, Topology, M>& system, const State<T>& x, const T& t,
                      Constraint&& constraint) {
    if (static_cast<int>(parts_.frames.size()) != system.layout().bodies + 1)
      parts_.resize(system.layout().bodies);
    place_base<M>(system.wing(), system.layout(), parts_.frames[0], x, t);
    place_bodies<M>(system.wing(), system.topology(), parts_.frames, x);
    factorize_all<M>(system.wing(), system.topology(), parts_, constraint);
  }

  Augmented<T> parts_;
};

} // namespace wingspread
