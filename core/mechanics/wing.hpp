/// A scene prepared for the recursion: bodies in outward order, with the constants of every evaluation. Const while
/// a run is integrated.
///
/// | symbol | meaning                                             | shape | unit  | source         |
/// |--------|-----------------------------------------------------|-------|-------|----------------|
/// | m_i, J_i | mass; inertia about the centre of mass            |       | kg, kg·m² | Yudintsev, eq. 1 |
/// | c_ii   | from body i's centre of mass to hinge i, own frame  | 2     | m     | Yudintsev, eq. 2 |
/// | c_pi   | from the parent's centre of mass to hinge i         | 2     | m     | Yudintsev, eq. 2 |
/// | g      | −c_ii: from hinge i to the centre of mass           | 2     | m     |                |
#pragma once

#include "core/laws/air.hpp"
#include "core/laws/driven_base.hpp"
#include "core/laws/hinge_terms.hpp"
#include "core/laws/loop.hpp"
#include "core/laws/motor.hpp"
#include "core/laws/real_hinge.hpp"
#include "core/mechanics/tree.hpp"
#include "core/number/planar.hpp"
#include "core/scene/scene.hpp"

#include <algorithm>
#include <vector>

namespace wingspread {

/// Constants of a body about its own hinge; of a free base about its centre of mass.
template <class T> struct BodyTerms {
  T mass;    ///< m_i, kg
  T inertia; ///< J_i + m_i |c_ii|², kg·m²
  /// m_i g, own frame, kg·m
  Vec2<T> mass_moment;
  /// c_pi − c_pp: from the parent's hinge (the base's origin) to hinge i, parent's frame, m
  Vec2<T> arm;
  Vec2<T> center;              ///< g, own frame, m
  T central_inertia;           ///< J_i, kg·m²
  T minus_inverse;             ///< −1/inertia, 1/(kg·m²)
  T arm_length, center_length; ///< of arm and center, m
};

/// When the hold of a hinge lets go.
template <class T> struct ReleaseTerms {
  bool present;
  Release::Event event;
  int after; ///< body of the hinge whose event counts; 0: none
  T time;    ///< s
  T angle;   ///< of Event::passed: of that hinge, rad
  T delay;   ///< s
  T fails;   ///< 1: never
  bool is_elastic;
  T stiffness, damping; ///< of an elastic hold, N·m/rad and N·m·s/rad
};

template <class T> struct Wing {
  BaseTerms<T> base;
  Tree tree;
  std::vector<int> hinge_of;             ///< body i → its hinge's index in the scene; [0] unused
  std::vector<BodyTerms<T>> bodies;      ///< 0 … n
  std::vector<HingeTerms<T>> hinges;     ///< 0 … n; [0] unused
  std::vector<T> initial_rates;          ///< 0 … n; rad/s
  bool has_regularized_friction = false; ///< of any hinge
  bool can_stick = false;                ///< of any hinge
  // empty where no hinge or body has the feature, which then costs nothing
  std::vector<RealHingeTerms<T>> real; ///< 0 … n; [0] unused
  std::vector<LoopTerms<T>> loops;
  std::vector<PlateTerms<T>> plates;     ///< 0 … n; [0] unused: a free base has no plate
  std::vector<ReleaseTerms<T>> releases; ///< 0 … n; [0] unused
  std::vector<MotorTerms<T>> motors;     ///< 0 … n; [0] unused
  bool can_let_go = false;               ///< whether the latch of any hinge may let go again

  [[nodiscard]] int size() const { return tree.bodies(); }
  /// Whether any hinge has laws of real_hinge.hpp, loops or motors.
  [[nodiscard]] bool is_real() const { return !real.empty() || !loops.empty() || !motors.empty(); }
  /// Whether any moment is not linear in angles and rates.
  [[nodiscard]] bool is_nonlinear() const { return has_regularized_friction || is_real(); }
  /// Whether regularized friction is the only nonlinear moment.
  [[nodiscard]] bool has_friction_alone() const { return has_regularized_friction && !is_real(); }
};

namespace detail {

[[nodiscard]] inline bool has_plate(const Body& body) { return body.plate.has_value(); }
[[nodiscard]] inline bool has_motor(const Hinge& hinge) { return hinge.motor.has_value(); }
/// Whether air acts on plates. Without air a plate has no effect on a run: the wing is treated as one without plates.
[[nodiscard]] inline bool feels_air(const Scene& scene) {
  return scene.environment.air_density != 0 &&
         std::any_of(scene.bodies.begin(), scene.bodies.end(), has_plate);
}
[[nodiscard]] inline bool has_release(const Hinge& hinge) { return hinge.release.has_value(); }

/// The base's motion; a fixed base under gravity is treated as one that accelerates against gravity.
[[nodiscard]] inline BaseMotion motion_of_base(const Scene& scene) {
  const bool weighs = scene.environment.gravity != Eigen::Vector2d::Zero();
  return scene.base.motion == BaseMotion::fixed && weighs ? BaseMotion::prescribed
                                                          : scene.base.motion;
}

/// The base's table; null unless the base is prescribed.
[[nodiscard]] inline const BaseTable* table_of_base(const Scene& scene) {
  return scene.base.motion == BaseMotion::prescribed ? scene.base.table.get() : nullptr;
}

template <class T> [[nodiscard]] Vec2<T> vec2(const Eigen::Vector2d& v) {
  return {T(v.x()), T(v.y())};
}

// Numbers are assigned in place: copying a freshly written struct stalls store forwarding.

template <class T>
void set_body(BodyTerms<T>& terms, double mass, double inertia, const Vec2<T>& center,
              const Vec2<T>& arm) {
  const T about_hinge = fused(T(mass), dot(center, center), T(inertia));
  terms.mass = T(mass), terms.inertia = about_hinge;
  terms.mass_moment.x = T(mass) * center.x, terms.mass_moment.y = T(mass) * center.y;
  terms.arm.x = arm.x, terms.arm.y = arm.y;
  terms.center.x = center.x, terms.center.y = center.y;
  terms.central_inertia = T(inertia), terms.minus_inverse = T(-1) / about_hinge;
  terms.arm_length = length(arm), terms.center_length = length(center);
}

template <class T> void set_base(BaseTerms<T>& terms, const Scene& scene) {
  const Base& base = scene.base;
  const bool moves = base.motion != BaseMotion::fixed;
  const auto set = [](Vec2<T>& to, const Eigen::Vector2d& from) {
    to.x = T(from.x()), to.y = T(from.y());
  };
  terms.motion = motion_of_base(scene);
  set(terms.acceleration, moves ? base.acceleration : Eigen::Vector2d(0, 0));
  set(terms.gravity, scene.environment.gravity);
  terms.angular_acceleration = T(moves ? base.angular_acceleration : 0);
  terms.angle = T(moves ? base.angle : 0), terms.rate = T(moves ? base.rate : 0);
  set(terms.position, base.position), set(terms.velocity, base.velocity);
  terms.table = table_of_base(scene), terms.table_scale = T(base.table_scale);
}

} // namespace detail

/// A wing of the scene's topology, without numbers (set_parameters sets them). Cost O(n).
/// @param order outward_order(scene), not empty
template <class T>
[[nodiscard]] Wing<T> make_wing(const Scene& scene, const std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  std::vector<int> number(n), parents(n + 1, -1);
  Wing<T> wing;
  wing.base.motion = detail::motion_of_base(scene);
  wing.base.table = detail::table_of_base(scene);
  wing.hinge_of.assign(n + 1, -1);
  for (int i = 1; i <= n; ++i) {
    const Hinge& hinge = scene.hinges[order[i - 1]];
    number[hinge.child] = i;
    parents[i] = hinge.parent == base_index ? 0 : number[hinge.parent];
    wing.hinge_of[i] = order[i - 1];
  }
  wing.tree = make_tree(std::move(parents));
  wing.bodies.resize(n + 1);
  wing.hinges.resize(n + 1);
  wing.initial_rates.resize(n + 1);
  if (std::any_of(scene.hinges.begin(), scene.hinges.end(), is_real)) wing.real.resize(n + 1);
  if (detail::feels_air(scene)) wing.plates.resize(n + 1);
  if (std::any_of(scene.hinges.begin(), scene.hinges.end(), detail::has_release))
    wing.releases.resize(n + 1);
  if (std::any_of(scene.hinges.begin(), scene.hinges.end(), detail::has_motor))
    wing.motors.resize(n + 1);
  for (const Synchronisation& loop : scene.synchronisations) {
    LoopTerms<T> terms{};
    terms.first = number[scene.hinges[loop.first].child];
    terms.second = number[scene.hinges[loop.second].child];
    wing.loops.push_back(terms);
  }
  return wing;
}

namespace detail {

template <class T>
void set_real(HingeTerms<T>& terms, RealHingeTerms<T>& real, const Hinge& hinge) {
  real = real_hinge_terms<T>(hinge, terms.sense);
  (real.friction.regularized ? terms.measured_regularized : terms.measured_exact) =
      real.friction.most;
}

/// @pre the terms of all hinges are set
template <class T> void set_release(Wing<T>& wing, const Scene& scene, int i) {
  ReleaseTerms<T>& terms = wing.releases[i];
  terms = {};
  const std::optional<Release>& release = scene.hinges[wing.hinge_of[i]].release;
  const Hold hold = scene.hinges[wing.hinge_of[i]].hold.value_or(Hold{});
  if (!release) return;
  terms = {true,
           release->event,
           0,
           T(release->time),
           T(0),
           T(release->delay),
           T(release->fails),
           scene.hinges[wing.hinge_of[i]].hold.has_value(),
           T(hold.stiffness),
           T(hold.damping)};
  if (release->event == Release::Event::time) return;
  const auto other = std::find(wing.hinge_of.begin() + 1, wing.hinge_of.end(), release->after);
  terms.after = static_cast<int>(other - wing.hinge_of.begin());
  const HingeTerms<T>& hinge = wing.hinges[terms.after];
  terms.angle = fused(hinge.sense, T(release->angle), hinge.stowed);
}

/// @pre the terms of the hinge are set
template <class T> void set_motor(Wing<T>& wing, const Scene& scene, int i) {
  MotorTerms<T>& terms = wing.motors[i];
  terms = {};
  const std::optional<Motor>& motor = scene.hinges[wing.hinge_of[i]].motor;
  if (!motor) return;
  terms = {true, motor->table.get(),
           wing.hinges[i].sense * T(motor->table ? motor->scale : motor->rate), T(motor->gain),
           T(motor->torque_limit)};
}

/// @pre the terms of the loop's hinges are set
template <class T>
void set_loop(const Wing<T>& wing, const Synchronisation& loop, LoopTerms<T>& terms) {
  const HingeTerms<T>&a = wing.hinges[terms.first], &b = wing.hinges[terms.second];
  terms.table = loop.table.get();
  terms.ratio = T(loop.ratio);
  terms.stiffness = T(loop.stiffness), terms.damping = T(loop.damping);
  terms.slack_beyond = loop.preload ? T(2) * T(*loop.preload) : T(never_slack);
  terms.stowed_a = a.stowed, terms.stowed_b = b.stowed;
  terms.sense_a = a.sense, terms.sense_b = b.sense;
}

} // namespace detail

/// Whether a wing made for another scene with this tree has exactly this scene's features; if not, make a new wing. A
/// draw may add or remove a backlash or the air. Methods, peak searches and proofs depend on which lists of the wing
/// are empty, so a wing with a list that its scene does not need would give a run other bits.
template <class T> [[nodiscard]] bool has_features_of(const Wing<T>& wing, const Scene& scene) {
  const auto is_of = [&](const LoopTerms<T>& terms, const Synchronisation& loop) {
    return wing.hinge_of[terms.first] == loop.first && wing.hinge_of[terms.second] == loop.second;
  };
  const auto any = [&](auto has) {
    return std::any_of(scene.hinges.begin(), scene.hinges.end(), has);
  };
  return wing.base.motion == detail::motion_of_base(scene) &&
         (wing.base.table != nullptr) == (detail::table_of_base(scene) != nullptr) &&
         wing.real.empty() != any(is_real) && wing.plates.empty() != detail::feels_air(scene) &&
         wing.releases.empty() != any(detail::has_release) &&
         wing.motors.empty() != any(detail::has_motor) &&
         std::equal(wing.loops.begin(), wing.loops.end(), scene.synchronisations.begin(),
                    scene.synchronisations.end(), is_of);
}

/// Sets every number of `wing` from a scene of its topology. Cost O(n), allocates nothing.
template <class T> void set_parameters(Wing<T>& wing, const Scene& scene) {
  using detail::vec2;
  const Base& base = scene.base;
  detail::set_base(wing.base, scene);
  detail::set_body(wing.bodies[0], base.mass, base.inertia, {T(0), T(0)}, {T(0), T(0)});
  wing.has_regularized_friction = wing.can_stick = wing.can_let_go = false;
  for (int i = 1; i <= wing.size(); ++i) {
    const Hinge& hinge = scene.hinges[wing.hinge_of[i]];
    const Body& body = scene.bodies[hinge.child];
    const int p = wing.tree.parent_of(i);
    // from the parent's hinge to its centre of mass, and on to hinge i; the base's centre is its origin
    const Vec2<T> arm = vec2<T>(hinge.parent_point) + wing.bodies[p].center;
    const Vec2<T> center = scaled(T(-1), vec2<T>(hinge.child_point));
    detail::set_body(wing.bodies[i], body.mass, body.inertia, center, arm);
    detail::set_hinge(wing.hinges[i], hinge);
    wing.initial_rates[i] = T(hinge.initial_rate);
    if (!wing.real.empty()) detail::set_real(wing.hinges[i], wing.real[i], hinge);
    if (!wing.plates.empty())
      wing.plates[i] = plate_terms<T>(body, center, scene.environment.air_density);
    wing.has_regularized_friction =
        wing.has_regularized_friction || wing.hinges[i].most_regularized() > T(0);
    wing.can_stick = wing.can_stick || wing.hinges[i].can_stick();
    wing.can_let_go = wing.can_let_go || (!wing.real.empty() && wing.real[i].capture.may_let_go());
  }
  for (int i = 1; i < static_cast<int>(wing.releases.size()); ++i)
    detail::set_release(wing, scene, i);
  for (int i = 1; i < static_cast<int>(wing.motors.size()); ++i) detail::set_motor(wing, scene, i);
  for (std::size_t k = 0; k < wing.loops.size(); ++k)
    detail::set_loop(wing, scene.synchronisations[k], wing.loops[k]);
}

} // namespace wingspread
