/// What a run changes while it goes on, beside its state:
/// laws, latches, contacts, and scratch space.
#pragma once

#include "core/mechanics/augmented.hpp"
#include "core/mechanics/drive.hpp"
#include "core/mechanics/hinge_moment.hpp"

#include <array>
#include <vector>

namespace wingspread {

/// What the exact friction of a hinge does: oppose a motion, or hold it.
enum class Contact : signed char { backward = -1, none = 0, forward = 1, stuck = 2 };

/// Angles of a hinge at which its law changes.
enum class Edge : signed char {
  stop,       ///< contact begins
  window_low, ///< of the damper
  window_high,
  backlash_low, ///< of an engaged latch
  backlash_high
};
inline constexpr int edges_of_hinge = 5;

/// What changes from phase to phase of a run, and scratch space. Owned by the caller, one a thread.
template <class T> struct Workspace {
  std::vector<BodyFrame<T>> frames; ///< 0 … n
  /// 1 … n: on body i at its hinge, at the last evaluation, N; kept only when they are asked for.
  std::vector<Vec2<T>> forces;
  std::vector<LinearLaw<T>> laws; ///< 1 … n
  std::vector<T> nonlinear;       ///< 1 … n: moments that are not linear, N·m
  // of real hinges; empty where there are none
  std::vector<HingeMode<T>> modes;                     ///< 1 … n
  std::vector<std::array<char, edges_of_hinge>> above; ///< 1 … n: has passed the edge upwards
  // of a base that is driven by a table
  DrivenPiece<T> driven{}; ///< where the run is in it
  // of plates in the air; empty where there are none
  std::vector<T> air_moments;      ///< 1 … n: what the air does, as moments at the hinges, N·m
  std::vector<Vec2<T>> air_forces; ///< 0 … n: the air's force on body i and all outward of it, N
  std::vector<Vec2<T>> velocities; ///< 0 … n: of the hinges' points, m/s
  std::vector<char> engaged;       ///< 1 … n: has passed its latched angle
  std::vector<Contact> contact;    ///< 1 … n: what its exact friction does
  std::vector<T> holding; ///< 1 … n: axis moment at the last evaluation that held a hinge
  int stuck = 0;          ///< how many stick
  Augmented<T> held;      ///< of the evaluation while hinges stick
  long evaluations = 0;
};

} // namespace wingspread
