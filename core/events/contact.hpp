/// Exact Coulomb friction: which hinges stick, which slide, and what ends either.
///
/// A hinge that slides has the constant friction −τ_c sign φ̇ until its rate reaches zero; one that
/// sticks is a locked hinge of the recursion (augmented.hpp), until the friction f that holds it
/// passes the static limit τ_s. Both are events. At each, the hinges at rest are sorted anew.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/holding.hpp"
#include "core/events/instant.hpp"
#include "core/mechanics/system.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace wingspread {

/// The sense in which hinge i slides: −1, 1, or 0 when it does not or has no exact friction.
template <class AnySystem> [[nodiscard]] int sliding_sense(const AnySystem& system, int i) {
  const Contact contact = system.work().contact[i];
  return contact == Contact::stuck ? 0 : static_cast<int>(contact);
}

namespace detail {

using Contacts = std::vector<std::pair<int, Contact>>; ///< of some hinges

template <class T> [[nodiscard]] Contact sliding(const T& along) {
  return along > T(0) ? Contact::forward : Contact::backward;
}

/// Of all with exact friction: those at rest stick, the others slide. @return which are at rest
template <class T, class AnySystem>
[[nodiscard]] std::vector<char> lock_those_at_rest(AnySystem& system, const State<T>& x) {
  const Layout& at = system.layout();
  std::vector<char> resting(at.bodies + 1, false);
  for (int i = 1; i <= at.bodies; ++i) {
    if (!system.wing().hinges[i].can_stick()) continue;
    const T& rate = x[at.rate(i)];
    resting[i] = rate == T(0);
    system.touch(i, resting[i] ? Contact::stuck : sliding(rate));
  }
  return resting;
}

/// Of those that stick, which cannot be held, with the sense in which they set out.
/// @param slack times the limit is what holds; `let_go` is not held whatever its friction
template <class T, class AnySystem>
[[nodiscard]] Contacts too_weakly_held(const AnySystem& system, const State<T>& x, const T& slack,
                                       int let_go) {
  using std::abs;
  Contacts moves;
  for (int i = 1; i <= system.layout().bodies; ++i) {
    if (!system.sticks(i)) continue;
    const T friction = system.holding_friction(x, i);
    if (i == let_go || abs(friction) > slack * system.static_limit(x, i))
      moves.emplace_back(i, sliding(T(-friction)));
  }
  return moves;
}

/// Those that were at rest and have been let go, but set out against their own friction.
template <class T, class AnySystem>
[[nodiscard]] Contacts running_against_friction(const AnySystem& system, const State<T>& x,
                                                const State<T>& dxdt,
                                                const std::vector<char>& resting) {
  Contacts moves;
  for (int i = 1; i <= system.layout().bodies; ++i) {
    if (!resting[i] || system.sticks(i)) continue;
    const T along = T(sliding_sense(system, i)) * dxdt[system.layout().rate(i)];
    const T none =
        T(release_tolerance) * system.static_limit(x, i) / system.wing().bodies[i].central_inertia;
    if (!(along > -none)) moves.emplace_back(i, Contact::stuck);
  }
  return moves;
}

} // namespace detail

/// Sorts the hinges with exact friction at (x, t): those in motion slide; of those at rest, all
/// that can be held stick, and the others set out in the direction of what moves them. Evaluates;
/// at the end dxdt is the derivative with the contacts as they are then.
///
/// All at rest are locked first, and all that exceed their limits let go at once, until none does:
/// independent of the hinges' order. Those that would then run against their own friction are locked
/// again. Where that goes round in circles, one hinge is moved at a time, the first that is wrong
/// [Murty 1974: least-index pivoting ends for a positive definite mass matrix, whose contacts are
/// unique where τ_s = τ_c]; after 64 of these a hinge, which no wing has needed, the rest slide as
/// they are.
/// @param let_go a hinge whose release is due: it is held no more though rounding may say so;
///               0: none
template <class T, class AnySystem>
void sort_contacts(AnySystem& system, const State<T>& x, State<T>& dxdt, const T& t, int let_go) {
  const std::vector<char> resting = detail::lock_those_at_rest(system, x);
  const T slack(let_go != 0 ? 1 + release_tolerance : 1 + 1e-12);
  const std::size_t together = 16, most = together + 64 * resting.size();
  for (std::size_t round = 0;; ++round) {
    system(x, dxdt, t);
    detail::Contacts moves = detail::too_weakly_held(system, x, slack, let_go);
    let_go = 0;
    if (moves.empty() || round > together) {
      const detail::Contacts back = detail::running_against_friction(system, x, dxdt, resting);
      moves.insert(moves.end(), back.begin(), back.end());
    }
    if (moves.empty() || round > most) return;
    if (round > together) moves = {*std::min_element(moves.begin(), moves.end())};
    for (const auto& [i, contact] : moves) system.touch(i, contact);
  }
}

/// What is negative over the step for as long as hinge i, which slides, has not come to rest: its
/// rate, against the sense in which it slides. A hinge that has just set out is at rest at s = 0,
/// which does not count; one let go at its limit with τ_s = τ_c has no acceleration there either.
/// For one number or for a pack of them: where the coefficients are negative the lanes of packs know
/// as much as the run alone.
/// @param against the sense in which it would turn back: −1 or 1
template <class T>
[[nodiscard]] Quintic<T> way_to_rest(const Layout& at, const Step<T>& step, int i,
                                     const T& against) {
  using std::abs;
  Quintic<T> rate = derivative(step.coordinate(at.angle(i), at.freedoms()), step.h);
  const int r = at.rate(i);
  const T angle = larger(T(abs(step.x[at.angle(i)])), T(abs(step.x1[at.angle(i)])));
  const T moved = step.h * larger(T(abs(step.x[r])), T(abs(step.x1[r])));
  const auto drowned = T(64 * epsilon_of<T>) * angle > T(1e-6) * moved; // by the angle's rounding
  if (any(drowned))
    rate = chosen(drowned,
                  cubic_hermite(step.h, step.x[r], step.dxdt[r], step.x1[r], step.dxdt1[r]), rate);
  for (T& c : rate) c = against * c;
  const auto sets_out = step.x[r] == T(0);
  return any(sets_out) ? chosen(sets_out, without_root_at_start(rate), rate) : rate;
}

/// Whether a hinge has come to rest at t, or does at the same instant.
/// @param rate, slope φ̇ and φ̈, against the sense in which it slides
template <class T> [[nodiscard]] auto rests_at(const T& t, const T& rate, const T& slope) {
  return rate > T(0) || (slope > T(0) && rate + one_instant(t) * slope >= T(0));
}

/// The first s in [0, 1] at which hinge i, which slides, comes to rest in the step; none if it does
/// not.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_rest(const AnySystem& system, const Step<T>& step, int i) {
  return first_nonnegative(way_to_rest(system.layout(), step, i, T(-sliding_sense(system, i))));
}

/// At the start of a step: brings to rest the hinge that was due (0: none), and every other that
/// slides and comes to rest at the same instant. @return whether there was any
template <class T, class AnySystem>
bool rest_those_there(const AnySystem& system, int due, Step<T>& step) {
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
