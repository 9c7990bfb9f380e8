/// The right-hand side of a wing's equations of motion: dx/dt for x = (q, q̇, S) of layout.hpp.
/// Places the bodies (kinematics.hpp), sums the hinges' moments (core/laws), and runs the recursion: recursion.hpp,
/// (3)-(7); with stuck hinges locked.hpp, (8)-(10).
#pragma once

#include "core/mechanics/air_loads.hpp"
#include "core/mechanics/hinge_states.hpp"
#include "core/mechanics/kinematics.hpp"
#include "core/mechanics/locked.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// dx/dt of one wing. M is the wing's base motion; Topology is Tree, or Chain<N> for a short chain.
template <class T, class Topology, BaseMotion M> class System : public HingeStates<T> {
  using Hinges = HingeStates<T>;
  using Hinges::wing_, Hinges::work_, Hinges::layout_, Hinges::epsilon_;

public:
  using Hinges::is_locked, Hinges::set_commands;
  static constexpr BaseMotion base_motion = M;

  System(const Wing<T>& wing, const std::optional<double>& smoothing, Workspace<T>& work)
      : Hinges(wing, {first_coordinate, wing.size(), smoothing.has_value()},
               T(smoothing.value_or(0)), work) {
    work_.resize(layout_.bodies, wing_.real.size(), wing_.plates.size(), wing_.motors.size());
    reset();
  }

  /// Resets to a run's start: no hinge is latched or stuck. Reads the wing's numbers anew.
  void reset() {
    work_.reset(layout_.bodies);
    for (int i = 1; i <= layout_.bodies; ++i) this->update_law(i);
    if constexpr (is_one_number<T>) {
      if (has_table()) work_.driven = first_piece(wing_.base);
      for (int i = 1; i < this->motors_end(); ++i) this->start_motor(i, T(0));
    }
  }

  /// Time of the next knot of the base's table or a motor's, where a step must end, s; `never` without one.
  [[nodiscard]] T next_knot() const {
    T next = has_table() ? work_.driven.until : T(never);
    for (int i = 1; i < this->motors_end(); ++i) next = smaller(next, work_.motors[i].until);
    return next;
  }
  /// Enters the pieces of the tables at t. @return whether any piece has changed
  bool enter_piece(const T& t) {
    bool changed = has_table() && wingspread::enter_piece(wing_.base, t, work_.driven);
    for (int i = 1; i < this->motors_end(); ++i)
      changed = wingspread::enter_piece(wing_.motors[i], t, work_.motors[i]) || changed;
    return changed;
  }
  /// Motion of a prescribed base at t.
  [[nodiscard]] Drive<T> drive(const T& t) const { return drive_at(wing_.base, work_.driven, t); }
  [[nodiscard]] bool drive_is_steady() const { return is_steady(wing_.base, work_.driven); }
  [[nodiscard]] bool drive_accelerates_constantly() const {
    return accelerates_constantly(wing_.base, work_.driven);
  }

  [[nodiscard, gnu::always_inline]] decltype(auto) topology() const {
    return seen_as<Topology>(wing_.tree);
  }
  /// The state at t = 0.
  void start(State<T>& x) const {
    x.assign(layout_.size(), T(0));
    if constexpr (M == BaseMotion::free) {
      const BaseTerms<T>& base = wing_.base;
      const int v = layout_.freedoms();
      x[0] = base.position.x, x[1] = base.position.y, x[2] = base.angle;
      x[v] = base.velocity.x, x[v + 1] = base.velocity.y, x[v + 2] = base.rate;
    }
    for (int i = 1; i <= layout_.bodies; ++i) {
      x[layout_.angle(i)] = wing_.hinges[i].stowed;
      x[layout_.rate(i)] = wing_.initial_rates[i];
    }
  }

  /// Places every body in the workspace's frames, without forces, and commands the motors.
  void place_all(const State<T>& x, const T& t) {
    set_commands(t);
    place_base<M>(wing_, layout_, work_.driven, work_.frames[0], x, t);
    place_bodies<M>(wing_, topology(), work_.frames, x);
  }

  /// Velocity of the base's origin, m/s; a prescribed base starts at rest.
  [[nodiscard]] Vec2<T> base_velocity(const State<T>& x, const T& t) const {
    if constexpr (M == BaseMotion::free) return {x[layout_.freedoms()], x[layout_.freedoms() + 1]};
    if constexpr (M == BaseMotion::prescribed)
      return wing_.base.table ? velocity(work_.driven, t) : scaled(t, wing_.base.acceleration);
    return {T(0), T(0)};
  }

  /// Sets dxdt. With want_forces(true), the workspace has the hinge forces at x afterwards.
  void operator()(const State<T>& x, State<T>& dxdt, const T& t) { evaluate<true>(x, dxdt, t); }

  /// Sets dxdt at the end x of a step, as operator() does. Restores the conserved momenta in x first, if work.keeps_momenta.
  void end_step(State<T>& x, State<T>& dxdt, const T& t) {
    if constexpr (M == BaseMotion::free)
      if (work_.keeps_momenta) {
        place_all(x, t);
        keep_momenta(work_.conserved, total_motion_of<M>(wing_, topology(), work_.frames),
                     wing_.base.gravity, t, layout_, x);
        set_rates(layout_, topology(), work_.frames, x);
        ++work_.evaluations;
        return evaluate_placed(x, dxdt, t);
      }
    (*this)(x, dxdt, t);
  }

  /// Sets dxdt without forces and without the moments that hold stuck hinges: for stages inside a step.
  void stage(const State<T>& x, State<T>& dxdt, const T& t) { evaluate<false>(x, dxdt, t); }

  /// Sets whether evaluations leave the hinge forces in the workspace.
  void want_forces(bool want) { wants_forces_ = want; }

private:
  template <bool forces>
  [[gnu::always_inline]] void evaluate(const State<T>& x, State<T>& dxdt, const T& t) {
    ++work_.evaluations;
    if (!wing_.motors.empty()) set_commands(t);
    if (work_.locked > 0) {
      evaluate_with_locks<forces>(x, dxdt, t);
    } else if (!wing_.plates.empty()) {
      evaluate_in_air(x, dxdt, t);
    } else if constexpr (is_static<Topology>) {
      std::array<BodyFrame<T>, Topology::bodies() + 1> frames; // in registers
      evaluate<forces, false>(frames, x, dxdt, t);
    } else {
      evaluate<forces, false>(work_.frames, x, dxdt, t);
    }
  }

  /// Not inlined: the frames are in memory anyway. @pre the system is placed, with its motors' commands; there is no air
  [[gnu::noinline]] void evaluate_placed(const State<T>& x, State<T>& dxdt, const T& t) {
    work_.locked > 0 ? evaluate<true, false, true, true>(work_.frames, x, dxdt, t)
                     : evaluate<true, false, false, true>(work_.frames, x, dxdt, t);
  }

  /// Not inlined: see evaluate_in_air. Leaves the moments that hold locked hinges if `held`.
  template <bool held>
  [[gnu::noinline]] void evaluate_with_locks(const State<T>& x, State<T>& dxdt, const T& t) {
    wing_.plates.empty() ? evaluate<held, false, true>(work_.frames, x, dxdt, t)
                         : evaluate<held, true, true>(work_.frames, x, dxdt, t);
  }

  /// Not inlined: taking the frames' address would move them out of registers in the other evaluations.
  [[gnu::noinline]] void evaluate_in_air(const State<T>& x, State<T>& dxdt, const T& t) {
    evaluate<true, true>(work_.frames, x, dxdt, t);
  }

  /// Whether hinge i or a child's is locked; for a pack: in any lane.
  [[nodiscard]] bool locks_cross(int i) const {
    bool found = any(is_locked(i));
    topology().for_each_child(i, [&](int j) { found = found || any(is_locked(j)); });
    return found;
  }
  /// As gather_with_locks where !locks_cross(i), at the cost of gather.
  template <class Frames> void gather_free(Frames& frames, int i) {
    gather(wing_, topology(), frames, i);
    work_.crossings[i] = {{T(0), T(0)}, T(0), frames[i].moment};
  }

  static constexpr int first_coordinate = base_freedoms<M>; ///< φ_1 in q
  [[nodiscard]] bool has_table() const { return M == BaseMotion::prescribed && wing_.base.table; }
  [[nodiscard]] int freedoms() const { return first_coordinate + topology().bodies(); }

  template <bool air, class Frames>
  [[gnu::always_inline]] void apply_moments(Frames& frames, const State<T>& x, const T& t) {
    const T* const angles = x.data() + first_coordinate;
    const T* const rates = angles + freedoms();
    const LinearLaw<T>* const laws = work_.laws.data();
    const bool rubs = is_static<Topology> && wing_.has_friction_alone() && !layout_.smoothed;
    topology().outward([&](int i) __attribute__((always_inline)) {
      T m = linear_moment(laws[i], angles[i - 1], rates[i - 1]);
      if (rubs) m = m + regularized_friction_moment(wing_.hinges[i], rates[i - 1]);
      frames[i].moment = m;
    });
    if (!rubs && (wing_.is_nonlinear() || layout_.smoothed)) {
      this->find_nonlinear_moments(x);
      topology().outward([&](int i) __attribute__((always_inline)) {
        frames[i].moment = frames[i].moment + work_.nonlinear[i];
      });
    }
    if constexpr (air) {
      find_air_loads(wing_, topology(), frames.data(), base_velocity(x, t), work_);
      for (int i = M == BaseMotion::free ? 0 : 1; i <= layout_.bodies; ++i)
        frames[i].moment = frames[i].moment + work_.air_moments[i];
    }
  }

  [[gnu::always_inline]] void copy_rates(const State<T>& x, State<T>& dxdt) const {
    const T* const rates = x.data() + freedoms();
    T* const velocities = dxdt.data();
    for (int k = 0; k < first_coordinate; ++k) velocities[k] = rates[k];
    topology().outward([&](int i) __attribute__((always_inline)) {
      velocities[first_coordinate + i - 1] = rates[first_coordinate + i - 1];
    });
  }

  template <bool forces, bool air, bool locks = false, bool placed = false, class Frames>
  [[gnu::always_inline]] void evaluate(Frames& frames, const State<T>& x, State<T>& dxdt,
                                       const T& t) {
    if constexpr (!placed) {
      place_base<M>(wing_, layout_, work_.driven, frames[0], x, t);
      place_bodies<M>(wing_, topology(), frames, x);
    }
    apply_moments<air>(frames, x, t);
    topology().inward([&](int i) __attribute__((always_inline)) {
      if constexpr (locks)
        locks_cross(i)
            ? gather_with_locks(wing_, topology(), frames, work_.crossings, i, is_locked(i))
            : gather_free(frames, i);
      else
        gather(wing_, topology(), frames, i);
    });
    accelerate_base<air, locks>(frames, dxdt);
    T* const accelerations = dxdt.data() + first_coordinate + freedoms();
    topology().outward([&](int i) __attribute__((always_inline)) {
      if constexpr (locks)
        accelerations[i - 1] = accelerate_with_locks<M, T>(topology(), frames, i, is_locked(i));
      else
        accelerations[i - 1] = accelerate<M>(topology(), frames, i);
    });
    copy_rates(x, dxdt);
    if (layout_.smoothed) advance_latches(x, dxdt);
    if constexpr (forces && locks)
      find_axis_moments(topology(), frames, work_.crossings, work_.air_moments, work_.holding);
    if (forces && wants_forces_)
      topology().outward([&](int i) __attribute__((always_inline)) {
        if constexpr (locks)
          work_.forces[i] = hinge_force(frames[i], work_.crossings[i],
                                        frames[topology().parent_of(i)].angular_acceleration);
        else
          work_.forces[i] = hinge_force(frames[i]);
      });
    if (air && forces && wants_forces_) take_air_from_forces();
  }

  /// Subtracts the air's forces from the forces of the motion (air_loads.hpp).
  void take_air_from_forces() {
    for (int i = 1; i < static_cast<int>(wing_.plates.size()); ++i)
      work_.forces[i] = work_.forces[i] - work_.air_forces[i];
  }

  template <bool air, bool locks, class Frames>
  [[gnu::always_inline]] void accelerate_base(Frames& frames, State<T>& dxdt) {
    if constexpr (M == BaseMotion::free) {
      BodyFrame<T>& base = frames[0];
      if constexpr (locks)
        gather_with_locks(wing_, topology(), frames, work_.crossings, 0, T(0) < T(0));
      else
        gather(wing_, topology(), frames, 0);
      if constexpr (air) base.bias = base.bias - work_.air_forces[0];
      accelerate_free_base(base);
      const int v = layout_.freedoms();
      dxdt[v] = base.acceleration.x + wing_.base.gravity.x;
      dxdt[v + 1] = base.acceleration.y + wing_.base.gravity.y;
      dxdt[v + 2] = base.angular_acceleration;
    }
  }

  [[gnu::noinline]] void advance_latches(const State<T>& x, State<T>& dxdt) const {
    for (int i = 1; i <= layout_.bodies; ++i)
      dxdt[layout_.latch(i)] = wing_.hinges[i].has_latch
                                   ? engagement_rate(wing_.hinges[i], x[layout_.angle(i)], epsilon_)
                                   : T(0);
  }

  bool wants_forces_ = false;
};

} // namespace wingspread
