/// The air drag on a body's plate, for the oracle.
#pragma once

#include "core/scene/scene.hpp"
#include "tests/support/hinge_laws.hpp"

#include <Eigen/Core>

#include <cmath>

namespace wingspread::oracle {

template <class Scalar> using Vector2 = Eigen::Matrix<Scalar, 2, 1>;

/// Rotates a body-fixed vector by an angle.
template <class Scalar>
[[nodiscard]] Vector2<Scalar> rotated(const Vector2<Scalar>& vector, const Scalar& angle) {
  using std::cos;
  using std::sin;
  const Scalar c = cos(angle), s = sin(angle);
  return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y()};
}

/// e3 × a: the derivative of a rotated vector with respect to the angle of rotation.
template <class Scalar> [[nodiscard]] Vector2<Scalar> turned(const Vector2<Scalar>& a) {
  return {-a.y(), a.x()};
}

/// The third component of a × b.
template <class Scalar>
[[nodiscard]] Scalar cross(const Vector2<Scalar>& a, const Vector2<Scalar>& b) {
  return a.x() * b.y() - a.y() * b.x();
}

template <class Scalar> struct Load {
  Vector2<Scalar> force; ///< inertial axes, N
  Scalar moment;         ///< about the centre of mass, N·m
};

/// −½ ρ C b ∫ |v_n| v_n n along the plate, and its moment. Gauss quadrature is exact on either side
/// of the point where v_n changes its sign: the integrands are polynomials of degree 2 and 3 there.
/// @param angle, rate of the body; velocity of its centre of mass
template <class Scalar>
[[nodiscard]] Load<Scalar> air_on_plate(const Plate& plate, const Scalar& density,
                                        const Scalar& angle, const Vector2<Scalar>& velocity,
                                        const Scalar& rate) {
  using std::abs;
  const Vector2<Scalar> from = rotated<Scalar>(plate.from.cast<Scalar>(), angle);
  const Vector2<Scalar> way = rotated<Scalar>(plate.to.cast<Scalar>(), angle) - from;
  const Scalar length = way.norm();
  if (length == 0) return {Vector2<Scalar>::Zero(), Scalar(0)};
  const Vector2<Scalar> normal = turned(way) / length;
  const auto point = [&](const Scalar& u) { return Vector2<Scalar>(from + way * u); };
  const auto normal_speed = [&](const Scalar& u) {
    return Scalar(normal.dot(velocity + turned(point(u)) * rate));
  };
  const Scalar factor = density * Scalar(plate.drag_coefficient) * Scalar(plate.width) * length / 2;
  const auto force = [&](const Scalar& u) { // along the normal
    const Scalar v = normal_speed(u);
    return Scalar(-factor * abs(v) * v);
  };
  const auto moment = [&](const Scalar& u) { return Scalar(cross(point(u), normal) * force(u)); };
  const Scalar zero{0}, one{1}, first = normal_speed(zero), last = normal_speed(one);
  const Scalar still = first * last < 0 ? Scalar(first / (first - last)) : one;
  return {normal * (gauss3(zero, still, force) + gauss3(still, one, force)),
          gauss3(zero, still, moment) + gauss3(still, one, moment)};
}

} // namespace wingspread::oracle
