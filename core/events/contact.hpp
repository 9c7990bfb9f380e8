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

/// The stuck hinges whose friction exceeds `slack` times its limit by more than release_margin, with the sense in which
/// they start to slide.
/// @param slides a hinge that begins to slide whatever its friction; 0: none
template <class T, class AnySystem>
[[nodiscard]] Contacts too_weakly_held(const AnySystem& system, const State<T>& x, const T& slack,
                                       int slides) {
  using std::abs;
  Contacts moves;
  for (int i = 1; i <= system.layout().bodies; ++i) {
    if (!system.is_locked(i)) continue;
    const T friction = system.locking_moment(x, i);
    const T limit = system.static_limit(x, i);
    const T most = fused(slack, limit, release_margin(system, x, i, limit));
    if (i == slides || abs(friction) > most) moves.emplace_back(i, sliding(T(-friction)));
  }
  return moves;
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

/// If any of these hinges has just come to rest, keeps only such hinges and the one that is due.
inline void keep_newly_at_rest(Contacts& moves, const std::vector<Rest>& rests, int due) {
  const auto is_new = [&](const auto& move) { return rests[move.first] == Rest::just_now; };
  if (std::ranges::any_of(moves, is_new))
    std::erase_if(moves, [&](const auto& move) { return !is_new(move) && move.first != due; });
}

} // namespace detail

/// Decides at (x, t) which hinges with exact friction stick: those in motion slide; those at rest stick if their
/// static limit holds them, and slide in the direction of the load otherwise. Sets dxdt with these contacts.
///
/// First all hinges at rest stick. All that exceed their limits are released together, until none does: the result
/// does not depend on the hinges' order. Hinges that have just come to rest are released first: one that turns back would
/// load a stuck hinge far more if it stuck too, but it does not. Released hinges that then accelerate against their sense
/// of sliding stick again. After 16 rounds one hinge changes per round, the first wrong one [Murty 1974: least-index
/// pivoting ends for a positive definite mass matrix; the contacts are unique where τ_s = τ_c]. After 64 more rounds per
/// hinge, which no tested wing has needed, the contacts stay as they are (heuristic limit).
/// @param slides a hinge that begins to slide, even if rounding leaves it within its limit; 0: none
template <class T, class AnySystem>
void sort_contacts(AnySystem& system, const State<T>& x, State<T>& dxdt, const T& t, int slides) {
  std::vector<detail::Rest> rests = detail::lock_hinges_at_rest(system, x);
  const T slack(slides != 0 ? 1 + slip_tolerance : 1 + 1e-12);
  const std::size_t together = 16, most = together + 64 * rests.size();
  for (std::size_t round = 0;; ++round) {
    system(x, dxdt, t);
    detail::Contacts moves = detail::too_weakly_held(system, x, slack, slides);
    detail::keep_newly_at_rest(moves, rests, slides);
    slides = 0;
    if (moves.empty() || round > together) {
      const detail::Contacts back = detail::running_against_friction(system, x, dxdt, rests);
      moves.insert(moves.end(), back.begin(), back.end());
    }
    if (moves.empty() || round > most) return;
    if (round > together) moves = {*std::min_element(moves.begin(), moves.end())};
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

/// Whether a sliding hinge is at rest at t or at an instant simultaneous with t.
/// @param rate, slope φ̇ and φ̈ times minus the sense of sliding
template <class T> [[nodiscard]] auto rests_at(const T& t, const T& rate, const T& slope) {
  return rate > T(0) || (slope > T(0) && rate + one_instant(t) * slope >= T(0));
}

/// Where friction sticks: the first s in [0, 1] at which sliding hinge i comes to rest; none if it does not.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_rest(const AnySystem& system, const Step<T>& step, int i) {
  return first_nonnegative(way_to_rest(system.layout(), step, i, T(-sliding_sense(system, i))));
}

/// Sets the rate of hinge `due` (0: none) to zero at the start of a step, and that of every hinge that comes to rest
/// simultaneously. @return whether any came to rest
template <class T, class AnySystem>
bool stop_simultaneous(const AnySystem& system, int due, Step<T>& step) {
  const Layout& at = system.layout();
  bool any = false;
  for (int i = 1; i <= at.bodies; ++i) {
    const T against(-sliding_sense(system, i));
    if (against == T(0)) continue;
    const T rate = against * step.x[at.rate(i)], slope = against * step.dxdt[at.rate(i)];
    if (i != due && !rests_at(step.t, rate, slope)) continue;
    step.x[at.rate(i)] = T(0);
    any = true;
  }
  return any;
}

} // namespace wingspread
