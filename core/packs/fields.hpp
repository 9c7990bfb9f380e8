/// The fields of the structs that travel between a run and a lane of packs.
///
/// A list takes its struct apart: one that misses a field does not compile, so that none can be
/// forgotten on the way.
#pragma once

#include "core/laws/linear_law.hpp"
#include "core/mechanics/energy.hpp"
#include "core/mechanics/wing.hpp"
#include "core/methods/held_back_steps.hpp"
#include "core/methods/step_control.hpp"
#include "core/number/pack.hpp"
#include "core/number/planar.hpp"
#include "core/peaks/base_peaks.hpp"
#include "core/peaks/reaction_bound.hpp"
#include "core/run/handover.hpp"

#include <array>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace wingspread {

namespace detail {

template <class S, template <class> class Struct> inline constexpr bool is_a = false;
template <class T, template <class> class Struct>
inline constexpr bool is_a<Struct<T>, Struct> = true;
/// S is Struct<T> of some number T, or the same const.
template <class S, template <class> class Struct>
concept A = is_a<std::remove_const_t<S>, Struct>;

[[nodiscard, gnu::always_inline]] inline auto fields(A<Vec2> auto& s) {
  auto& [x, y] = s;
  return std::tie(x, y);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<BaseTerms> auto& s) {
  auto& [motion, acceleration, gravity, angular_acceleration, angle, rate, position, velocity,
         table, table_scale] = s;
  return std::tie(motion, acceleration, gravity, angular_acceleration, angle, rate, position,
                  velocity, table, table_scale);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<DrivenPiece> auto& s) {
  auto& [number, from, until, x, y, turning, velocity, rate, angle] = s;
  return std::tie(number, from, until, x, y, turning, velocity, rate, angle);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<BodyTerms> auto& s) {
  auto& [mass, inertia, mass_moment, arm, center, central_inertia, minus_inverse] = s;
  return std::tie(mass, inertia, mass_moment, arm, center, central_inertia, minus_inverse);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<HingeTerms> auto& s) {
  auto& [stowed, latched, sense, drive, drive_slope, viscous, regularized_friction, slip_rate,
         kinetic_friction, static_friction, more_regularized, more_exact, has_latch, stiffness,
         damping] = s;
  return std::tie(stowed, latched, sense, drive, drive_slope, viscous, regularized_friction,
                  slip_rate, kinetic_friction, static_friction, more_regularized, more_exact,
                  has_latch, stiffness, damping);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<DamperTerms> auto& s) {
  auto& [law, strength, exponent, rate, near_zero] = s;
  return std::tie(law, strength, exponent, rate, near_zero);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<CurveTorqueTerms> auto& s) {
  auto& [curve, weight] = s;
  return std::tie(curve, weight);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<MeasuredFrictionTerms> auto& s) {
  auto& [level, weight, slip_rate, regularized, most] = s;
  return std::tie(level, weight, slip_rate, regularized, most);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<StopTerms> auto& s) {
  auto& [present, sense, stiffness, dissipation, contact_angle] = s;
  return std::tie(present, sense, stiffness, dissipation, contact_angle);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<RealHingeTerms> auto& s) {
  auto& [spring, harness, friction, has_damper, has_window, has_backlash, damper, window_low,
         window_high, stop, half_backlash] = s;
  return std::tie(spring, harness, friction, has_damper, has_window, has_backlash, damper,
                  window_low, window_high, stop, half_backlash);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<HingeMode> auto& s) {
  auto& [in_contact, damper_acts, sliding] = s;
  return std::tie(in_contact, damper_acts, sliding);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<LoopTerms> auto& s) {
  auto& [first, second, table, ratio, stiffness, damping, slack_beyond, stowed_a, stowed_b, sense_a,
         sense_b] = s;
  return std::tie(first, second, table, ratio, stiffness, damping, slack_beyond, stowed_a, stowed_b,
                  sense_a, sense_b);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<PlateTerms> auto& s) {
  auto& [from, along, normal, strength] = s;
  return std::tie(from, along, normal, strength);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<Wing> auto& s) {
  auto& [base, tree, hinge_of, bodies, hinges, initial_rates, has_regularized_friction, can_stick,
         real, loops, plates] = s;
  return std::tie(base, tree, hinge_of, bodies, hinges, initial_rates, has_regularized_friction,
                  can_stick, real, loops, plates);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<Lever> auto& s) {
  auto& [mass, arm, sigma, moment] = s;
  return std::tie(mass, arm, sigma, moment);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<LinearLaw> auto& s) {
  auto& [latched, drive, stiffness, damping] = s;
  return std::tie(latched, drive, stiffness, damping);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<StepMemory> auto& s) {
  auto& [log_error, most, h] = s;
  return std::tie(log_error, most, h);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<StepMark> auto& s) {
  auto& [time, evaluations, steps] = s;
  return std::tie(time, evaluations, steps);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<HeldBackSteps> auto& s) {
  auto& [shortest, wait_until, last_free] = s;
  return std::tie(shortest, wait_until, last_free);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<Conserved> auto& s) {
  auto& [start, velocity, spin] = s;
  return std::tie(start, velocity, spin);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<BaseExcursion> auto& s) {
  auto& [angle, rate, first_angle, first_rate] = s;
  return std::tie(angle, rate, first_angle, first_rate);
}

[[nodiscard, gnu::always_inline]] inline auto fields(A<Pace> auto& s) {
  auto& [steps, memory, held_back] = s;
  return std::tie(steps, memory, held_back);
}

} // namespace detail

/// visit(a's field, b's field) for all fields of two structs of one kind.
template <class Visit, class SA, class SB>
[[gnu::always_inline]] inline void for_each_field(SA& a, SB& b, Visit visit) {
  const auto of_a = detail::fields(a);
  const auto of_b = detail::fields(b);
  [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
    (visit(std::get<I>(of_a), std::get<I>(of_b)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(of_a)>>{});
}

/// to = from in the lanes of the mask.
template <class Mask, int W>
[[gnu::always_inline]] inline void assign_where(const Mask& mask, Pack<W>& to,
                                                const Pack<W>& from) {
  to = select(mask, from, to);
}
template <class Mask, class Packs>
[[gnu::always_inline]] inline void assign_where(const Mask& mask, Packs& to, const Packs& from) {
  for_each_field(
      to, from, [&mask](auto& part, const auto& part_from) __attribute__((always_inline)) {
        assign_where(mask, part, part_from);
      });
}

// ---- one lane of packs

template <int W> [[gnu::always_inline]] inline void set_lane(int lane, Pack<W>& to, double from) {
  to.v[lane] = from;
}
/// What any lane needs is done in all.
inline void set_lane(int /*lane*/, bool& to, bool from) { to = to || from; }
/// All lanes have the structure's own.
inline void set_lane(int /*lane*/, BaseMotion& /*to*/, BaseMotion /*from*/) {}
inline void set_lane(int /*lane*/, Tree& /*to*/, const Tree& /*from*/) {}
inline void set_lane(int /*lane*/, DamperLaw& to, DamperLaw from) { to = from; }
inline void set_lane(int /*lane*/, int& to, int from) { to = from; }
inline void set_lane(int /*lane*/, const Curve*& to, const Curve* from) { to = from; }
inline void set_lane(int /*lane*/, const BaseTable*& to, const BaseTable* from) { to = from; }
template <int W, std::size_t N>
[[gnu::always_inline]] inline void set_lane(int lane, std::array<Pack<W>, N>& to,
                                            const std::array<double, N>& from) {
  for (std::size_t k = 0; k < N; ++k) to[k].v[lane] = from[k];
}
inline void set_lane(int /*lane*/, std::vector<int>& /*to*/, const std::vector<int>& /*from*/) {}
template <class Packs, class Numbers>
[[gnu::always_inline]] inline void set_lane(int lane, std::vector<Packs>& to,
                                            const std::vector<Numbers>& from) {
  for (std::size_t k = 0; k < from.size(); ++k) set_lane(lane, to[k], from[k]);
}
template <class Packs, class Numbers>
[[gnu::always_inline]] inline void set_lane(int lane, Packs& to, const Numbers& from) {
  for_each_field(
      to, from, [lane](auto& part, const auto& part_from) __attribute__((always_inline)) {
        set_lane(lane, part, part_from);
      });
}

template <int W>
[[gnu::always_inline]] inline void get_lane(int lane, const Pack<W>& from, double& to) {
  to = from.v[lane];
}
template <class Packs, class Numbers>
[[gnu::always_inline]] inline void get_lane(int lane, const std::vector<Packs>& from,
                                            std::vector<Numbers>& to) {
  for (std::size_t k = 0; k < to.size(); ++k) get_lane(lane, from[k], to[k]);
}
template <class Packs, class Numbers>
[[gnu::always_inline]] inline void get_lane(int lane, const Packs& from, Numbers& to) {
  for_each_field(
      from, to, [lane](const auto& part_from, auto& part) __attribute__((always_inline)) {
        get_lane(lane, part_from, part);
      });
}

} // namespace wingspread
