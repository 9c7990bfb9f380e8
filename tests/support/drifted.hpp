/// A probe of the dense wing's rates of change: a state a short time away.
#pragma once

#include "tests/support/dense_wing.hpp"

#include <type_traits>

namespace wingspread::oracle {

/// Returns the state after a time h, s, with constant accelerations. It is no solution: centred differences over ±h
/// have an error of h².
template <class Scalar>
WingState<Scalar> drifted(WingState<Scalar> state, const WingResponse<Scalar>& response,
                          const std::type_identity_t<Scalar>& h) {
  const Scalar half = h * h / 2;
  state.angles += state.rates * h + response.hinge_accelerations * half;
  state.rates += response.hinge_accelerations * h;
  state.base_position += state.base_velocity * h + response.base_acceleration * half;
  state.base_velocity += response.base_acceleration * h;
  state.base_angle += state.base_rate * h + response.base_angular_acceleration * half;
  state.base_rate += response.base_angular_acceleration * h;
  return state;
}

} // namespace wingspread::oracle
