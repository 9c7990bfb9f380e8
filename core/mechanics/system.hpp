/// The right-hand side of a wing's equations of motion: dx/dt for x = (q, q̇, S) of layout.hpp.
/// Places the bodies (kinematics.hpp), sums the hinges' moments (core/laws), and runs the recursion: recursion.hpp,
/// (3)-(7); with stuck hinges locked.hpp, (8)-(10).
#pragma once

#include "core/mechanics/air_loads.hpp"
#include "core/mechanics/edges.hpp"
#include "core/mechanics/kinematics.hpp"
#include "core/mechanics/locked.hpp"
#include "core/mechanics/workspace.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// dx/dt of one wing. M is the wing's base motion; Topology is Tree, or Chain<N> for a short chain.
template <class T, class Topology, BaseMotion M> class System {
public:
  static constexpr BaseMotion base_motion = M;

  System(const Wing<T>& wing, const std::optional<double>& smoothing, Workspace<T>& work)
      : wing_(wing), work_(work), layout_{first_coordinate, wing.size(), smoothing.has_value()},
        epsilon_(smoothing.value_or(0)) {
    work_.resize(layout_.bodies, wing_.real.size(), wing_.plates.size());
    reset();
  }

  /// Resets to a run's start: no hinge is latched or stuck. Reads the wing's numbers anew.
  void reset() {
    work_.reset(layout_.bodies);
    for (int i = 1; i <= layout_.bodies; ++i) update_law(i);
    if constexpr (is_one_number<T>)
      if (has_table()) work_.driven = first_piece(wing_.base);
  }

  /// Time of the next knot of the base's table, where a step must end, s; `never` without one.
  [[nodiscard]] T next_knot() const { return has_table() ? work_.driven.until : T(never); }
  /// Enters the piece of the base's table at t. @return whether the piece has changed
  bool enter_piece(const T& t) {
    return has_table() && wingspread::enter_piece(wing_.base, t, work_.driven);
  }
  /// Motion of a prescribed base at t.
  [[nodiscard]] Drive<T> drive(const T& t) const { return drive_at(wing_.base, work_.driven, t); }
  [[nodiscard]] bool drive_is_steady() const { return is_steady(wing_.base, work_.driven); }

  /// Sets the side of every edge of real hinges at x, where a run begins.
  void find_sides(const State<T>& x) {
    for (int i = 1; i < static_cast<int>(wing_.real.size()); ++i) {
      for (int e = 0; e < edges_of_hinge; ++e)
        work_.above[i][e] = x[layout_.angle(i)] > edge_angle(wing_, i, static_cast<Edge>(e));
      update_law(i);
    }
  }
  /// Records that hinge i has passed an edge, upwards or downwards.
  void pass(int i, Edge edge, bool upwards) {
    work_.above[i][static_cast<int>(edge)] = upwards;
    update_law(i);
  }

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const Wing<T>& wing() const { return wing_; }
  [[nodiscard, gnu::always_inline]] decltype(auto) topology() const {
    return seen_as<Topology>(wing_.tree);
  }
  [[nodiscard]] const Workspace<T>& work() const { return work_; }
  [[nodiscard]] const T& epsilon() const { return epsilon_; }
  /// The workspace, for the tolerances, and for evaluations made outside this object.
  [[nodiscard]] Workspace<T>& made_elsewhere() { return work_; }

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

  /// Engages the latch of hinge i, which has reached its latched angle.
  void engage(int i) {
    work_.engaged[i] = true;
    if (wing_.is_real() && !wing_.real.empty()) { // inside its backlash
      work_.above[i][static_cast<int>(Edge::backlash_low)] = true;
      work_.above[i][static_cast<int>(Edge::backlash_high)] = false;
    }
    update_law(i);
  }

  /// The latch of hinge i lets go at x.
  void disengage(int i, const State<T>& x) {
    work_.engaged[i] = false;
    work_.above[i][static_cast<int>(Edge::pass)] = x[layout_.angle(i)] > wing_.hinges[i].latched;
    update_law(i);
  }

  /// Sets the state of hinge i.
  void touch(int i, Contact contact) {
    work_.stuck += wingspread::is_locked(contact) - wingspread::is_locked(work_.contact[i]);
    work_.contact[i] = contact;
    update_law(i);
  }
  /// Whether hinge i is locked, by friction or by its hold.
  [[nodiscard]] bool sticks(int i) const { return wingspread::is_locked(work_.contact[i]); }
  /// Whether the hold of hinge i holds it; for a pack: in which lanes.
  [[nodiscard]] Truth<T> is_held(int i) const {
    if constexpr (is_one_number<T>)
      return work_.contact[i] == Contact::held;
    else
      return work_.locks[i] > T(1);
  }
  /// As sticks; for a pack: the lanes in which it does.
  [[nodiscard]] Truth<T> is_locked(int i) const {
    if constexpr (is_one_number<T>)
      return sticks(i);
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

  /// Places every body in the workspace's frames, without forces.
  void place_all(const State<T>& x, const T& t) {
    place_base<M>(wing_, layout_, work_.driven, work_.frames[0], x, t);
    place_bodies<M>(wing_, topology(), work_.frames, x);
  }

  /// Moment of hinge i, N·m; of a stuck hinge, the one that held it at the last evaluation.
  [[nodiscard]] T moment(const State<T>& x, int i) const {
    return sticks(i) ? work_.holding[i] : sliding_moment(x, i);
  }

  /// What locked hinge i at the last evaluation, which was at x, N·m: friction, or its hold.
  [[nodiscard]] T holding_friction(const State<T>& x, int i) const {
    return work_.holding[i] - sliding_moment(x, i);
  }

  /// Moment of hinge i without the friction that holds it, N·m.
  [[nodiscard]] T sliding_moment(const State<T>& x, int i) const {
    const T linear = linear_moment(work_.laws[i], x[layout_.angle(i)], x[layout_.rate(i)]);
    return wing_.is_nonlinear() || layout_.smoothed
               ? linear + (nonlinear_moment(x, i) + loops_moment(x, i))
               : linear;
  }

  /// Largest moment that locks hinge i at x, N·m: by exact friction; by a hold, without limit.
  [[nodiscard]] T static_limit(const State<T>& x, int i) const {
    const bool tested = !wing_.real.empty() && !wing_.real[i].friction.regularized;
    T most = wing_.hinges[i].static_friction;
    most = most + (tested ? measured_friction(wing_.real[i].friction, x[layout_.angle(i)]) : T(0));
    return wing_.releases.empty() ? most : select(is_held(i), T(1e300), most);
  }

  /// Velocity of the base's origin, m/s; a prescribed base starts at rest.
  [[nodiscard]] Vec2<T> base_velocity(const State<T>& x, const T& t) const {
    if constexpr (M == BaseMotion::free) return {x[layout_.freedoms()], x[layout_.freedoms() + 1]};
    if constexpr (M == BaseMotion::prescribed)
      return wing_.base.table ? velocity(work_.driven, t) : scaled(t, wing_.base.acceleration);
    return {T(0), T(0)};
  }

  /// State of a loop at x.
  [[nodiscard]] LoopState<T> state_of(const LoopTerms<T>& loop, const State<T>& x) const {
    return loop_state(loop, x[layout_.angle(loop.first)], x[layout_.rate(loop.first)],
                      x[layout_.angle(loop.second)], x[layout_.rate(loop.second)]);
  }

  /// Sets dxdt. With want_forces(true), the workspace has the hinge forces at x afterwards.
  void operator()(const State<T>& x, State<T>& dxdt, const T& t) { evaluate<true>(x, dxdt, t); }

  /// Sets dxdt without forces and without the moments that hold stuck hinges: for stages inside a step.
  void stage(const State<T>& x, State<T>& dxdt, const T& t) { evaluate<false>(x, dxdt, t); }

  /// Sets whether evaluations leave the hinge forces in the workspace.
  void want_forces(bool want) { wants_forces_ = want; }

private:
  template <bool forces>
  [[gnu::always_inline]] void evaluate(const State<T>& x, State<T>& dxdt, const T& t) {
    ++work_.evaluations;
    if (work_.stuck > 0) {
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

  static constexpr int first_coordinate = base_freedoms<M>; ///< φ_1 in q
  [[nodiscard]] bool has_table() const { return M == BaseMotion::prescribed && wing_.base.table; }
  [[nodiscard]] int freedoms() const { return first_coordinate + topology().bodies(); }

  void update_law(int i) {
    const Contact contact = work_.contact[i];
    const T friction = contact == Contact::forward    ? -wing_.hinges[i].kinetic_friction
                       : contact == Contact::backward ? wing_.hinges[i].kinetic_friction
                                                      : T(0);
    if constexpr (is_one_number<T>)
      if (!wing_.real.empty())
        work_.modes[i] = mode_of(wing_, i, work_.above[i], contact, latch_acts(i));
    work_.laws[i] = linear_law(wing_.hinges[i], latch_acts(i), friction, backlash_side(i));
  }

  [[nodiscard]] std::optional<T> backlash_side(int i) const {
    if (wing_.real.empty() || !latch_acts(i)) return T(0);
    return side_of_backlash(wing_.real[i], work_.above[i]);
  }

  template <bool air, class Frames>
  [[gnu::always_inline]] void apply_moments(Frames& frames, const State<T>& x, const T& t) {
    const T* const angles = x.data() + first_coordinate;
    const T* const rates = angles + freedoms();
    const LinearLaw<T>* const laws = work_.laws.data();
    const bool rubs = is_static<Topology> && wing_.rubs_alone() && !layout_.smoothed;
    topology().outward([&](int i) __attribute__((always_inline)) {
      T m = linear_moment(laws[i], angles[i - 1], rates[i - 1]);
      if (rubs) m = m + regularized_friction_moment(wing_.hinges[i], rates[i - 1]);
      frames[i].moment = m;
    });
    if (!rubs && (wing_.is_nonlinear() || layout_.smoothed)) {
      find_nonlinear_moments(x);
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

  /// Nonlinear moments. A function of its own (noinline), so that the frames stay in registers.
  [[gnu::noinline]] void find_nonlinear_moments(const State<T>& x) {
    for (int i = 1; i <= layout_.bodies; ++i) work_.nonlinear[i] = smooth_moment(x, i);
    if (wing_.is_real()) add_real_moments(x);
  }

  [[gnu::noinline]] void add_real_moments(const State<T>& x) {
    for (int i = 1; i < static_cast<int>(wing_.real.size()); ++i)
      work_.nonlinear[i] = work_.nonlinear[i] + of_real_hinge(x, i);
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
    return smooth_moment(x, i) + (wing_.real.empty() ? T(0) : of_real_hinge(x, i));
  }

  [[nodiscard]] T of_real_hinge(const State<T>& x, int i) const {
    return real_moment(wing_.real[i], work_.modes[i], x[layout_.angle(i)], x[layout_.rate(i)]);
  }

  /// Moment of regularized friction and a smoothed latch, N·m.
  [[nodiscard]] T smooth_moment(const State<T>& x, int i) const {
    const T& rate = x[layout_.rate(i)];
    T m =
        wing_.has_regularized_friction ? regularized_friction_moment(wing_.hinges[i], rate) : T(0);
    if (layout_.smoothed && wing_.hinges[i].has_latch)
      m = m + smoothed_latch_moment(wing_.hinges[i], x[layout_.angle(i)], rate, x[layout_.latch(i)],
                                    epsilon_);
    return m;
  }

  [[gnu::always_inline]] void copy_rates(const State<T>& x, State<T>& dxdt) const {
    const T* const rates = x.data() + freedoms();
    T* const velocities = dxdt.data();
    for (int k = 0; k < first_coordinate; ++k) velocities[k] = rates[k];
    topology().outward([&](int i) __attribute__((always_inline)) {
      velocities[first_coordinate + i - 1] = rates[first_coordinate + i - 1];
    });
  }

  template <bool forces, bool air, bool locks = false, class Frames>
  [[gnu::always_inline]] void evaluate(Frames& frames, const State<T>& x, State<T>& dxdt,
                                       const T& t) {
    place_base<M>(wing_, layout_, work_.driven, frames[0], x, t);
    place_bodies<M>(wing_, topology(), frames, x);
    apply_moments<air>(frames, x, t);
    topology().inward([&](int i) __attribute__((always_inline)) {
      if constexpr (locks)
        gather_with_locks(wing_, topology(), frames, work_.crossings, i, is_locked(i));
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

  const Wing<T>& wing_;
  Workspace<T>& work_;
  Layout layout_;
  T epsilon_;
  bool wants_forces_ = false;
};

} // namespace wingspread
