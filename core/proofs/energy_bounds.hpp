/// Bounds on every later moment and force of each hinge, from the energy alone.
///
/// | symbol    | meaning                                                     | unit           | source               |
/// |-----------|-------------------------------------------------------------|----------------|----------------------|
/// | E, T      | energy that is never exceeded; kinetic energy ≤ E           | J              | remaining_energy.hpp |
/// | E', r     | part of E that may move hinges; turning of a free base      | J, rad/s       | remaining_energy.hpp (3) |
/// | κ, δ, g   | stiffness, damping, what the load exerts on a hinge         | N·m/rad, …     | remaining_energy.hpp |
/// | τ_s       | the largest friction                                        | N·m            | scene                |
/// | J, m      | central inertia, mass of a body                             | kg·m², kg      | scene                |
/// | φ̇, ω      | rate of a hinge, of a body                                  | rad/s          |                      |
/// | M, Y      | moment and reaction of a hinge                              | N·m, N         | (3), (4)             |
/// | L         | largest net moment of its hinges on a body                  | N·m            | (3)                  |
/// | γ         | centripetal acceleration of a mass                          | m/s²           |                      |
///
/// From T ≥ ½ Σ J ω² alone, by Cauchy and Schwarz, where on a free base that turns E' stands for E, and ω − r for ω,
///
///     φ̇_i² ≤ 2 T σ_i,    σ_i = 1/J_i + 1/J_p  (1/J_p = 0 on a fixed base)                      (2)
///     |M_i| ≤ g_i + √(2E) √(κ_i + δ_i² σ_i) + τ_s                                              (3)
///
/// For the reaction, Gauss's principle: the true accelerations minimise Σ m r̈² + Σ J (ω̇ − L/J)²
/// over those that the hinges allow. Compared with φ̈ = 0, for which r̈ = γ,
///
///     Σ m r̈² ≤ Z := Σ m γ² + Σ L²/J,    |Y_i| ≤ √(m outward of i) √Z                           (4)
///
/// The air's force F on a body and its moment about the centre count as γ − F/m and in L: the reactions are those of
/// r̈ − F/m. No point of a plate is faster than V, by the rates along its path, so that with B of core/laws/air.hpp
///
///     |F| ≤ B V²                                                                                (6)
///
/// The axis moment of a hinge that is held is a moment of the constraint. It turns all that is outward of the hinge:
/// with λ_k the way from the hinge to the centre of body k, sums over the bodies outward, and Σ J (ω̇ − L/J)² ≤ Z too,
///
///     |M_i| ≤ Σ m λ |r̈| + Σ J |ω̇| ≤ (√(Σ m λ²) + √(Σ J)) √Z + Σ |L|                             (5)
///
/// A body that only held hinges tie to a base that is fixed or driven does not move as seen from the base: ω = 0, and
/// its hinges' moments accelerate nothing.
///
/// √(2E/J) bounds |ω|; on a free base √(2E'/J) + |r| does too. These bound γ along each path, and (3) bounds L. On a
/// base that is driven, positions and velocities are as seen from the base, and γ − f replaces γ, f the apparent force
/// of apparent_load.hpp.
#pragma once

#include "core/proofs/remaining_energy.hpp"

namespace wingspread {

template <class T> class EnergyBounds {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>; ///< 0 … n, as the bodies are numbered
  Numbers moment;                                      ///< 1 … n, N·m
  Numbers force;                                       ///< 1 … n, N

  /// Sums the masses up. Cost O(n).
  template <class AnySystem> void prepare(const AnySystem& system) {
    const Wing<T>& wing = system.wing();
    for (Numbers* v : {&moment, &force, &outward_mass_}) v->setZero(wing.size() + 1);
    for (int i = wing.size(); i >= 1; --i) {
      outward_mass_(i) = outward_mass_(i) + wing.bodies[i].mass;
      T& parents = outward_mass_(system.topology().parent_of(i));
      parents = parents + outward_mass_(i);
    }
  }

  /// Finds (3) and (4) of every hinge, and (5) of held ones. Cost O(n), and for each held hinge O(n)
  /// times the tree's depth. @pre prepared
  /// @param remaining prepared, and `left` is what it returned
  template <class AnySystem>
  void bound(const AnySystem& system, const RemainingEnergy<T>& remaining,
             const EnergyLeft<T>& left) {
    using std::sqrt;
    bound_moments(system, remaining, left.within);
    T Z = centripetal(system, remaining.load(), left);
    for (int i = first_body<AnySystem>; i < net_.size(); ++i)
      if (!is_still(system, i)) Z = Z + net_(i) * net_(i) / system.wing().bodies[i].central_inertia;
    for (int i = 1; i < net_.size(); ++i) force(i) = sqrt(outward_mass_(i) * Z);
    for (int i = 1; !system.wing().releases.empty() && i < net_.size(); ++i)
      if (system.is_held(i)) bound_held(system, T(sqrt(Z)), i);
  }

  /// Whether the load on the engaged latch of hinge i stays below its holding moment: latch_laws.hpp (2), with the
  /// largest deflection and rate. @pre bound
  template <class AnySystem>
  [[nodiscard]] bool keeps_latched(const AnySystem& system, const RemainingEnergy<T>& remaining,
                                   const T& energy, int i) const {
    const CaptureTerms<T>& latch = system.wing().real[i].capture;
    if (!latch.may_let_go()) return true;
    const T &rest = remaining.rest()[system.layout().angle(i)], way = remaining.furthest(i, energy);
    return latch.most_excess({rest - way, rest + way}, {T(-rate_(i)), T(rate_(i))}) < T(0);
  }

private:
  /// The first body that moves.
  template <class AnySystem>
  static constexpr int first_body = AnySystem::base_motion == BaseMotion::free ? 0 : 1;

  /// Whether body i does not move as seen from the base.
  template <class AnySystem> [[nodiscard]] static bool is_still(const AnySystem& system, int i) {
    if (AnySystem::base_motion == BaseMotion::free || system.wing().releases.empty()) return false;
    for (; i != 0; i = system.topology().parent_of(i))
      if (!system.is_held(i)) return false;
    return true;
  }

  /// Finds (5) for hinge i, which is held; on a base that is fixed, what does not move loads no hinge. @param root √Z
  template <class AnySystem> void bound_held(const AnySystem& system, const T& root, int i) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    const auto length = [](const Vec2<T>& v) { return T(sqrt(dot(v, v))); };
    T levers(0), inertias(0), loads(0);
    bool rests = AnySystem::base_motion == BaseMotion::fixed;
    for (int k = 1; k <= wing.size(); ++k) {
      T lambda = length(wing.bodies[k].center);
      int outward = k;
      for (; outward != i && outward != 0; outward = system.topology().parent_of(outward))
        lambda = lambda + length(wing.bodies[outward].arm);
      if (outward == 0) continue;
      levers = fused(wing.bodies[k].mass, lambda * lambda, levers);
      inertias = inertias + wing.bodies[k].central_inertia;
      loads = loads + net_(k);
      rests = rests && is_still(system, k);
    }
    moment(i) = rests ? T(0) : T((sqrt(levers) + sqrt(inertias)) * root + loads);
    if (rests) force(i) = T(0);
  }

  /// Finds (3) and L.
  template <class AnySystem>
  void bound_moments(const AnySystem& system, const RemainingEnergy<T>& remaining,
                     const T& energy) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    net_.setZero(moment.size()), rate_.setZero(moment.size());
    for (int i = 1; i < moment.size(); ++i) {
      const int p = system.topology().parent_of(i);
      if (system.is_held(i)) {
        moment(i) = T(0);
        continue;
      }
      const T& damping = remaining.damping(i);
      T sigma = T(1) / wing.bodies[i].central_inertia;
      if (p >= first_body<AnySystem>) sigma = sigma + T(1) / wing.bodies[p].central_inertia;
      rate_(i) = sqrt(T(2) * energy * sigma);
      moment(i) = sqrt(T(2) * energy * fused(damping * damping, sigma, remaining.stiffness(i))) +
                  wing.hinges[i].most_friction() + remaining.steady(i);
    }
    if (wing.is_real()) add_real(system, remaining, energy);
    for (int i = 1; i < moment.size(); ++i) {
      const int p = system.topology().parent_of(i);
      net_(i) = net_(i) + moment(i);
      net_(p) = net_(p) + moment(i);
    }
  }

  /// Adds the largest moments of dampers, motors and loops at the largest rates, and of dissipating latches at the
  /// largest rate and deflection. The energy of a loop bounds its torque, with a slack strand too: (K e)² ≤ 2 K E.
  template <class AnySystem>
  void add_real(const AnySystem& system, const RemainingEnergy<T>& remaining, const T& energy) {
    using std::abs, std::sqrt;
    const Wing<T>& wing = system.wing();
    for (int i = 1; i < static_cast<int>(wing.real.size()); ++i) {
      const RealHingeTerms<T>& real = wing.real[i];
      if (system.is_held(i)) continue;
      if (real.has_damper) moment(i) = moment(i) + most_of_damper(real.damper, T(rate_(i)));
      if (!real.dissipation.present) continue;
      const T at_rest = remaining.rest()[system.layout().angle(i)] - real.dissipation.latched;
      const T deflection = T(abs(at_rest)) + remaining.furthest(i, energy);
      moment(i) = moment(i) + real.dissipation.strength * deflection * rate_(i);
    }
    for (int i = 1; i < static_cast<int>(wing.motors.size()); ++i)
      moment(i) = moment(i) + most_braking(wing.motors[i], system.work().motors[i], T(rate_(i)));
    for (const LoopTerms<T>& loop : wing.loops) {
      const T gear = largest_gear(loop);
      const T torque = sqrt(T(2) * loop.stiffness * energy) +
                       loop.damping * fused(gear, T(rate_(loop.first)), T(rate_(loop.second)));
      moment(loop.first) = moment(loop.first) + gear * torque;
      moment(loop.second) = moment(loop.second) + torque;
    }
  }

  /// Σ m γ² of (4).
  template <class AnySystem>
  [[nodiscard]] T centripetal(const AnySystem& system, const ApparentLoad<T>& load,
                              const EnergyLeft<T>& left) {
    using std::sqrt;
    const Wing<T>& wing = system.wing();
    const auto length = [](const Vec2<T>& v) { return T(sqrt(dot(v, v))); };
    const auto spin = [&](int i) { // bounds ω_i²
      if (i < first_body<AnySystem> || is_still(system, i)) return T(0);
      const T square = T(2) * left.within / wing.bodies[i].central_inertia;
      if (!(left.whirl > T(0))) return square;
      const T rate = left.whirl + sqrt(square);
      return smaller(T(rate * rate), T(T(2) * left.whole / wing.bodies[i].central_inertia));
    };
    T sum(0);
    gamma_.setZero(net_.size()), speed_.setZero(net_.size());
    for (int i = 1; i < gamma_.size(); ++i) {
      const int p = system.topology().parent_of(i);
      gamma_(i) = gamma_(p) + spin(p) * length(wing.bodies[i].arm);
      T gamma = gamma_(i) + spin(i) * length(wing.bodies[i].center);
      speed_(i) = speed_(p) + sqrt(spin(p)) * length(wing.bodies[i].arm);
      if (!wing.plates.empty()) { // (6)
        const PlateTerms<T>& plate = wing.plates[i];
        const Vec2<T>&from = plate.from, to = from + plate.along, &center = wing.bodies[i].center;
        const T fastest = speed_(i) + sqrt(spin(i)) * larger(length(from), length(to));
        const T drag = plate.strength * fastest * fastest;
        gamma = gamma + drag / wing.bodies[i].mass;
        net_(i) = net_(i) + drag * larger(length(from - center), length(to - center));
      }
      if constexpr (AnySystem::base_motion == BaseMotion::prescribed) {
        const T speed = speed_(i) + sqrt(spin(i)) * length(wing.bodies[i].center);
        gamma = gamma + load.specific(i) + T(2) * load.spin() * speed;
      }
      sum = fused(wing.bodies[i].mass, gamma * gamma, sum);
    }
    return sum;
  }

  Numbers outward_mass_; ///< of body i and all that hangs on it, kg
  Numbers net_;          ///< L
  Numbers rate_;         ///< bounds |φ̇|, rad/s
  Numbers gamma_;        ///< γ of the hinge point, m/s²
  Numbers speed_;        ///< of the hinge point, as seen from the base, m/s
};

} // namespace wingspread
