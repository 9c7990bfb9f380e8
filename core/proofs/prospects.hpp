/// What may still come of a wing of which no hinge will latch any more, by its energy.
///
/// A hinge with a restoring spring (an engaged latch is one) has its rest at y* = drive/κ, from
/// which it stands u = y − y* off. One whose latch it cannot reach (stall.hpp) gives at most G, and
/// goes no further than what is left takes it. So, with V of apparent_load.hpp on a base that
/// is driven,
///
///     E = T + Σ ½ κ_i u_i² + Σ G_j + V − V(rest)                                               (1)
///
/// never grows on a base that is fixed or free (for a free one T is taken about the common centre
/// of mass, whose energy is constant). On one that is driven T is taken as seen from it, and by (3)
/// there,
///
///     T + Σ ½ κ_i (|u_i| − g_i/κ_i)² ≤ Ē = E + Σ g_i²/2κ_i                                     (2)
///
/// which grows by (4) there no faster than p + q √Ē, so that in a time Δ it comes at most to
///
///     (√(Ē + p Δ) + q Δ/2)²       p = |a Ω| Σ s_i g_i/κ_i       q = |a Ω| Σ s_i √(2/κ_i)      (3)
///
/// The moment of a hinge is then within g_i + √(2Ē) √(κ_i + δ_i² σ_i) + τ_s, σ_i as in
/// coarse_bounds.hpp; for a hinge without rest κ is 0, and g the most that its spring exerts on its
/// way.
///
/// A real hinge with an engaged latch has a potential P whose second derivative lies between κ and
/// κ⁺, by the steepest slopes of its curves. With its rest at P' = 0, ½ κ u² is P(y) − P(y*) at
/// least, and its moment κ⁺ |u| at most: for (2) it has the stiffness κ⁺²/κ. A loop adds its own
/// energy, never negative. Backlash, and a stop within reach, are beyond this proof.
#pragma once

#include "core/proofs/apparent_load.hpp"
#include "core/proofs/stall.hpp"

#include <limits>
#include <optional>

namespace wingspread {

template <class T> class Prospects {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>; ///< 0 … n, as the bodies are numbered

  /// No hinge will latch any more. Cost O(n) times the tree's depth.
  template <class AnySystem> void prepare(const AnySystem& system) {
    const int n = system.layout().bodies;
    for (Numbers* v : {&stiffness_, &damping_, &steady_, &least_stiffness_, &at_rest_})
      v->setZero(n + 1);
    bounded_ = load_.prepare(system) && system.wing().plates.empty();
    rests_ = system.wing().loops.empty(), offset_ = p_ = q_ = T(0);
    rest_.assign(system.layout().size(), T(0));
    for (int i = 1; i <= n; ++i) prepare(system, i);
    elastic_ = bounded_ && system.base_motion != BaseMotion::prescribed;
    for (int i = 1; i <= n; ++i) elastic_ = elastic_ && least_stiffness_(i) > T(0);
  }

  /// What no energy from now on to t_end exceeds: (1), Ē of (2), or (3). None where that has no
  /// bound: a base that turns faster and faster, or a spring that drives its hinge away from where
  /// it could rest. Cost O(n).
  template <class AnySystem>
  [[nodiscard]] std::optional<T> energy(AnySystem& system, const State<T>& x, const T& t,
                                        const T& t_end) {
    if (!bounded_) return std::nullopt;
    const Layout& at = system.layout();
    T sum(0);
    for (int i = 1; i <= at.bodies; ++i) {
      const std::optional<T> own = energy(system, x, i);
      if (!own) return std::nullopt;
      sum = sum + *own;
    }
    sum = with_motion(system, x, t, t_end, T(sum + loops_energy(system, x)));
    if (may_touch_stop(system, sum)) return std::nullopt;
    for (int i = 1; i <= at.bodies; ++i)
      if (is_open(system, i) && !find_way(system, x[at.angle(i)], sum, i)) return std::nullopt;
    return sum;
  }

  /// Whether every hinge has a rest, off which the wing may be linearized.
  [[nodiscard]] bool rests() const { return rests_; }
  [[nodiscard]] const State<T>& rest() const { return rest_; }            ///< that state
  [[nodiscard]] const T& stiffness(int i) const { return stiffness_(i); } ///< κ
  [[nodiscard]] const T& damping(int i) const { return damping_(i); }     ///< δ
  [[nodiscard]] const T& steady(int i) const { return steady_(i); }       ///< g
  /// κ such that the energy is at least T + ½ Σ κ (φ − rest)² over the hinges, the first at [0]; null
  /// where it is not.
  [[nodiscard]] const T* least_stiffness() const {
    return elastic_ ? least_stiffness_.data() + 1 : nullptr;
  }
  /// How far hinge i may stand off its rest with an energy that `energy` told, rad.
  [[nodiscard]] T furthest(int i, const T& energy) const {
    using std::sqrt;
    const T& kappa = least_stiffness_(i);
    if (!(kappa > T(0))) return T(std::numeric_limits<double>::infinity());
    return load_.moment(i) / kappa + sqrt(T(2) * energy / kappa);
  }
  [[nodiscard]] const ApparentLoad<T>& load() const { return load_; }

private:
  /// Whether hinge i has a latch that it cannot reach.
  template <class AnySystem> [[nodiscard]] static bool is_open(const AnySystem& system, int i) {
    return system.wing().hinges[i].has_latch && !system.work().engaged[i];
  }

  template <class AnySystem> void prepare(const AnySystem& system, int i) {
    using std::sqrt;
    const bool open = is_open(system, i);
    const LinearLaw<T> law = linear_law(system.wing().hinges[i], !open);
    const bool loaded = load_.moment(i) > T(0);
    damping_(i) = law.damping;
    if (!system.wing().real.empty()) return prepare_real(system, i, law, open);
    if (open || !(law.stiffness > T(0))) {
      rests_ = false;
      // without any spring it has no rest, and takes no part either
      const bool limp = law.stiffness == T(0) && law.drive == T(0) && !loaded;
      bounded_ = bounded_ && (limp || (open && !loaded));
      return;
    }
    stiffness_(i) = law.stiffness;
    rest_[system.layout().angle(i)] = law.latched + law.drive / law.stiffness;
    add_load(i, law.stiffness);
  }

  /// What the load does to hinge i. @param kappa its stiffness
  void add_load(int i, const T& kappa) {
    using std::sqrt;
    const T& g = load_.moment(i);
    steady_(i) = g, least_stiffness_(i) = kappa;
    offset_ = offset_ + g * g / (T(2) * kappa);
    p_ = fused(load_.drift() * load_.lever(i), g / kappa, p_);
    q_ = fused(load_.drift() * load_.lever(i), T(sqrt(T(2) / kappa)), q_);
  }

  template <class AnySystem>
  void prepare_real(const AnySystem& system, int i, const LinearLaw<T>& law, bool open) {
    const RealHingeTerms<T>& real = system.wing().real[i];
    const ValueRange<T> slopes = stiffness_of_curves(real);
    const T least = law.stiffness + slopes.low, most = law.stiffness + slopes.high;
    rests_ = false; // as far as linear models are concerned
    if (open || real.has_backlash || !(least > T(0))) {
      bounded_ = false;
      return;
    }
    stiffness_(i) = most * (most / least);
    const int k = system.layout().angle(i);
    rest_[k] = law.latched;
    for (int pass = 0; pass < 100; ++pass) { // Newton's way, never longer than to where P' = 0
      const T moment = linear_moment(law, rest_[k], T(0)) + curves_moment(real, rest_[k]);
      const T next = rest_[k] + moment / most;
      if (next == rest_[k]) break;
      rest_[k] = next;
    }
    at_rest_(i) = latched_potential(system, rest_, i);
    add_load(i, least);
  }

  /// Of a real hinge whose latch, if it has one, is in.
  template <class AnySystem>
  [[nodiscard]] static T latched_potential(const AnySystem& system, const State<T>& x, int i) {
    return hinge_potential(system, x, i) + smoothed_latch_energy(system, x, i);
  }

  /// Whether this energy takes a hinge to its stop, or one is there.
  template <class AnySystem>
  [[nodiscard]] bool may_touch_stop(const AnySystem& system, const T& available) const {
    using std::abs;
    for (int i = 1; i < static_cast<int>(system.wing().real.size()); ++i) {
      const RealHingeTerms<T>& real = system.wing().real[i];
      if (!real.stop.present) continue;
      const T way = abs(rest_[system.layout().angle(i)] - real.stop.contact_angle);
      if (system.work().modes[i].in_contact != T(0) || !(furthest(i, available) < way)) return true;
    }
    return false;
  }

  /// What hinge i adds to (1); none where that is not known.
  template <class AnySystem>
  [[nodiscard]] std::optional<T> energy(const AnySystem& system, const State<T>& x, int i) const {
    const Layout& at = system.layout();
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    if (is_open(system, i)) {
      const T given = detail::most_given(hinge, false, x[at.angle(i)]);
      return is_finite(given) ? std::optional(given) : std::nullopt;
    }
    if (at.smoothed && hinge.has_latch && !(x[at.latch(i)] >= system.epsilon()))
      return std::nullopt; // its latch is still coming in
    if (!(stiffness_(i) > T(0))) return T(0);
    if (!system.wing().real.empty()) {
      using std::abs;
      const T P = latched_potential(system, x, i);
      return (P - at_rest_(i)) + T(256 * epsilon_of<T>) * (abs(P) + abs(at_rest_(i)));
    }
    const LinearLaw<T> law = linear_law(hinge, true);
    const T u = x[at.angle(i)] - law.latched - law.drive / law.stiffness;
    return T(0.5) * law.stiffness * u * u;
  }

  template <class AnySystem>
  [[nodiscard]] T with_motion(AnySystem& system, const State<T>& x, const T& t, const T& t_end,
                              const T& springs) const {
    using std::sqrt;
    constexpr double lost = 64 * epsilon_of<T>; // by taking differences
    if constexpr (AnySystem::base_motion == BaseMotion::prescribed) {
      const auto [now, size] = ApparentLoad<T>::energy(system, x, t);
      const auto [at_rest, size_at_rest] = ApparentLoad<T>::energy(system, rest_, t);
      const T ahead = t_end - t, bar = springs + (now - at_rest) + T(lost) * (size + size_at_rest);
      const T root =
          fused(T(0.5) * q_, ahead, T(sqrt(larger(T(bar + fused(p_, ahead, offset_)), T(0)))));
      return root * root;
    } else {
      const TotalMotion<T> now = total_motion(system, x, t);
      const T own =
          AnySystem::base_motion == BaseMotion::free ? now.central_kinetic() : now.kinetic;
      return springs + own + T(lost) * now.kinetic;
    }
  }

  /// How far hinge i, which cannot reach its latch, goes either way with this energy, and the most
  /// that its spring exerts there. @return whether it goes so far only
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

  /// The way z that takes this energy, push z + ½ κ z²; none if there is no end to it.
  [[nodiscard]] static std::optional<T> way(const T& push, const T& kappa, const T& available) {
    using std::sqrt;
    const T square = fused(push, push, T(2) * kappa * available);
    if (!(square > T(0))) return std::nullopt;
    const T both = push + sqrt(square);
    if (!(both > T(0))) return std::nullopt;
    return T(2) * available / both;
  }

  ApparentLoad<T> load_;
  bool bounded_ = false, rests_ = false;
  bool elastic_ = false; ///< on a base that is not driven every hinge has a rest
  Numbers stiffness_, damping_, steady_;
  Numbers least_stiffness_; ///< κ
  Numbers at_rest_;         ///< P(y*) of a real hinge
  State<T> rest_;
  T offset_{}, p_{}, q_{}; ///< Σ g²/2κ, and (3)'s
};

} // namespace wingspread
