/// The right-hand side of a wing's equations of motion, and the layout of its state.
#pragma once

#include "core/hinge_moment.hpp"
#include "core/recursion.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

template <class T> using State = std::vector<T>;

/// Where things stand in the state: q = (x, y, θ_0 of a free base; φ_1 … φ_n), then q̇, then S_1 …
/// S_n of smoothed latches.
struct Layout {
  int base = 0; ///< 3 for a free base, else 0
  int bodies = 0;
  bool smoothed = false;

  [[nodiscard]] int freedoms() const { return base + bodies; }
  [[nodiscard]] int size() const { return 2 * freedoms() + (smoothed ? bodies : 0); }
  [[nodiscard]] int angle(int i) const { return base + i - 1; }           ///< φ_i
  [[nodiscard]] int rate(int i) const { return freedoms() + angle(i); }   ///< φ̇_i
  [[nodiscard]] int latch(int i) const { return 2 * freedoms() + i - 1; } ///< S_i
};

/// What changes from phase to phase of a run, and scratch space. Owned by the caller, one a thread.
template <class T> struct Workspace {
  std::vector<BodyFrame<T>> frames; ///< 0 … n
  std::vector<Vec2<T>>
      forces; ///< 1 … n: on body i at its hinge, at the last evaluation; if asked for
  std::vector<LinearLaw<T>> laws; ///< 1 … n
  std::vector<T> nonlinear;       ///< 1 … n: moments of friction and smoothed latches, N·m
  std::vector<char> engaged;      ///< 1 … n: has passed its latched angle
  long evaluations = 0;
};

/// dx/dt of one wing. Motion is the base's; Topology a Tree or a Chain<N>.
template <class T, class Topology, BaseMotion Motion> class System {
public:
  System(const Wing<T>& wing, const Topology& topology, const std::optional<double>& smoothing,
         Workspace<T>& work)
      : wing_(wing), topology_(topology),
        work_(work), layout_{first_coordinate, topology.bodies(), smoothing.has_value()},
        epsilon_(smoothing.value_or(0)) {
    work_.frames.assign(layout_.bodies + 1, BodyFrame<T>{});
    work_.forces.assign(layout_.bodies + 1, {T(0), T(0)});
    work_.laws.resize(layout_.bodies + 1);
    work_.nonlinear.resize(layout_.bodies + 1);
    work_.engaged.assign(layout_.bodies + 1, false);
    work_.evaluations = 0;
    for (int i = 1; i <= layout_.bodies; ++i) update_law(i);
  }

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const Wing<T>& wing() const { return wing_; }
  [[nodiscard]] const Topology& topology() const { return topology_; }
  [[nodiscard]] const Workspace<T>& work() const { return work_; }
  [[nodiscard]] const T& epsilon() const { return epsilon_; }

  /// The state at t = 0.
  void start(State<T>& x) const {
    x.assign(layout_.size(), T(0));
    if constexpr (Motion == BaseMotion::free) {
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

  /// Records that hinge i has passed its latched angle; an event latch acts from now on.
  void engage(int i) {
    work_.engaged[i] = true;
    update_law(i);
  }

  /// Kinematics alone: places every body in the workspace's frames.
  void place_all(const State<T>& x, const T& t) {
    place_base(work_.frames[0], x, t);
    place_bodies(work_.frames, x);
  }

  /// Moment of hinge i, N·m.
  [[nodiscard]] T moment(const State<T>& x, int i) const {
    const T linear = linear_moment(work_.laws[i], x[layout_.angle(i)], x[layout_.rate(i)]);
    return wing_.has_coulomb || layout_.smoothed ? linear + nonlinear_moment(x, i) : linear;
  }

  /// dx/dt; with `want_forces`, afterwards the workspace's forces are those at x.
  void operator()(const State<T>& x, State<T>& dxdt, const T& t) {
    ++work_.evaluations;
    if constexpr (is_static<Topology>) {
      std::array<BodyFrame<T>, Topology::bodies() + 1> frames; // in registers
      evaluate(frames, x, dxdt, t);
    } else {
      evaluate(work_.frames, x, dxdt, t);
    }
  }

  /// Whether evaluations leave the hinge forces in the workspace.
  void want_forces(bool want) { wants_forces_ = want; }

private:
  static constexpr int first_coordinate = Motion == BaseMotion::free ? 3 : 0; ///< φ_1 in q
  [[nodiscard]] int freedoms() const { return first_coordinate + topology_.bodies(); }

  void update_law(int i) {
    const bool acts = work_.engaged[i] && wing_.hinges[i].has_latch && !layout_.smoothed;
    work_.laws[i] = linear_law(wing_.hinges[i], acts);
  }

  template <class Frames>
  [[gnu::always_inline]] void place_bodies(Frames& frames, const State<T>& x) {
    const T* const angles = x.data() + first_coordinate;
    const T* const rates = angles + freedoms();
    topology_.outward([&](int i) __attribute__((always_inline)) {
      turn<Motion>(topology_, frames, i, angles[i - 1], rates[i - 1]);
    });
    topology_.outward([&](int i) __attribute__((always_inline)) {
      place<Motion>(wing_, topology_, frames, i);
    });
  }

  template <class Frames>
  [[gnu::always_inline]] void apply_moments(Frames& frames, const State<T>& x) {
    const T* const angles = x.data() + first_coordinate;
    const T* const rates = angles + freedoms();
    const LinearLaw<T>* const laws = work_.laws.data();
    topology_.outward([&](int i) __attribute__((always_inline)) {
      frames[i].moment = linear_moment(laws[i], angles[i - 1], rates[i - 1]);
    });
    if (!wing_.has_coulomb && !layout_.smoothed) return;
    find_nonlinear_moments(x);
    topology_.outward([&](int i) __attribute__((always_inline)) {
      frames[i].moment = frames[i].moment + work_.nonlinear[i];
    });
  }

  /// What friction and smoothed latches add, apart from the frames so that these stay in registers.
  [[gnu::noinline]] void find_nonlinear_moments(const State<T>& x) {
    for (int i = 1; i <= layout_.bodies; ++i) work_.nonlinear[i] = nonlinear_moment(x, i);
  }

  [[nodiscard]] T nonlinear_moment(const State<T>& x, int i) const {
    const T& rate = x[layout_.rate(i)];
    T m = wing_.has_coulomb ? coulomb_moment(wing_.hinges[i], rate) : T(0);
    if (layout_.smoothed && wing_.hinges[i].has_latch)
      m = m + smoothed_latch_moment(wing_.hinges[i], x[layout_.angle(i)], rate, x[layout_.latch(i)],
                                    epsilon_);
    return m;
  }

  /// q̇ is part of the state.
  [[gnu::always_inline]] void copy_rates(const State<T>& x, State<T>& dxdt) const {
    const T* const rates = x.data() + freedoms();
    T* const velocities = dxdt.data();
    for (int k = 0; k < first_coordinate; ++k) velocities[k] = rates[k];
    topology_.outward([&](int i) __attribute__((always_inline)) {
      velocities[first_coordinate + i - 1] = rates[first_coordinate + i - 1];
    });
  }

  template <class Frames>
  [[gnu::always_inline]] void evaluate(Frames& frames, const State<T>& x, State<T>& dxdt,
                                       const T& t) {
    place_base(frames[0], x, t);
    place_bodies(frames, x);
    apply_moments(frames, x);
    topology_.inward([&](int i)
                         __attribute__((always_inline)) { gather(wing_, topology_, frames, i); });
    accelerate_base(frames, dxdt);
    T* const accelerations = dxdt.data() + first_coordinate + freedoms();
    topology_.outward([&](int i) __attribute__((always_inline)) {
      accelerations[i - 1] = accelerate<Motion>(topology_, frames, i);
    });
    copy_rates(x, dxdt);
    if (layout_.smoothed) advance_latches(x, dxdt);
    if (wants_forces_)
      topology_.outward([&](int i) __attribute__((always_inline)) {
        work_.forces[i] = hinge_force(frames[i]);
      });
  }

  [[gnu::always_inline]] void place_base(BodyFrame<T>& base, const State<T>& x, const T& t) const {
    if constexpr (Motion == BaseMotion::fixed) {
      base.angle = base.rate = base.minus_rate_squared = base.angular_acceleration = T(0);
      base.acceleration = {T(0), T(0)};
      base.rotation = {T(0), T(1)};
      return;
    }
    if constexpr (Motion == BaseMotion::prescribed) {
      const BaseTerms<T>& given = wing_.base;
      base.rate = fused(given.angular_acceleration, t, given.rate);
      base.angle = fused(t, fused(T(0.5) * given.angular_acceleration, t, given.rate), given.angle);
      base.acceleration = given.acceleration;
      base.angular_acceleration = given.angular_acceleration;
    }
    if constexpr (Motion == BaseMotion::free) {
      base.angle = x[2];
      base.rate = x[layout_.freedoms() + 2];
      base.moment = T(0);
      base.mass_moment = {T(0), T(0)};
    }
    base.minus_rate_squared = -(base.rate * base.rate);
    base.rotation = sine_cosine(base.angle);
  }

  template <class Frames>
  [[gnu::always_inline]] void accelerate_base(Frames& frames, State<T>& dxdt) const {
    if constexpr (Motion == BaseMotion::free) {
      BodyFrame<T>& base = frames[0];
      gather(wing_, topology_, frames, 0);
      release_base(base);
      const int v = layout_.freedoms();
      dxdt[v] = base.acceleration.x, dxdt[v + 1] = base.acceleration.y;
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
  const Topology& topology_;
  Workspace<T>& work_;
  Layout layout_;
  T epsilon_;
  bool wants_forces_ = false;
};

} // namespace wingspread
