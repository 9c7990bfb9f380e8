/// The interface of a law of a hinge's moment: the functions that every law defines and that all callers use.
///
/// | symbol | meaning                     | unit       |
/// |--------|-----------------------------|------------|
/// | φ, φ̇   | the hinge's angle and rate  | rad, rad/s |
/// | M      | moment on the hinge's body  | N·m        |
/// | P      | potential, −dP/dφ = M       | J          |
///
/// Every function adds to a sum, so that one loop over the laws (for_each_law in real_hinge.hpp) serves the
/// right-hand side, the stiff methods, the peak search, the lanes of packs and the energy audit alike.
#pragma once

#include "core/laws/range.hpp"

#include <concepts>

namespace wingspread {

/// −∂M/∂φ and −∂M/∂φ̇.
template <class T> struct HingeResistance {
  T stiffness; ///< N·m/rad
  T damping;   ///< N·m·s/rad
};

/// Ranges of ∂M/∂φ and ∂M/∂φ̇ over an interval of motion.
template <class T> struct MomentSlopes {
  ValueRange<T> by_angle{T(0), T(0)}; ///< N·m/rad
  ValueRange<T> by_rate{T(0), T(0)};  ///< N·m·s/rad

  /// A range of dM/dt, N·m/s.
  [[nodiscard]] ValueRange<T> change(const ValueRange<T>& rate,
                                     const ValueRange<T>& acceleration) const {
    return by_angle * rate + by_rate * acceleration;
  }
};

/// A law offers
///
/// | function       | adds                                                                                |
/// |----------------|-------------------------------------------------------------------------------------|
/// | add_moment     | M(φ, φ̇)                                                                             |
/// | add_resistance | −∂M/∂φ and −∂M/∂φ̇                                                                   |
/// | add_range      | a range that holds M over the given ranges of φ and φ̇                               |
/// | has_slopes     | (returns) whether add_slopes is valid over the range of φ; for packs: in which lanes |
/// | add_slopes     | ranges of ∂M/∂φ and ∂M/∂φ̇ over the given ranges of φ and φ̇                          |
/// | add_potential  | P(φ), zero at the latched angle, if the law stores energy                           |
template <class Law, class T>
concept HingeLaw = requires(const Law& law, T& sum, HingeResistance<T>& resistance,
                            ValueRange<T>& range, MomentSlopes<T>& slopes, const T& x,
                            const ValueRange<T>& over) {
  law.add_moment(sum, x, x);
  law.add_resistance(resistance, x, x);
  law.add_range(range, over, over);
  { law.has_slopes(over) } -> std::same_as<decltype(T(0) < T(0))>;
  law.add_slopes(slopes, over, over);
  law.add_potential(sum, x, x);
};

} // namespace wingspread
