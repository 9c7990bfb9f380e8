/// The hinges of a wing in a run: the laws that act in the present state of latches, contacts and motors, and their
/// moments. system.hpp builds the right-hand side on them.
#pragma once

#include "core/mechanics/edges.hpp"
#include "core/mechanics/layout.hpp"
#include "core/mechanics/workspace.hpp"

#include <optional>

namespace wingspread {

template <class T> class HingeStates {
public:
  HingeStates(const Wing<T>& wing, const Layout& layout, const T& epsilon, Workspace<T>& work)
      : wing_(wing), work_(work), layout_(layout), epsilon_(epsilon) {}

  /// Sets the side of every edge of real hinges at x, where a run begins.
  void find_sides(const State<T>& x) {
    for (int i = 1; i < static_cast<int>(wing_.real.size()); ++i) {
      for (int e = 0; e < edges_of_hinge; ++e)
        work_.above[i][e] = x[layout_.angle(i)] > edge_angle(wing_, i, static_cast<Edge>(e));
      update_law(i);
    }
  }
  /// Records that hinge i has passed an edge, upwards or downwards.
  void note_crossing(int i, Edge edge, bool upwards) {
    work_.above[i][static_cast<int>(edge)] = upwards;
    update_law(i);
  }

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const Wing<T>& wing() const { return wing_; }
  [[nodiscard]] const Workspace<T>& work() const { return work_; }
  [[nodiscard]] const T& epsilon() const { return epsilon_; }
  /// The workspace, to write: for tolerances, and for the results of evaluations made elsewhere (in a lane of a pack).
  [[nodiscard]] Workspace<T>& writable_workspace() { return work_; }

  /// Engages the latch of hinge i, which has reached its latched angle.
  void engage(int i) {
    work_.engaged[i] = true;
    if (wing_.is_real() && !wing_.real.empty()) { // the latched angle lies inside the backlash
      work_.above[i][static_cast<int>(Edge::backlash_low)] = true;
      work_.above[i][static_cast<int>(Edge::backlash_high)] = false;
    }
    update_law(i);
  }

  /// Disengages the latch of hinge i, which bears on its stowed side.
  void disengage(int i) {
    work_.engaged[i] = false;
    work_.above[i][static_cast<int>(Edge::pass)] = wing_.hinges[i].sense < T(0);
    update_law(i);
  }

  /// Sets the state of hinge i's exact friction or rigid hold.
  void set_contact(int i, Contact contact) {
    work_.locked += wingspread::is_locked(contact) - wingspread::is_locked(work_.contact[i]);
    work_.contact[i] = contact;
    if constexpr (is_one_number<T>)
      if (contact == Contact::held && !wing_.motors.empty()) work_.motors[i] = idle_motor<T>();
    update_law(i);
  }
  /// Sets whether the elastic hold of hinge i restrains it.
  void restrain(int i, bool restrained) {
    work_.restrained[i] = restrained;
    if (restrained && !wing_.motors.empty()) work_.motors[i] = idle_motor<T>();
    update_law(i);
  }
  [[nodiscard]] bool is_restrained(int i) const { return work_.restrained[i] != 0; }
  /// Moment of the elastic hold of hinge i at x, N·m. @pre is_restrained(i)
  [[nodiscard]] T elastic_hold(const State<T>& x, int i) const {
    const ReleaseTerms<T>& hold = wing_.releases[i];
    const T way = x[layout_.angle(i)] - wing_.hinges[i].stowed;
    return -fused(hold.stiffness, way, hold.damping * x[layout_.rate(i)]);
  }
  /// Energy of the elastic hold of hinge i at x, J; 0 unless is_restrained(i).
  [[nodiscard]] T hold_energy(const State<T>& x, int i) const {
    if (!is_restrained(i)) return T(0);
    const T way = x[layout_.angle(i)] - wing_.hinges[i].stowed;
    return T(0.5) * wing_.releases[i].stiffness * way * way;
  }

  /// Starts the motor of hinge i, which is released at t.
  void start_motor(int i, const T& t) {
    if (!wing_.motors.empty() && wing_.motors[i].present)
      work_.motors[i] = started_motor(wing_.motors[i], t);
  }
  /// Sets the commanded rates of all motors to those at t.
  void set_commands(const T& t) {
    for (int i = 1; i < motors_end(); ++i)
      if (wing_.motors[i].present) work_.motors[i].now = commanded_rate(work_.motors[i], t);
  }
  /// Whether the commands of all motors are constant from now on. The motor of a held hinge counts as constant.
  [[nodiscard]] bool motors_are_steady() const {
    for (int i = 1; i < motors_end(); ++i)
      if (!is_steady(work_.motors[i])) return false;
    return true;
  }
  /// Whether hinge i is released and has a motor.
  [[nodiscard]] bool motor_runs(int i) const {
    return !wing_.motors.empty() && work_.motors[i].runs > T(0);
  }
  /// Moment of the motor of hinge i at φ̇ = 0 under its present command, N·m; 0 without a motor.
  [[nodiscard]] T drive_of_motor(int i) const {
    return wing_.motors.empty() ? T(0) : motor_drive(wing_.motors[i], work_.motors[i]);
  }

  /// Whether hinge i is held by a rigid hold; for a pack: in which lanes.
  [[nodiscard]] Truth<T> is_held(int i) const {
    if constexpr (is_one_number<T>)
      return work_.contact[i] == Contact::held;
    else
      return work_.locks[i] > T(1);
  }
  /// Whether hinge i is locked, stuck by friction or held by a rigid hold; for a pack: in which lanes.
  [[nodiscard]] Truth<T> is_locked(int i) const {
    if constexpr (is_one_number<T>)
      return wingspread::is_locked(work_.contact[i]);
    else
      return work_.locks[i] > T(0);
  }
  /// Whether hinge i has an event latch that has engaged.
  [[nodiscard]] bool latch_acts(int i) const {
    return work_.engaged[i] && wing_.hinges[i].has_latch && !layout_.smoothed;
  }

  /// The hinge's linear law in its present state without friction: the part that has a potential.
  [[nodiscard]] LinearLaw<T> law_without_friction(int i) const {
    return linear_law(wing_.hinges[i], latch_acts(i), T(0), backlash_side(i));
  }

  /// Energy of an engaged latch of a real hinge, J; 0 inside its backlash.
  [[nodiscard]] T latch_energy(const State<T>& x, int i) const {
    const std::optional<T> side = backlash_side(i);
    if (!latch_acts(i) || !side) return T(0);
    const T y = x[layout_.angle(i)] - wing_.hinges[i].latched - *side;
    return T(0.5) * wing_.hinges[i].stiffness * y * y;
  }

  /// Moment of hinge i, N·m; of a locked hinge, the moment on its axis at the last evaluation.
  [[nodiscard]] T moment(const State<T>& x, int i) const {
    return wingspread::is_locked(work_.contact[i]) ? work_.holding[i] : sliding_moment(x, i);
  }

  /// Moment of the friction, or of the hold, that keeps hinge i at rest, N·m.
  /// @pre hinge i is locked, and the last evaluation was at x
  [[nodiscard]] T locking_moment(const State<T>& x, int i) const {
    return work_.holding[i] - sliding_moment(x, i);
  }

  /// Moment of hinge i, N·m, without the friction or the hold that locks it. A motor has its command of the last
  /// evaluation.
  [[nodiscard]] T sliding_moment(const State<T>& x, int i) const {
    const T linear = linear_moment(work_.laws[i], x[layout_.angle(i)], x[layout_.rate(i)]);
    return wing_.is_nonlinear() || layout_.smoothed
               ? linear + (nonlinear_moment(x, i) + loops_moment(x, i))
               : linear;
  }

  /// Moment of the laws of real_hinge.hpp at hinge i, N·m. @pre the wing has real hinges
  [[nodiscard]] T moment_of_laws(int i, const T& angle, const T& rate) const {
    return real_moment(wing_.real[i], work_.modes[i], work_.pieces[i], angle, rate);
  }

  /// Largest moment that exact friction holds at hinge i, N·m; 1e300 for a held hinge, because a hold has no limit.
  [[nodiscard]] T static_limit(const State<T>& x, int i) const {
    const bool tested = !wing_.real.empty() && !wing_.real[i].friction.regularized;
    T most = wing_.hinges[i].static_friction;
    most = most + (tested ? measured_friction(wing_.real[i].friction, x[layout_.angle(i)]) : T(0));
    return wing_.releases.empty() ? most : select(is_held(i), T(1e300), most);
  }

  /// State of a loop at x.
  [[nodiscard]] LoopState<T> state_of(const LoopTerms<T>& loop, const State<T>& x) const {
    return loop_state(loop, x[layout_.angle(loop.first)], x[layout_.rate(loop.first)],
                      x[layout_.angle(loop.second)], x[layout_.rate(loop.second)]);
  }

protected:
  [[nodiscard]] int motors_end() const { return static_cast<int>(wing_.motors.size()); }

  void update_law(int i) {
    const Contact contact = work_.contact[i];
    const T friction = contact == Contact::forward    ? -wing_.hinges[i].kinetic_friction
                       : contact == Contact::backward ? wing_.hinges[i].kinetic_friction
                                                      : T(0);
    if constexpr (is_one_number<T>)
      if (!wing_.real.empty())
        work_.modes[i] = mode_of(wing_, i, work_.above[i], contact, latch_acts(i));
    work_.laws[i] = linear_law(wing_.hinges[i], latch_acts(i), friction, backlash_side(i));
    if (!is_restrained(i)) return;
    const ReleaseTerms<T>& hold = wing_.releases[i];
    add_hold(work_.laws[i], wing_.hinges[i].stowed, hold.stiffness, hold.damping);
  }

  [[nodiscard]] std::optional<T> backlash_side(int i) const {
    if (wing_.real.empty() || !latch_acts(i)) return T(0);
    return side_of_backlash(wing_.real[i], work_.above[i]);
  }

  /// Sets the nonlinear moments. Not inlined, so that the caller's frames stay in registers.
  [[gnu::noinline]] void find_nonlinear_moments(const State<T>& x) {
    for (int i = 1; i <= layout_.bodies; ++i) work_.nonlinear[i] = smooth_moment(x, i);
    if (wing_.is_real()) add_real_moments(x);
  }

  [[gnu::noinline]] void add_real_moments(const State<T>& x) {
    for (int i = 1; i < static_cast<int>(wing_.real.size()); ++i)
      if (wing_.real[i].has_law()) work_.nonlinear[i] = work_.nonlinear[i] + of_real_hinge(x, i);
    for (int i = 1; i < motors_end(); ++i)
      if (wing_.motors[i].present && any(work_.motors[i].runs > T(0)))
        work_.nonlinear[i] = work_.nonlinear[i] + of_motor(x, i);
    for (const LoopTerms<T>& loop : wing_.loops) {
      const LoopState<T> state = state_of(loop, x);
      const T torque = loop_torque(loop, state);
      T &a = work_.nonlinear[loop.first], &b = work_.nonlinear[loop.second];
      a = fused(on_first(loop, state.gear), torque, a);
      b = fused(on_second(loop), torque, b);
    }
  }

  /// Moment of all loops at hinge i, N·m.
  [[nodiscard]] T loops_moment(const State<T>& x, int i) const {
    T sum(0);
    for (const LoopTerms<T>& loop : wing_.loops) {
      if (!joins(loop, i)) continue;
      const LoopState<T> state = state_of(loop, x);
      sum = fused(on_hinge(loop, i, state.gear), loop_torque(loop, state), sum);
    }
    return sum;
  }

  [[nodiscard]] T nonlinear_moment(const State<T>& x, int i) const {
    T m = smooth_moment(x, i) + (wing_.real.empty() ? T(0) : of_real_hinge(x, i));
    if (!wing_.motors.empty()) m = m + of_motor(x, i);
    return m;
  }

  [[nodiscard]] T of_motor(const State<T>& x, int i) const {
    const MotorPiece<T>& piece = work_.motors[i];
    return motor_moment(wing_.motors[i], piece, T(piece.now - x[layout_.rate(i)]));
  }

  [[nodiscard]] T of_real_hinge(const State<T>& x, int i) const {
    return moment_of_laws(i, x[layout_.angle(i)], x[layout_.rate(i)]);
  }

  /// Moment of regularized friction and a smoothed latch, N·m.
  [[nodiscard]] T smooth_moment(const State<T>& x, int i) const {
    const T& rate = x[layout_.rate(i)];
    const HingeTerms<T>& hinge = wing_.hinges[i];
    T m = any(hinge.regularized_friction > T(0)) ? regularized_friction_moment(hinge, rate) : T(0);
    if (layout_.smoothed && wing_.hinges[i].has_latch)
      m = m + smoothed_latch_moment(wing_.hinges[i], x[layout_.angle(i)], rate, x[layout_.latch(i)],
                                    epsilon_);
    return m;
  }

  const Wing<T>& wing_;
  Workspace<T>& work_;
  const Layout layout_;
  const T epsilon_;
};

} // namespace wingspread
