/// The data that a run changes, beside its state vector: laws, latches, contacts and scratch space.
#pragma once

#include "core/laws/linear_law.hpp"
#include "core/laws/motor.hpp"
#include "core/laws/smoothed_latch.hpp"
#include "core/mechanics/kinematics.hpp"
#include "core/mechanics/locked.hpp"

#include <array>
#include <vector>

namespace wingspread {

/// State of a hinge: its exact friction slides backward or forward, or sticks; its hold holds it; or none of these.
enum class Contact : signed char { backward = -1, none = 0, forward = 1, stuck = 2, held = 3 };

/// Whether the hinge is locked: by friction, or by its hold.
[[nodiscard]] constexpr bool is_locked(Contact contact) { return contact >= Contact::stuck; }
/// The sense in which the hinge slides against exact friction: −1 or 1; 0: it does not.
[[nodiscard]] constexpr int sense_of(Contact contact) {
  return is_locked(contact) ? 0 : static_cast<int>(contact);
}

/// Angles of a hinge at which its law changes.
enum class Edge : signed char {
  stop,       ///< contact begins
  window_low, ///< of the damper
  window_high,
  backlash_low,  ///< of an engaged latch with backlash
  backlash_high, ///< or, without backlash, the latched angle of a latch with dissipation
  far_stop,      ///< contact begins
  pass           ///< the latched angle of an open latch that may miss
};
inline constexpr int edges_of_hinge = 7;

/// Owned by the caller, one per thread.
template <class T> struct Workspace {
  std::vector<BodyFrame<T>> frames; ///< 0 … n
  /// 1 … n: force on body i at its hinge at the last evaluation, N; kept only with want_forces(true).
  std::vector<Vec2<T>> forces;
  std::vector<LinearLaw<T>> laws; ///< 1 … n
  std::vector<T> nonlinear;       ///< 1 … n: moments that are not linear, N·m
  // of real hinges; empty where there are none
  std::vector<HingeMode<T>> modes;   ///< 1 … n
  std::vector<TablePiece<T>> pieces; ///< 1 … n: of their tables, at the last evaluation
  std::vector<std::array<char, edges_of_hinge>>
      above;                         ///< 1 … n: whether the angle is above the edge
  std::vector<MotorPiece<T>> motors; ///< 0 … n: present commands; empty where no hinge has a motor
  DrivenPiece<T> driven{};           ///< current piece of the base's table
  // of plates in the air; empty where there are none
  std::vector<T> air_moments;      ///< 0 … n: L of air_loads.hpp, N·m; [0]: the whole wing's
  std::vector<Vec2<T>> air_forces; ///< 0 … n: F of air_loads.hpp, N; [0]: the whole wing's
  std::vector<Vec2<T>> velocities; ///< 0 … n: of the hinges' points, m/s; [0]: the base's origin
  std::vector<char> engaged;       ///< 1 … n: latch engaged; if smoothed: latched angle reached
  std::vector<Contact> contact;    ///< 1 … n
  std::vector<char> restrained;    ///< 1 … n: the hinge's hold is elastic and has not let go
  std::vector<char> watches;       ///< 1 … n: the hinge's hold waits for another hinge's angle
  std::vector<T>
      locks; ///< 1 … n, packs only: 1 in lanes where the hinge is stuck, 2 where it is held, else 0
  std::vector<T> holding; ///< 1 … n: axis moments, N·m, at the last evaluation with a locked hinge
  int locked =
      0; ///< number of locked hinges (stuck or rigidly held); of a pack, of all lanes together
  std::vector<Crossing<T>> crossings; ///< 0 … n: of the last evaluation while hinges are locked
  Conserved<T> conserved{};           ///< of a free base whose momenta every step keeps
  bool keeps_momenta = false; ///< whether every step restores `conserved`: a free base without air
  T least_motion = T(0);      ///< atol of the run, rad and rad/s: smaller motion is not resolved
  long evaluations = 0;

  /// Makes room for a wing of n bodies. @param real, plates, motored sizes of the wing's lists
  void resize(int n, std::size_t real, std::size_t plates, std::size_t motored = 0) {
    frames.assign(n + 1, BodyFrame<T>{});
    forces.assign(n + 1, {T(0), T(0)});
    laws.resize(n + 1);
    nonlinear.resize(n + 1);
    crossings.resize(n + 1);
    modes.assign(real, {T(0), T(0), T(0), T(0), T(0)});
    pieces.assign(real, no_table_piece<T>());
    above.assign(real, {});
    motors.assign(motored, idle_motor<T>());
    air_moments.assign(plates, T(0));
    air_forces.assign(plates, {T(0), T(0)});
    velocities.assign(plates, {T(0), T(0)});
  }

  /// Resets to a run's start: nothing is latched, stuck or held.
  void reset(int n) {
    engaged.assign(n + 1, false);
    contact.assign(n + 1, Contact::none);
    holding.assign(n + 1, T(0));
    watches.assign(n + 1, false), restrained.assign(n + 1, false);
    motors.assign(motors.size(), idle_motor<T>());
    pieces.assign(pieces.size(), no_table_piece<T>());
    if constexpr (!is_one_number<T>) locks.assign(n + 1, T(0));
    locked = 0, evaluations = 0, keeps_momenta = false;
  }
};

} // namespace wingspread
