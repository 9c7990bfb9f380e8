/// Exact Coulomb friction: which hinges stick and which slide.
///
/// A sliding hinge has the constant friction −τ_c sign φ̇ until its rate reaches zero (first_rest). A stuck hinge is
/// a locked hinge of the recursion (locked.hpp) until the friction that holds it passes the static limit τ_s
/// (slipping.hpp). Both are events. After each, sort_contacts decides anew which of the hinges at rest stick.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/instant.hpp"
#include "core/events/slipping.hpp"
#include "core/mechanics/system.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace wingspread {

/// The sense in which hinge i slides: −1 or 1; 0 if the hinge is locked or has no exact friction.
template <class AnySystem> [[nodiscard]] int sliding_sense(const AnySystem& system, int i) {
  return sense_of(system.work().contact[i]);
}

namespace detail {

using Contacts = std::vector<std::pair<int, Contact>>; ///< of some hinges

template <class T> [[nodiscard]] Contact sliding(const T& along) {
  return along > T(0) ? Contact::forward : Contact::backward;
}

/// Whether a hinge with exact friction is at rest, and since when.
enum class Rest : char { none, as_before, just_now };

/// Makes hinges with exact friction that are at rest stick, and the others slide. @return how each rests
template <class T, class AnySystem>
[[nodiscard]] std::vector<Rest> lock_hinges_at_rest(AnySystem& system, const State<T>& x) {
  const Layout& at = system.layout();
  std::vector<Rest> rests(at.bodies + 1, Rest::none);
  for (int i = 1; i <= at.bodies; ++i) {
    if (!system.wing().hinges[i].can_stick() || system.is_held(i)) continue;
    const T& rate = x[at.rate(i)];
    if (rate == T(0)) rests[i] = system.is_locked(i) ? Rest::as_before : Rest::just_now;
    system.set_contact(i, rate == T(0) ? Contact::stuck : sliding(rate));
  }
  return rests;
}

/// A stuck hinge whose friction exceeds its limit.
template <class T> struct Overload {
  int hinge;
  T use, most;   ///< friction over limit; and with release_margin, which is due to rounding
  bool falls;    ///< as it begins to slide, its friction falls: τ_s > τ_c
  Contact sense; ///< in which it begins to slide
};

/// The stuck hinges whose friction exceeds `slack` times its limit by more than release_margin, with the sense in which
/// they start to slide.
/// @param slides a hinge that begins to slide whatever its friction; 0: none
template <class T, class AnySystem>
[[nodiscard]] std::vector<Overload<T>> too_weakly_held(const AnySystem& system, const State<T>& x,
                                                       const T& slack, int slides) {
  using std::abs;
  std::vector<Overload<T>> found;
  for (int i = 1; i <= system.layout().bodies; ++i) {
    if (!system.is_locked(i)) continue;
    const T friction = system.locking_moment(x, i);
    const T limit = system.static_limit(x, i);
    const T margin = release_margin(system, x, i, limit);
    if (i != slides && !(abs(friction) > fused(slack, limit, margin))) continue;
    const auto& terms = system.wing().hinges[i];
    found.push_back({i, abs(friction) / limit, (abs(friction) + margin) / limit,
                     terms.static_friction > terms.kinetic_friction, sliding(T(-friction))});
  }
  return found;
}

/// The hinges at rest that were set sliding, and accelerate against their sense of sliding.
template <class T, class AnySystem>
[[nodiscard]] Contacts running_against_friction(const AnySystem& system, const State<T>& x,
                                                const State<T>& dxdt,
                                                const std::vector<Rest>& rests) {
  Contacts moves;
  for (int i = 1; i <= system.layout().bodies; ++i) {
    if (rests[i] == Rest::none || system.is_locked(i)) continue;
    const T along = T(sliding_sense(system, i)) * dxdt[system.layout().rate(i)];
    const T none =
        T(slip_tolerance) * system.static_limit(x, i) / system.wing().bodies[i].central_inertia;
    if (!(along > -none)) moves.emplace_back(i, Contact::stuck);
  }
  return moves;
}

/// Of overloaded hinges, which slide next: the one that is due, and the one with the largest use of its limit, with those
/// that tie. If any has just come to rest, only such hinges count beside the one that is due.
/// @param together all that count slide
template <class T>
[[nodiscard]] Contacts next_to_slide(const std::vector<Overload<T>>& overloads,
                                     const std::vector<Rest>& rests, int due, bool together) {
  const auto is_new = [&](const auto& each) { return rests[each.hinge] == Rest::just_now; };
  const bool only_new = std::ranges::any_of(overloads, is_new);
  const auto counts = [&](const auto& each) {
    return each.hinge != due && (!only_new || is_new(each));
  };
  T largest(0);
  for (const Overload<T>& each : overloads)
    if (counts(each)) largest = larger(largest, each.use);
  Contacts moves;
  for (const Overload<T>& each : overloads)
    if (each.hinge == due ||
        (counts(each) && (together || each.most >= T(1 - slip_tolerance) * largest)))
      moves.emplace_back(each.hinge, each.sense);
  return moves;
}

} // namespace detail

/// Decides at (x, t) which hinges with exact friction stick: those in motion slide; those at rest stick if their
/// static limit holds them, and slide in the direction of the load otherwise. Sets dxdt with these contacts.
///
/// First all hinges at rest stick. Then the hinge with the largest ratio of friction to limit slides, which may relieve the
/// others, and so on until none exceeds its limit. Where τ_s > τ_c the contacts are not unique; of the 600 random chains of
/// growing_loads_test.cpp all but 3 have those of loads that grow from zero (58 differ where all that exceed their limits
/// are released together, 9 where the largest excess goes first). Ties slide together: the result does not depend on the
/// hinges' order. Hinges that have just come to rest are released first: one that turns back would load a stuck
/// hinge far more if it stuck too, but it does not. Released hinges that accelerate against their sense of sliding stick
/// again, before another is released. Where τ_s = τ_c of all that exceed their limits, the contacts are unique: they slide
/// together, and stick again after that, which takes fewer rounds.
///
/// After 16 rounds and two more per hinge one hinge changes per round, the first wrong one [Murty 1974: least-index
/// pivoting ends for a positive definite mass matrix and τ_s = τ_c]. After 64 more rounds per hinge, which no tested wing
/// has needed, the contacts stay as they are (heuristic limit).
/// @param slides a hinge that begins to slide, even if rounding leaves it within its limit; 0: none
template <class T, class AnySystem>
void sort_contacts(AnySystem& system, const State<T>& x, State<T>& dxdt, const T& t, int slides) {
  std::vector<detail::Rest> rests = detail::lock_hinges_at_rest(system, x);
  const T slack(slides != 0 ? 1 + slip_tolerance : 1 + 1e-12);
  const std::size_t by_load = 16 + 2 * rests.size(), most = by_load + 64 * rests.size();
  int due = slides;
  for (std::size_t round = 0;; ++round) {
    system(x, dxdt, t);
    const auto overloads = detail::too_weakly_held(system, x, slack, due);
    const bool any_falls =
        std::ranges::any_of(overloads, [](const auto& each) { return each.falls; });
    detail::Contacts moves = detail::next_to_slide(overloads, rests, due, !any_falls);
    due = 0;
    detail::Contacts back = detail::running_against_friction(system, x, dxdt, rests);
    // A hinge that was due has no second chance: it is held again only where no other one has to slide.
    if (!moves.empty() && round <= by_load)
      std::erase_if(back, [&](const auto& move) { return !any_falls || move.first == slides; });
    if (round > by_load) {
      for (const auto& each : overloads) back.emplace_back(each.hinge, each.sense);
      if (!back.empty()) back = {*std::min_element(back.begin(), back.end())};
    }
    if (!back.empty()) moves = std::move(back);
    if (moves.empty() || round > most) return;
    for (const auto& [i, contact] : moves) {
      system.set_contact(i, contact);
      if (contact == Contact::stuck) rests[i] = detail::Rest::as_before;
    }
  }
}

/// The rate of sliding hinge i over the step, times `against`: negative until the hinge comes to rest. The root at
/// s = 0 of a hinge that has just set out is divided out, twice where the acceleration vanishes too (released at
/// its limit with τ_s = τ_c). For one number or a pack.
/// @param against minus the sense of sliding: −1 or 1
template <class T>
[[nodiscard]] Quintic<T> way_to_rest(const Layout& at, const Step<T>& step, int i,
                                     const T& against) {
  Quintic<T> rate = step.rate(at.angle(i), at.freedoms());
  for (T& c : rate) c = against * c;
  const auto sets_out = step.x[at.rate(i)] == T(0);
  return any(sets_out) ? chosen(sets_out, without_root_at_start(rate), rate) : rate;
}

/// Whether a sliding hinge is at rest now or within an instant.
/// @param rate, slope φ̇ and φ̈ times minus the sense of sliding @param instant s
template <class T>
[[nodiscard]] auto rests_within(const T& instant, const T& rate, const T& slope) {
  return rate > T(0) || (slope > T(0) && rate + instant * slope >= T(0));
}

/// The same at t or at an instant simultaneous with t.
template <class T> [[nodiscard]] auto rests_at(const T& t, const T& rate, const T& slope) {
  return rests_within(one_instant(t), rate, slope);
}

/// Where friction sticks: the first s in [0, 1] at which sliding hinge i comes to rest; none if it does not.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_rest(const AnySystem& system, const Step<T>& step, int i) {
  return first_nonnegative(way_to_rest(system.layout(), step, i, T(-sliding_sense(system, i))));
}

/// Sets the rate of hinge `due` (0: none) to zero at the start of a step, and that of every hinge that comes to rest
/// simultaneously; with a hinge that is due, within the instant of latches. @return whether any came to rest
template <class T, class AnySystem>
bool stop_simultaneous(const AnySystem& system, int due, Step<T>& step) {
  const Layout& at = system.layout();
  bool any = false;
  const T instant = due != 0 ? one_instant_of_latches(step.t) : one_instant(step.t);
  for (int i = 1; i <= at.bodies; ++i) {
    const T against(-sliding_sense(system, i));
    if (against == T(0)) continue;
    const T rate = against * step.x[at.rate(i)], slope = against * step.dxdt[at.rate(i)];
    if (i != due && !rests_within(instant, rate, slope)) continue;
    step.x[at.rate(i)] = T(0);
    any = true;
  }
  return any;
}

} // namespace wingspread
