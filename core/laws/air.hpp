/// Air at rest on a plate that moves: pressure ½ ρ C |v| v on the normal velocity v.
///
/// Along the plate, s = 0 … 1, the normal velocity of a rigid body is linear, v = v_0 + (v_1 − v_0) s.
/// ρ is the air's density, C the drag coefficient, b and L the plate's width and length, and B = ½ ρ C b L. The force
/// along the normal is −B times (1). Its moment about the edge s = 0 is −B L times (2).
///
///     ∫ |v| v ds   = (|v_1|³ − |v_0|³)/(3 Δ)                                                    (1)
///     ∫ |v| v s ds = ((|v_1| v_1³ − |v_0| v_0³)/4 − v_0 (|v_1|³ − |v_0|³)/3)/Δ²    Δ = v_1 − v_0   (2)
///
/// and where v keeps its sign, without the division, ±(v_0² + v_0 v_1 + v_1²)/3 and
/// ±(v_0² + 2 v_0 v_1 + 3 v_1²)/12.
#pragma once

#include "core/number/planar.hpp"
#include "core/scene/scene.hpp"

#include <cmath>

namespace wingspread {

/// A body's plate in the body's frame, relative to the hinge's point.
template <class T> struct PlateTerms {
  Vec2<T> from, along; ///< its first edge; the way from there to the other edge, m
  Vec2<T> normal;      ///< of length one
  T strength;          ///< B, kg/m; 0: no plate
};

/// The integrals (1) and (2), m²/s²: −B times `first` is the force, −B L times `second` the moment.
template <class T> struct PlateIntegrals { T first, second; };

/// (1) and (2) from the normal velocities at both edges, m/s. Divided by Δ only where v changes its sign.
template <class T> [[nodiscard]] PlateIntegrals<T> plate_integrals(const T& v0, const T& v1) {
  using std::abs;
  const T a0 = abs(v0), a1 = abs(v1), product = v0 * v1;
  const auto one_sign = product >= T(0);
  const T sign = select(v0 + v1 < T(0), T(-1), T(1));
  const T smooth_force = sign * fused(v0, v0, fused(v1, v1, product)) / T(3);
  const T smooth_moment = sign * fused(v0, v0, fused(T(3) * v1, v1, T(2) * product)) / T(12);
  const T change = select(one_sign, T(1), T(v1 - v0));
  const T cubes = (a1 * a1 * a1 - a0 * a0 * a0) / T(3);
  const T fourths = T(0.25) * (a1 * v1 * v1 * v1 - a0 * v0 * v0 * v0);
  return {select(one_sign, smooth_force, T(cubes / change)),
          select(one_sign, smooth_moment, T((fourths - v0 * cubes) / (change * change)))};
}

/// The plate of a body; its strength is 0 without a plate or without air.
/// @param center      from the hinge's point to the centre of mass, in the body's frame, m
/// @param air_density kg/m³
template <class T>
[[nodiscard]] PlateTerms<T> plate_terms(const Body& body, const Vec2<T>& center,
                                        double air_density) {
  PlateTerms<T> terms{};
  if (!body.plate || !(air_density > 0)) return terms;
  const Plate& plate = *body.plate;
  const Vec2<T> from{T(plate.from.x()), T(plate.from.y())}, to{T(plate.to.x()), T(plate.to.y())};
  terms.from = center + from;
  terms.along = to - from;
  using std::sqrt;
  const T length = sqrt(dot(terms.along, terms.along));
  terms.normal = scaled(T(1) / length, turned(terms.along));
  terms.strength = T(0.5) * T(air_density) * T(plate.drag_coefficient) * T(plate.width) * length;
  return terms;
}

} // namespace wingspread
