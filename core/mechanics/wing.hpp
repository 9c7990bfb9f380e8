/// A scene made ready for the recursion: outward order, and what every evaluation would otherwise
/// compute again. Const while it is integrated.
#pragma once

#include "core/laws/air.hpp"
#include "core/laws/loop.hpp"
#include "core/laws/real_hinge.hpp"
#include "core/mechanics/tree.hpp"
#include "core/number/planar.hpp"
#include "core/scene/scene.hpp"

#include <algorithm>
#include <vector>

namespace wingspread {

/// A body about its own hinge; the free base about its centre of mass.
template <class T> struct BodyTerms {
  T mass;    ///< m_i, kg
  T inertia; ///< J_i + m_i |c_ii|², kg·m²
  /// −m_i c_ii: m_i times the way from the hinge to the centre of mass, own frame, kg·m
  Vec2<T> mass_moment;
  /// c_pi − c_pp: from the parent's hinge (the base's origin) to hinge i, parent's frame, m
  Vec2<T> arm;
  Vec2<T> center;    ///< −c_ii, own frame, m
  T central_inertia; ///< J_i, kg·m²
  T minus_inverse;   ///< −1/inertia, 1/(kg·m²)
};

/// A hinge's law (spring, harness, friction, latch), about the latched angle.
template <class T> struct HingeTerms {
  T stowed, latched; ///< rad
  T sense;           ///< sign(latched − stowed)
  T drive;           ///< s·(spring − harness) at the latched angle, N·m
  T drive_slope;     ///< its derivative by φ, N·m/rad
  T viscous;         ///< N·m·s/rad
  // of the two models of Coulomb's friction a hinge has one, and zeros for the other
  T regularized_friction; ///< τ_c, N·m
  T slip_rate;            ///< ω_s of the regularized friction, rad/s
  T kinetic_friction;     ///< τ_c of the exact friction, N·m
  T static_friction;      ///< τ_s of the exact friction, the most that it can hold, N·m
  /// The most that a torque test both ways adds to either of them, N·m; 0 where there is none.
  T more_regularized, more_exact;
  bool has_latch;
  T stiffness; ///< of the latch once engaged, N·m/rad
  T damping;   ///< N·m·s/rad

  /// Whether the friction is exact: then it holds the hinge at rest, up to a limit.
  [[nodiscard]] bool can_stick() const { return static_friction + more_exact > T(0); }
  /// The most that regularized friction adds to the moment, N·m.
  [[nodiscard]] T most_regularized() const { return regularized_friction + more_regularized; }
  /// The most that exact friction can hold, N·m.
  [[nodiscard]] T most_static() const { return static_friction + more_exact; }
  /// The most that friction, of whichever model, adds to the moment, N·m.
  [[nodiscard]] T most_friction() const { return most_regularized() + most_static(); }
};

template <class T> struct BaseTerms {
  BaseMotion motion;
  Vec2<T> acceleration;   ///< prescribed, m/s²
  Vec2<T> gravity;        ///< m/s²
  T angular_acceleration; ///< prescribed, rad/s²
  T angle, rate;          ///< at the start, rad, rad/s
  Vec2<T> position, velocity;
  const BaseTable* table; ///< prescribed, in place of what it gives; null: none
  T table_scale;

  /// The acceleration that the wing feels where it is constant, m/s².
  [[nodiscard]] Vec2<T> felt() const { return acceleration - gravity; }
};

template <class T> struct Wing {
  BaseTerms<T> base;
  Tree tree;
  std::vector<int> hinge_of;             ///< body i → its hinge's index in the scene; [0] unused
  std::vector<BodyTerms<T>> bodies;      ///< 0 … n
  std::vector<HingeTerms<T>> hinges;     ///< 0 … n; [0] unused
  std::vector<T> initial_rates;          ///< 0 … n; rad/s
  bool has_regularized_friction = false; ///< any hinge; else its pass is skipped
  bool can_stick = false;                ///< any hinge
  // what a scene without does not pay for: empty where no hinge, no body has any
  std::vector<RealHingeTerms<T>> real; ///< 0 … n; [0] unused
  std::vector<LoopTerms<T>> loops;
  std::vector<PlateTerms<T>> plates; ///< 0 … n; [0] unused: those of a free base are not asked for

  [[nodiscard]] int size() const { return tree.bodies(); }
  /// Whether hinges have moments beyond their linear laws, friction and latches.
  [[nodiscard]] bool is_real() const { return !real.empty() || !loops.empty(); }
  /// Whether any moment is not linear in angles and rates.
  [[nodiscard]] bool is_nonlinear() const { return has_regularized_friction || is_real(); }
  /// Whether regularized friction alone is not.
  [[nodiscard]] bool rubs_alone() const { return has_regularized_friction && !is_real(); }
};

namespace detail {

[[nodiscard]] inline bool has_plate(const Body& body) { return body.plate.has_value(); }

/// How a base moves: one that is fixed stands in gravity as one that is driven upwards does.
[[nodiscard]] inline BaseMotion motion_of_base(const Scene& scene) {
  const bool weighs = scene.environment.gravity != Eigen::Vector2d::Zero();
  return scene.base.motion == BaseMotion::fixed && weighs ? BaseMotion::prescribed
                                                          : scene.base.motion;
}

/// None where the base is not driven.
[[nodiscard]] inline const BaseTable* table_of_base(const Scene& scene) {
  return scene.base.motion == BaseMotion::prescribed ? scene.base.table.get() : nullptr;
}

template <class T> [[nodiscard]] Vec2<T> vec2(const Eigen::Vector2d& v) {
  return {T(v.x()), T(v.y())};
}

/// What is linear of a torque where its law without a table gives `law`: the offset alone where it
/// has one.
template <class T> [[nodiscard]] T linear_part(const HingeTorque& torque, double law) {
  return torque.table ? T(torque.offset) : T(torque.scale) * T(law) + T(torque.offset);
}

/// Written where they stand, as all numbers of a wing are: a copy of what has just been written in
/// parts waits for these.
template <class T> void set_hinge(HingeTerms<T>& terms, const Hinge& hinge) {
  const T travel = T(hinge.latched) - T(hinge.stowed);
  const T sense = select(travel > T(0), T(1), T(-1));
  const T at_stowed = linear_part<T>(hinge.spring, hinge.spring.torque_stowed) -
                      linear_part<T>(hinge.harness, hinge.harness.torque_stowed);
  const T at_latched = linear_part<T>(hinge.spring, hinge.spring.torque_latched) -
                       linear_part<T>(hinge.harness, hinge.harness.torque_latched);
  terms.stowed = T(hinge.stowed);
  terms.latched = T(hinge.latched);
  terms.sense = sense;
  terms.drive = sense * at_latched;
  terms.drive_slope = sense * (at_latched - at_stowed) / travel;
  const bool exact = hinge.friction.model == FrictionModel::exact;
  const T scale(hinge.friction.scale), level = scale * T(hinge.friction.coulomb);
  terms.regularized_friction = exact ? T(0) : level;
  terms.kinetic_friction = exact ? level : T(0);
  terms.static_friction =
      exact ? scale * T(hinge.friction.static_level.value_or(hinge.friction.coulomb)) : T(0);
  terms.viscous = scale * T(hinge.friction.viscous);
  terms.slip_rate = T(hinge.friction.regularization_rate);
  terms.more_regularized = terms.more_exact = T(0);
  terms.has_latch = hinge.latch.has_value();
  terms.stiffness = T(hinge.latch ? hinge.latch->stiffness : 0);
  terms.damping = T(hinge.latch ? hinge.latch->damping : 0);
}

template <class T>
void set_body(BodyTerms<T>& terms, double mass, double inertia, const Vec2<T>& center,
              const Vec2<T>& arm) {
  const T about_hinge = fused(T(mass), dot(center, center), T(inertia));
  terms.mass = T(mass), terms.inertia = about_hinge;
  terms.mass_moment.x = T(mass) * center.x, terms.mass_moment.y = T(mass) * center.y;
  terms.arm.x = arm.x, terms.arm.y = arm.y;
  terms.center.x = center.x, terms.center.y = center.y;
  terms.central_inertia = T(inertia), terms.minus_inverse = T(-1) / about_hinge;
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

/// The wing of a scene's topology; its numbers are not set yet. Cost O(n).
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
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(), detail::has_plate))
    wing.plates.resize(n + 1);
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
  (real.regularized ? terms.more_regularized : terms.more_exact) = real.most_friction;
}

/// @pre those of its hinges are set
template <class T>
void set_loop(const Wing<T>& wing, const Synchronisation& loop, LoopTerms<T>& terms) {
  const HingeTerms<T>&a = wing.hinges[terms.first], &b = wing.hinges[terms.second];
  terms.table = loop.table.get();
  terms.ratio = T(loop.ratio);
  terms.stiffness = T(loop.stiffness), terms.damping = T(loop.damping);
  terms.slack_beyond = loop.preload ? T(2) * T(*loop.preload) : T(1e300);
  terms.stowed_a = a.stowed, terms.stowed_b = b.stowed;
  terms.sense_a = a.sense, terms.sense_b = b.sense;
}

} // namespace detail

/// Whether a wing made of another scene of this tree has room for all that this scene has: draws
/// may give it a backlash, or gravity, that the other had not.
template <class T> [[nodiscard]] bool has_room(const Wing<T>& wing, const Scene& scene) {
  const auto is_of = [&](const LoopTerms<T>& terms, const Synchronisation& loop) {
    return wing.hinge_of[terms.first] == loop.first && wing.hinge_of[terms.second] == loop.second;
  };
  return wing.base.motion == detail::motion_of_base(scene) &&
         (wing.base.table != nullptr) == (detail::table_of_base(scene) != nullptr) &&
         (!wing.real.empty() || std::none_of(scene.hinges.begin(), scene.hinges.end(), is_real)) &&
         (!wing.plates.empty() ||
          std::none_of(scene.bodies.begin(), scene.bodies.end(), detail::has_plate)) &&
         std::equal(wing.loops.begin(), wing.loops.end(), scene.synchronisations.begin(),
                    scene.synchronisations.end(), is_of);
}

/// Sets every number of `wing` from a scene of its topology. Cost O(n), allocates nothing.
template <class T> void set_parameters(Wing<T>& wing, const Scene& scene) {
  using detail::vec2;
  const Base& base = scene.base;
  detail::set_base(wing.base, scene);
  detail::set_body(wing.bodies[0], base.mass, base.inertia, {T(0), T(0)}, {T(0), T(0)});
  wing.has_regularized_friction = wing.can_stick = false;
  for (int i = 1; i <= wing.size(); ++i) {
    const Hinge& hinge = scene.hinges[wing.hinge_of[i]];
    const Body& body = scene.bodies[hinge.child];
    const int p = wing.tree.parent_of(i);
    // the parent's centre of mass lies at `center` from its hinge; the base's own at its origin
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
  }
  for (std::size_t k = 0; k < wing.loops.size(); ++k)
    detail::set_loop(wing, scene.synchronisations[k], wing.loops[k]);
}

} // namespace wingspread
