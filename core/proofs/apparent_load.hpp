/// The load of a base of prescribed motion on a wing, seen from the base.
///
/// A base that turns at a constant rate Ω and has the constant acceleration a in inertial axes (gravity
/// counts as an acceleration the other way) loads every mass m with an apparent force m f,
///
///     f = −a + Ω² r + Coriolis's,    |f| ≤ |a| + Ω² R + 2 |Ω| |v|                              (1)
///
/// r from the base's origin, R the length of the way there along the tree, v as seen from the base.
/// Coriolis's force does no work, the others have a potential:
///
///     V = Σ m (a·r − ½ Ω² r²)                                                                  (2)
///
/// Let u_i be the way of hinge i from its rest, and λ_i the length of the way from the hinge to a mass
/// outward of it. Then V exerts at most g_i on the hinge:
///
///     g_i = Σ m λ_i (|a| + Ω² R)       V(φ) − V(rest) ≥ −Σ g_i |u_i|                           (3)
///
/// If neither a nor Ω is 0, a turns as seen from the base, and V changes with time. There are no such bounds while a
/// changes: on a base driven by a table, until its last knot. While Ω changes at a constant rate ε, V changes too, and the
/// base's angular acceleration does work: (11) of modal_bounds.hpp bounds both.
#pragma once

#include "core/mechanics/energy.hpp"

#include <cmath>

namespace wingspread {

template <class T> class ApparentLoad {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>; ///< 0 … n, as the bodies are numbered

  /// Cost O(n) times the tree's depth. @return whether there are bounds
  template <class AnySystem> bool prepare(const AnySystem& system) {
    const int n = system.layout().bodies;
    moment_.setZero(n + 1), specific_.setZero(n + 1);
    spin_ = T(0), turns_ = false, quickens_ = false;
    if constexpr (AnySystem::base_motion == BaseMotion::prescribed) {
      if (!system.drive_accelerates_constantly()) return false;
      sum_up(system, system.topology());
    }
    return true;
  }

  [[nodiscard]] const T& moment(int i) const { return moment_(i); }     ///< g, N·m
  [[nodiscard]] const T& specific(int i) const { return specific_(i); } ///< of (1), at rest, m/s²
  [[nodiscard]] const T& spin() const { return spin_; }                 ///< |Ω|, rad/s
  [[nodiscard]] bool turns() const { return turns_; } ///< whether a turns as seen from the base
  /// Whether Ω changes. Then `moment` and `specific` are 0 and bound nothing, and `spin` is that at one time.
  [[nodiscard]] bool quickens() const { return quickens_; }

  /// @return ½ Σ (m v² + J ω²) + V as seen from the base, and the sum of the sizes of its terms, J
  template <class AnySystem>
  [[nodiscard]] static std::pair<T, T> energy(AnySystem& system, const State<T>& x, const T& t) {
    using std::abs;
    const TotalMotion<T> now = total_motion(system, x, t);
    const T rate = system.work().frames[0].rate;
    const T dragged = rate * now.angular, pushed = dot(system.drive(t).felt, now.first_moment);
    // ½ Ω² Σ (m r² + J) of the motion as seen from the base, and less as much in V
    return {now.kinetic - dragged + pushed, now.kinetic + abs(dragged) + abs(pushed)};
  }

private:
  template <class AnySystem, class Topology>
  void sum_up(const AnySystem& system, const Topology& tree) {
    using std::abs, std::sqrt;
    const Wing<T>& wing = system.wing();
    const Drive<T> drive =
        system.drive(system.work().driven.from); // as at any other time, but for Ω if it changes
    const auto length = [](const Vec2<T>& v) { return T(sqrt(dot(v, v))); };
    const T push = length(drive.felt);
    spin_ = abs(drive.rate), quickens_ = drive.angular_acceleration != T(0);
    turns_ = push > T(0) && (spin_ > T(0) || quickens_);
    if (quickens_) return;
    for (int k = 1; k <= wing.size(); ++k) {
      const T &mass = wing.bodies[k].mass, own = length(wing.bodies[k].center);
      T reach = own;
      for (int i = k; i != 0; i = tree.parent_of(i)) reach = reach + length(wing.bodies[i].arm);
      specific_(k) = fused(spin_ * spin_, reach, push);
      T lambda = own;
      for (int i = k; i != 0; i = tree.parent_of(i)) {
        moment_(i) = fused(mass * lambda, specific_(k), moment_(i));
        lambda = lambda + length(wing.bodies[i].arm);
      }
    }
  }

  Numbers moment_, specific_;
  T spin_{};
  bool turns_ = false, quickens_ = false;
};

} // namespace wingspread
