/// What a run changes while it goes on, beside its state:
/// laws, latches, contacts, and scratch space.
#pragma once

#include "core/mechanics/augmented.hpp"
#include "core/mechanics/hinge_moment.hpp"

#include <vector>

namespace wingspread {

/// What the exact friction of a hinge does: oppose a motion, or hold it.
enum class Contact : signed char { backward = -1, none = 0, forward = 1, stuck = 2 };

/// What changes from phase to phase of a run, and scratch space. Owned by the caller, one a thread.
template <class T> struct Workspace {
  std::vector<BodyFrame<T>> frames; ///< 0 … n
  /// 1 … n: on body i at its hinge, at the last evaluation, N; kept only when they are asked for.
  std::vector<Vec2<T>> forces;
  std::vector<LinearLaw<T>> laws; ///< 1 … n
  std::vector<T> nonlinear;       ///< 1 … n: moments of friction and smoothed latches, N·m
  std::vector<char> engaged;      ///< 1 … n: has passed its latched angle
  std::vector<Contact> contact;   ///< 1 … n: what its exact friction does
  std::vector<T> holding;         ///< 1 … n: axis moment at the last evaluation that held a hinge
  int stuck = 0;                  ///< how many stick
  Augmented<T> held;              ///< of the evaluation while hinges stick
  long evaluations = 0;
};

} // namespace wingspread
