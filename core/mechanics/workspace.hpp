/// The data of a run beside its state vector: laws, latches, contacts and scratch space.
#pragma once

#include "core/laws/linear_law.hpp"
#include "core/laws/smoothed_latch.hpp"
#include "core/mechanics/locked.hpp"

#include <array>
#include <vector>

namespace wingspread {

/// State of a hinge's exact friction: sliding backward or forward, stuck, or none.
enum class Contact : signed char { backward = -1, none = 0, forward = 1, stuck = 2 };

/// Angles of a hinge at which its law changes.
enum class Edge : signed char {
  stop,       ///< contact begins
  window_low, ///< of the damper
  window_high,
  backlash_low, ///< of an engaged latch with backlash
  backlash_high ///< or, without backlash, the latched angle of a latch with dissipation
};
inline constexpr int edges_of_hinge = 5;

/// Owned by the caller, one per thread.
template <class T> struct Workspace {
  std::vector<BodyFrame<T>> frames; ///< 0 … n
  /// 1 … n: force on body i at its hinge at the last evaluation, N; kept only with want_forces(true).
  std::vector<Vec2<T>> forces;
  std::vector<LinearLaw<T>> laws; ///< 1 … n
  std::vector<T> nonlinear;       ///< 1 … n: moments that are not linear, N·m
  // of real hinges; empty where there are none
  std::vector<HingeMode<T>> modes; ///< 1 … n
  std::vector<std::array<char, edges_of_hinge>>
      above;               ///< 1 … n: whether the angle is above the edge
  DrivenPiece<T> driven{}; ///< current piece of the base's table
  // of plates in the air; empty where there are none
  std::vector<T> air_moments;      ///< 1 … n: L of air_loads.hpp, N·m
  std::vector<Vec2<T>> air_forces; ///< 0 … n: F of air_loads.hpp, N
  std::vector<Vec2<T>> velocities; ///< 0 … n: of the hinges' points, m/s
  std::vector<char> engaged;       ///< 1 … n: has passed its latched angle
  std::vector<Contact> contact;    ///< 1 … n: state of the exact friction
  std::vector<T> locks;   ///< 1 … n: of packs, 1 in the lanes where the hinge sticks, else 0
  std::vector<T> holding; ///< 1 … n: axis moment at the last evaluation that held a hinge
  int stuck = 0;          ///< number of stuck hinges, of all lanes together
  std::vector<Crossing<T>> crossings; ///< 0 … n: of the last evaluation while hinges stick
  T least_motion = T(0); ///< atol of the run, rad and rad/s: less is not resolved; 0 without a run
  long evaluations = 0;
};

} // namespace wingspread
