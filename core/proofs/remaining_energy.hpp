/// The energy that is left to a wing of which no hinge will latch any more.
///
/// | symbol | meaning                                                                 | unit    |
/// |--------|-------------------------------------------------------------------------|---------|
/// | u_i    | way of hinge i off its rest y* = drive/κ, with a restoring spring       | rad     |
/// | κ_i    | its stiffness (an engaged latch is a restoring spring)                  | N·m/rad |
/// | G_j    | the most that a hinge can give that cannot reach its latch: stall.hpp   | J       |
/// | T, V   | kinetic energy; potential of the apparent load: apparent_load.hpp       | J       |
/// | g, a, Ω | of the apparent load: apparent_load.hpp (3)                           |         |
///
///     E = T + Σ ½ κ_i u_i² + Σ G_j + V − V(rest)                                               (1)
///
/// never grows on a base that is fixed or free. (For a free base T is taken about the common centre
/// of mass: its energy is constant.) A hinge that cannot reach its latch goes no further than E takes
/// it.
///
/// A free base that turns keeps its angular momentum H. I is the inertia of all bodies about the common centre. The
/// motion is a rigid turning at r = H/I and a motion relative to it: T = T' + ½H²/I. As I ≤ I_max, the hinges get at
/// most
///
///     E' = E − ½H²/I_max,     I_max = Σ_(k<l) m_k m_l d_kl²/m + Σ J_k,     |r| ≤ 2E/|H|              (3)
///
/// d_kl is the length of the path along the bodies between the centres of k and l. E' stands for E below.
///
/// On a driven base T is taken as seen from the base, and by (3) of apparent_load.hpp
///
///     T + Σ ½ κ_i (|u_i| − g_i/κ_i)² ≤ Ē = E + Σ g_i²/2κ_i                                     (2)
///     T + Σ ½ κ_i u_i² ≤ E + Σ g_i |u_i|,      |u_i| ≤ g_i/κ_i + √(2Ē/κ_i)                     (4)
///
/// On a base that turns and has a linear acceleration, this acceleration turns as seen from the base and may drive a mode:
/// there is no bound. On one that has an angular acceleration alone, E may grow: `energy_so_far` returns it, and (11) of
/// modal_bounds.hpp bounds it.
///
/// The moment of a hinge then stays within g_i + √(2Ē) √(κ_i + δ_i² σ_i) + τ_s, σ_i as in
/// energy_bounds.hpp. For a hinge without rest κ is 0, and g the most that its spring exerts on its
/// way.
///
/// A real hinge with an engaged latch has a potential P with a second derivative between κ and κ⁺, by
/// the steepest slopes of its curves. Off its rest, P' = 0, the potential grows by at least ½ κ u²,
/// and the moment is at most κ⁺ |u|: in (2) it has the stiffness κ⁺²/κ. A loop adds its own energy,
/// never negative. Backlash, and a stop within reach, are beyond this proof. Where the curves are somewhere steeper than
/// the latch is stiff, κ and κ⁺ are those of |φ − φ_latched| ≤ r. They hold for ever if the hinge is in there and the
/// energy does not take it out: |y* − φ_latched| + g/κ + √(2E/κ) < r.
///
/// Air at rest takes energy from a wing on a base that stands still; on a base that moves it may add some: no bound.
///
/// A hinge whose rigid hold never lets go does not move: it has no part in any sum.
///
/// A motor under a constant command is a constant drive, which counts in y*, and a part that takes energy: motor.hpp
/// (2). While its command changes, and at an open hinge, a motor may bring energy in: there is no bound.
#pragma once

#include "core/proofs/apparent_load.hpp"
#include "core/proofs/largest_inertia.hpp"
#include "core/proofs/stall.hpp"

#include <limits>
#include <optional>

namespace wingspread {

/// Bounds from the energy that is left.
template <class T> struct EnergyLeft {
  T whole;    ///< E, or Ē of (2), J
  T within;   ///< E' of (3), what the hinges may get, J; on a base that is not free E or Ē
  T whirl{0}; ///< largest |r| of a free base, rad/s
  /// Bounds T + Σ ½ κ u² of hinges that all have a rest, J: E, or the bound of (4).
  T elastic{whole};
};

template <class T> class RemainingEnergy {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>; ///< 0 … n, as the bodies are numbered

  /// Computes the terms that depend on the wing alone. Cost O(n) times the tree's depth; on a free base O(n²) times it.
  /// @pre no hinge will latch any more, and no motor's command will change
  template <class AnySystem> void prepare(const AnySystem& system) {
    const int n = system.layout().bodies;
    for (Numbers* v : {&stiffness_, &damping_, &steady_, &least_stiffness_, &at_rest_})
      v->setZero(n + 1);
    window_.setConstant(n + 1, T(std::numeric_limits<double>::infinity()));
    bounded_ = load_.prepare(system) && !load_.turns() &&
               (system.wing().plates.empty() || stands_still(system.wing().base));
    offset_ = T(0);
    if (system.base_motion == BaseMotion::free) largest_inertia_ = largest_inertia<T>(system);
    rest_.assign(system.layout().size(), T(0));
    for (int i = 1; i <= n; ++i) prepare(system, i);
    elastic_ = bounded_;
    for (int i = 1; i <= n; ++i) elastic_ = elastic_ && least_stiffness_(i) > T(0);
  }

  /// Bounds the energy from the state x at t on, by (1), (2) and (4). Cost O(n).
  /// @return none without a bound: where the base's motion is not steady, its acceleration turns as seen from it, air
  ///         meets a moving base, a spring drives its hinge away from rest, an open hinge has a motor or stands beside
  ///         real hinges, a latch has backlash or is smoothed and not yet full, or a hinge may touch a stop or leave its
  ///         window
  template <class AnySystem>
  [[nodiscard]] std::optional<EnergyLeft<T>> energy(AnySystem& system, const State<T>& x,
                                                    const T& t) {
    if (!bounded_ || load_.quickens()) return std::nullopt;
    const Layout& at = system.layout();
    const std::optional<T> springs = springs_energy(system, x);
    if (!springs) return std::nullopt;
    const EnergyLeft<T> left = with_motion(system, x, t, *springs);
    if (!keeps_laws(system, x, left.within)) return std::nullopt;
    for (int i = 1; i <= at.bodies; ++i)
      if (is_open(system, i) && !find_way(system, x[at.angle(i)], left.within, i))
        return std::nullopt;
    return left;
  }

  /// E on a base with an angular acceleration and no linear one, seen from the base. It may grow from there. Cost O(n).
  /// @return none on another base, where there is no bound for other reasons, or where a hinge has no rest
  template <class AnySystem>
  [[nodiscard]] std::optional<T> energy_so_far(AnySystem& system, const State<T>& x,
                                               const T& t) const {
    if (!elastic_ || !load_.quickens()) return std::nullopt;
    const std::optional<T> springs = springs_energy(system, x);
    if (!springs) return std::nullopt;
    return *springs + seen_from_base(system, x, t);
  }
  /// Whether no hinge may touch a stop or leave the window of its κ while T + Σ ½ κ u² stays below this energy, J.
  template <class AnySystem>
  [[nodiscard]] bool keeps_laws(const AnySystem& system, const State<T>& x, const T& energy) const {
    return !may_touch_stop(system, energy) && !may_leave_window(system, x, energy);
  }

  [[nodiscard]] const State<T>& rest() const { return rest_; }            ///< y* of every hinge
  [[nodiscard]] const T& stiffness(int i) const { return stiffness_(i); } ///< κ
  [[nodiscard]] const T& damping(int i) const { return damping_(i); }     ///< δ
  [[nodiscard]] const T& steady(int i) const { return steady_(i); }       ///< g
  /// κ of every hinge, the first at [0], such that `elastic`, or on a base with an angular acceleration the energy, is at
  /// least T + ½ Σ κ (φ − rest)²; null where there are none.
  [[nodiscard]] const T* least_stiffness() const {
    return elastic_ ? least_stiffness_.data() + 1 : nullptr;
  }
  /// How far hinge i may stand off its rest, rad. @param energy `within` of what `energy` returned, J
  [[nodiscard]] T furthest(int i, const T& energy) const {
    using std::sqrt;
    const T& kappa = least_stiffness_(i);
    if (!(kappa > T(0))) return T(std::numeric_limits<double>::infinity());
    return load_.moment(i) / kappa + sqrt(T(2) * energy / kappa);
  }
  [[nodiscard]] const ApparentLoad<T>& load() const { return load_; }

private:
  /// Whether the base has no motion of its own. A fixed base under gravity is treated as one that accelerates.
  [[nodiscard]] static bool stands_still(const BaseTerms<T>& base) {
    const Vec2<T>& a = base.acceleration;
    return base.motion != BaseMotion::free && !base.table && a.x == T(0) && a.y == T(0) &&
           base.angular_acceleration == T(0) && base.rate == T(0);
  }
  /// Whether hinge i has a latch that it cannot reach.
  template <class AnySystem> [[nodiscard]] static bool is_open(const AnySystem& system, int i) {
    return system.wing().hinges[i].has_latch && !system.work().engaged[i] && !system.is_held(i);
  }

  template <class AnySystem> void prepare(const AnySystem& system, int i) {
    using std::sqrt;
    if (system.is_held(i)) { // it does not move, and gives nothing
      rest_[system.layout().angle(i)] = system.wing().hinges[i].stowed;
      return;
    }
    const bool open = is_open(system, i);
    const LinearLaw<T> law = with_motor(system, linear_law(system.wing().hinges[i], !open), i);
    const bool loaded = load_.moment(i) > T(0);
    if (open && system.motor_runs(i)) bounded_ = false;
    damping_(i) = law.damping;
    if (!system.wing().real.empty()) return prepare_real(system, i, law, open);
    if (open || !(law.stiffness > T(0))) {
      // no restoring torque and no load: contributes nothing
      const bool limp = law.stiffness == T(0) && law.drive == T(0) && !loaded;
      bounded_ = bounded_ && (limp || (open && !loaded));
      return;
    }
    stiffness_(i) = law.stiffness;
    rest_[system.layout().angle(i)] = law.latched + law.drive / law.stiffness;
    add_load(i, law.stiffness);
  }

  /// The law with the constant drive of the hinge's motor.
  template <class AnySystem>
  [[nodiscard]] static LinearLaw<T> with_motor(const AnySystem& system, LinearLaw<T> law, int i) {
    law.drive = law.drive + system.drive_of_motor(i);
    return law;
  }

  /// Adds the load's moment on hinge i. @param kappa its stiffness
  void add_load(int i, const T& kappa) {
    using std::sqrt;
    const T& g = load_.moment(i);
    steady_(i) = g, least_stiffness_(i) = kappa;
    offset_ = offset_ + g * g / (T(2) * kappa);
  }

  template <class AnySystem>
  void prepare_real(const AnySystem& system, int i, const LinearLaw<T>& law, bool open) {
    const RealHingeTerms<T>& real = system.wing().real[i];
    const ValueRange<T> slopes = slopes_about_rest(system, i, law.stiffness);
    const T least = law.stiffness + slopes.low, most = law.stiffness + slopes.high;
    if (open || real.has_backlash || !(least > T(0))) {
      bounded_ = false;
      return;
    }
    stiffness_(i) = most * (most / least);
    const int k = system.layout().angle(i);
    rest_[k] = law.latched;
    for (int pass = 0; pass < 100;
         ++pass) { // Newton's method, by the steepest slope: it never passes P' = 0
      const T moment = linear_moment(law, rest_[k], T(0)) + curves_moment(real, rest_[k]);
      const T next = rest_[k] + moment / most;
      if (next == rest_[k]) break;
      rest_[k] = next;
    }
    at_rest_(i) = latched_potential(system, rest_, i);
    add_load(i, least);
  }

  /// The range of the curves' stiffness over all angles, or over the window |φ − φ_latched| ≤ r, r = window_(i), outside of
  /// which the curves are too steep for the latch.
  template <class AnySystem>
  [[nodiscard]] ValueRange<T> slopes_about_rest(const AnySystem& system, int i,
                                                const T& stiffness) {
    using std::abs;
    const RealHingeTerms<T>& real = system.wing().real[i];
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    ValueRange<T> slopes = stiffness_of_curves(real);
    if (stiffness + slopes.low > T(0)) return slopes;
    // Heuristics: the largest of r = travel/2^k within which half the stiffness is left.
    constexpr int most_halvings = 20;
    T r = abs(hinge.latched - hinge.stowed);
    for (int k = 0; k < most_halvings && !(stiffness + T(2) * slopes.low > T(0)); ++k) {
      r = T(0.5) * r;
      slopes = stiffness_of_curves(real, ValueRange<T>{hinge.latched - r, hinge.latched + r});
    }
    window_(i) = r;
    return slopes;
  }

  /// Whether a hinge with a window is outside of it, or could be with this energy.
  template <class AnySystem>
  [[nodiscard]] bool may_leave_window(const AnySystem& system, const State<T>& x,
                                      const T& available) const {
    using std::abs;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!is_finite(window_(i))) continue;
      const int k = system.layout().angle(i);
      const T& latched = system.wing().hinges[i].latched;
      const T most = abs(rest_[k] - latched) + furthest(i, available);
      if (!(abs(x[k] - latched) <= window_(i)) || !(most < window_(i))) return true;
    }
    return false;
  }

  /// The potential of a real hinge whose latch, if it has one, has engaged, with the drive of its motor, J. Without stops:
  /// the hinge may touch one now, at an angle from which its rest is far.
  template <class AnySystem>
  [[nodiscard]] static T latched_potential(const AnySystem& system, const State<T>& x, int i) {
    const T& angle = x[system.layout().angle(i)];
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    const T springs = potential(linear_law(hinge, false), angle) +
                      real_potential(system.wing().real[i], hinge.latched, angle, HingeMode<T>{});
    return (springs + (system.latch_energy(x, i) + smoothed_latch_energy(system, x, i))) -
           system.drive_of_motor(i) * (angle - hinge.latched);
  }

  /// Whether a hinge touches a stop, or could with this energy.
  template <class AnySystem>
  [[nodiscard]] bool may_touch_stop(const AnySystem& system, const T& available) const {
    for (int i = 1; i < static_cast<int>(system.wing().real.size()); ++i) {
      const RealHingeTerms<T>& real = system.wing().real[i];
      const HingeMode<T>& mode = system.work().modes[i];
      if (system.is_held(i)) continue;
      if (mode.in_contact != T(0) || mode.in_far_contact != T(0)) return true;
      for (const StopTerms<T>* stop : {&real.stop, &real.far_stop}) {
        // below 0 if the spring's rest lies beyond the stop: then the hinge rests on the stop
        const T way = stop->sense * (rest_[system.layout().angle(i)] - stop->contact_angle);
        if (stop->present && !(furthest(i, available) < way)) return true;
      }
    }
    return false;
  }

  /// The part of hinge i in (1), J; none where it has no bound.
  template <class AnySystem>
  [[nodiscard]] std::optional<T> part_of(const AnySystem& system, const State<T>& x, int i) const {
    const Layout& at = system.layout();
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    if (system.is_held(i)) return T(0);
    if (is_open(system, i)) {
      const T given = detail::most_given(hinge, false, x[at.angle(i)]);
      return is_finite(given) ? std::optional(given) : std::nullopt;
    }
    if (at.smoothed && hinge.has_latch && !(x[at.latch(i)] >= system.epsilon()))
      return std::nullopt; // its smoothed latch does not act fully yet
    if (!(stiffness_(i) > T(0))) return T(0);
    if (!system.wing().real.empty()) {
      using std::abs;
      const T P = latched_potential(system, x, i);
      // heuristic, for the rounding of P: too small a share could prove what is false by 1e-14 of P
      return (P - at_rest_(i)) + T(256 * epsilon_of<T>) * (abs(P) + abs(at_rest_(i)));
    }
    const LinearLaw<T> law = with_motor(system, linear_law(hinge, true), i);
    const T u = x[at.angle(i)] - law.latched - law.drive / law.stiffness;
    return T(0.5) * law.stiffness * u * u;
  }

  /// The parts of all hinges and loops in (1), J; none where a hinge's has no bound.
  template <class AnySystem>
  [[nodiscard]] std::optional<T> springs_energy(const AnySystem& system, const State<T>& x) const {
    T sum(0);
    for (int i = 1; i <= system.layout().bodies; ++i) {
      const std::optional<T> own = part_of(system, x, i);
      if (!own) return std::nullopt;
      sum = sum + *own;
    }
    return sum + loops_energy(system, x);
  }

  static constexpr double lost_by_rounding = 64 * epsilon_of<T>; ///< of differences and sums

  /// T + V − V(rest) as seen from a driven base, J.
  template <class AnySystem>
  [[nodiscard]] T seen_from_base(AnySystem& system, const State<T>& x, const T& t) const {
    const auto [now, size] = ApparentLoad<T>::energy(system, x, t);
    const auto [at_rest, size_at_rest] = ApparentLoad<T>::energy(system, rest_, t);
    return (now - at_rest) + T(lost_by_rounding) * (size + size_at_rest);
  }

  template <class AnySystem>
  [[nodiscard]] EnergyLeft<T> with_motion(AnySystem& system, const State<T>& x, const T& t,
                                          const T& springs) const {
    using std::sqrt;
    if constexpr (AnySystem::base_motion == BaseMotion::prescribed) {
      const T sum = springs + seen_from_base(system, x, t);
      const T bar = larger(T(sum + offset_), T(0));
      T elastic = sum;
      for (int i = 1; elastic_ && i <= system.layout().bodies; ++i)
        elastic = elastic + load_.moment(i) * furthest(i, bar);
      return {bar, bar, T(0), larger(elastic, T(0))};
    } else {
      using std::abs;
      const TotalMotion<T> now = total_motion(system, x, t);
      const bool is_free = AnySystem::base_motion == BaseMotion::free;
      const T own = is_free ? now.central_kinetic() : now.kinetic;
      const T whole = springs + own + T(lost_by_rounding) * now.kinetic;
      const T spin = is_free ? T(abs(now.spin())) : T(0);
      if (!(spin > T(0))) return {whole, whole};
      constexpr double rounded_down = 1 - 1e-9; // far more than the sums lose
      const T turning = T(rounded_down) * spin * spin / (T(2) * largest_inertia_);
      return {whole, larger(T(whole - turning), T(0)), T(2) * whole / spin};
    }
  }

  /// Finds how far hinge i, which cannot reach its latch, goes either way with this energy, and keeps
  /// the most that its spring exerts there as g. @return whether its way has an end
  template <class AnySystem>
  [[nodiscard]] bool find_way(const AnySystem& system, const T& angle, const T& available, int i) {
    using std::abs;
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    const LinearLaw<T> law = linear_law(hinge, false);
    const T y = hinge.sense * (angle - hinge.latched); // < 0 before the latch
    const T pull = hinge.sense * law.drive - law.stiffness * y;
    const std::optional<T> back = way(T(hinge.kinetic_friction + pull), law.stiffness, available),
                           ahead = way(T(hinge.kinetic_friction - pull), law.stiffness, available);
    if (!back) return false;
    const T most = ahead ? smaller(*ahead, T(-y)) : T(-y);
    steady_(i) = larger(T(abs(fused(law.stiffness, *back, pull))),
                        T(abs(fused(-law.stiffness, most, pull))));
    return true;
  }

  /// The way z > 0 with push z + ½ κ z² = available. None if there is none.
  [[nodiscard]] static std::optional<T> way(const T& push, const T& kappa, const T& available) {
    using std::sqrt;
    const T square = fused(push, push, T(2) * kappa * available);
    if (!(square > T(0))) return std::nullopt;
    const T both = push + sqrt(square);
    if (!(both > T(0))) return std::nullopt;
    return T(2) * available / both;
  }

  ApparentLoad<T> load_;
  bool bounded_ = false;
  bool elastic_ = false; ///< there is a bound, and every hinge has a rest
  Numbers stiffness_, damping_, steady_;
  Numbers least_stiffness_; ///< κ
  Numbers at_rest_;         ///< P(y*) of a real hinge
  Numbers window_;          ///< r within which κ holds, rad; infinite: everywhere
  State<T> rest_;
  T offset_{};           ///< Σ g²/2κ, J
  T largest_inertia_{1}; ///< I_max of a free base
};

} // namespace wingspread
