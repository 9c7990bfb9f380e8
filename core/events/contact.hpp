/// Exact Coulomb friction: which hinges stick, which slide, and what ends either.
///
/// A hinge that slides has the constant friction −τ_c sign φ̇ until its rate reaches zero; one that
/// sticks is a locked hinge of the recursion (augmented.hpp), until the friction f that holds it
/// passes the static limit τ_s. Both are events. At each, the hinges at rest are sorted anew.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/system.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <optional>
#include <vector>

namespace wingspread {

/// Friction within this much of the limit counts as past it when another hinge is just released:
/// mirrored wings let go together.
inline constexpr double release_tolerance = 1e-9;

/// The sense in which hinge i slides: −1, 1, or 0 when it does not or has no exact friction.
template <class AnySystem> [[nodiscard]] int sliding_sense(const AnySystem& system, int i) {
  const Contact contact = system.work().contact[i];
  return contact == Contact::stuck ? 0 : static_cast<int>(contact);
}

/// Sorts the hinges with exact friction at (x, t): those in motion slide; of those at rest, all
/// that can be held stick, and the others set out in the direction of what moves them. Evaluates;
/// at the end dxdt is the derivative with the contacts as they are then.
///
/// All at rest are locked first, and all that exceed their limits released at once, until none
/// does: independent of the hinges' order. One that would then run against its own friction is
/// locked again; after 64 of these, which no wing has needed, the rest slide as they are.
/// @param let_go a hinge whose release is due: it is held no more though rounding may say so; 0:
/// none
template <class T, class AnySystem>
void settle_contacts(AnySystem& system, const State<T>& x, State<T>& dxdt, const T& t, int let_go) {
  using std::abs;
  const Layout& at = system.layout();
  const auto direction = [](const T& v) { return v > T(0) ? Contact::forward : Contact::backward; };
  std::vector<char> resting(at.bodies + 1, false);
  for (int i = 1; i <= at.bodies; ++i) {
    if (!(system.wing().hinges[i].limit > T(0))) continue;
    const T& rate = x[at.rate(i)];
    resting[i] = rate == T(0);
    system.touch(i, resting[i] ? Contact::stuck : direction(rate));
  }
  int relocks = 0;
  const T slack(let_go != 0 ? 1 + release_tolerance : 1 + 1e-12);
  for (bool changed = true; changed;) {
    changed = false;
    system(x, dxdt, t);
    std::vector<std::pair<int, Contact>> moves;
    for (int i = 1; i <= at.bodies; ++i) {
      if (!system.sticks(i)) continue;
      const T friction = system.holding_friction(x, i);
      if (i == let_go || abs(friction) > slack * system.wing().hinges[i].limit)
        moves.emplace_back(i, direction(T(-friction)));
    }
    let_go = 0;
    for (int i = 1; moves.empty() && i <= at.bodies; ++i) {
      if (!resting[i] || system.sticks(i) || ++relocks > 64) continue;
      const T along = T(sliding_sense(system, i)) * dxdt[at.rate(i)];
      if (along > T(-release_tolerance) * system.wing().hinges[i].limit /
                      system.wing().bodies[i].central_inertia)
        continue;
      moves.emplace_back(i, Contact::stuck);
    }
    for (const auto& [i, contact] : moves) system.touch(i, contact);
    changed = !moves.empty();
  }
}

namespace detail {

/// p/s of a polynomial with p(0) = 0, as one of degree five again.
template <class T> [[nodiscard]] Quintic<T> over_s(const Quintic<T>& p) {
  std::array<T, 5> r;
  for (int k = 0; k < 5; ++k) r[k] = T(5) / T(k + 1) * p[k + 1];
  Quintic<T> raised{r[0], T(0), T(0), T(0), T(0), r[4]};
  for (int k = 1; k < 5; ++k) raised[k] = fused(T(k) / T(5), r[k - 1] - r[k], r[k]);
  return raised;
}

/// The cubic with values a, b and slopes da, db at the ends of a step of h, as one of degree five.
template <class T>
[[nodiscard]] Quintic<T> cubic(const T& h, const T& a, const T& da, const T& b, const T& db) {
  const T third = h / T(3), inner = fused(third, da, a), outer = fused(-third, db, b);
  const std::array<T, 5> d{a, (a + T(3) * inner) / T(4), (inner + outer) / T(2),
                           (T(3) * outer + b) / T(4), b};
  Quintic<T> raised{d[0], T(0), T(0), T(0), T(0), d[4]};
  for (int k = 1; k < 5; ++k) raised[k] = fused(T(k) / T(5), d[k - 1] - d[k], d[k]);
  return raised;
}

} // namespace detail

/// p without its root at s = 0: p/s, or p/s² where p/s is zero there but for rounding (a hinge let
/// go at its limit, with τ_s = τ_c, has no acceleration yet).
template <class T> [[nodiscard]] Quintic<T> without_root_at_start(const Quintic<T>& p) {
  using std::abs;
  const Quintic<T> once = detail::over_s(p);
  return abs(once[0]) > T(1e-8) * bound(once) ? once : detail::over_s(once);
}

/// The first s in [0, 1] at which hinge i, which slides, comes to rest in the step; none if it does
/// not. A hinge that has just set out is at rest at s = 0, which does not count.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_rest(const AnySystem& system, const Step<T>& step, int i) {
  const Layout& at = system.layout();
  const T against(-sliding_sense(system, i));
  using std::abs;
  Quintic<T> rate = derivative(step.coordinate(at.angle(i), at.freedoms()), step.h);
  const int r = at.rate(i);
  const T angle = larger(T(abs(step.x[at.angle(i)])), T(abs(step.x1[at.angle(i)])));
  const T moved = step.h * larger(T(abs(step.x[r])), T(abs(step.x1[r])));
  if (T(64 * epsilon_of<T>) * angle > T(1e-6) * moved) // the angle's rounding would drown it
    rate = detail::cubic(step.h, step.x[r], step.dxdt[r], step.x1[r], step.dxdt1[r]);
  for (T& c : rate) c = against * c;
  if (step.x[at.rate(i)] == T(0)) rate = without_root_at_start(rate);
  return first_nonnegative(rate);
}

/// A hinge that sticks and is due to be let go inside the step.
template <class T> struct Release {
  int hinge;
  T s;     ///< fraction of the step
  T slope; ///< of the friction's excess over the limit there, N·m/s
};

/// Watches the friction that holds hinges over a step.
template <class T> class Holding {
public:
  /// The last evaluation was at the start of the next step.
  template <class AnySystem> void observe(const AnySystem& system, const State<T>& x) {
    before_.resize(system.layout().bodies + 1);
    for (int i = 1; i <= system.layout().bodies; ++i)
      before_[i] = system.sticks(i) ? excess(system, x, i) : T(0);
  }

  /// The earliest release in the step; the last evaluation was at its end, and is again afterwards.
  /// Sampled at quarters of the step where the friction comes near its limit, and located on the
  /// dense output. x and dxdt are overwritten.
  template <class AnySystem>
  [[nodiscard]] std::optional<Release<T>> first_release(AnySystem& system, const Step<T>& step,
                                                        State<T>& x, State<T>& dxdt) const {
    if (!comes_near(system, step)) return std::nullopt;
    std::optional<Release<T>> first;
    const auto at = [&](int i, const T& s) {
      step.interpolate(system.layout(), s, x);
      system(x, dxdt, step.t + s * step.h);
      return excess(system, x, i);
    };
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!system.sticks(i)) continue;
      T lower(0);
      for (int k = 1; k <= 4; ++k) {
        const T s = T(k) / T(4);
        if (first && lower >= first->s) break;
        if (at(i, s) > T(0)) {
          const T root = locate(lower, s, [&](const T& z) { return at(i, z); });
          const T width(1e-3);
          const T slope =
              (at(i, T(root + width)) - at(i, T(root - width))) / (T(2) * width * step.h);
          if (!first || root < first->s) first = Release<T>{i, root, slope};
          break;
        }
        lower = s;
      }
    }
    system(step.x1, dxdt, step.t + step.h);
    return first;
  }

  /// Friction that holds hinge i beyond its limit, at the last evaluation, at x, N·m.
  template <class AnySystem>
  [[nodiscard]] static T excess(const AnySystem& system, const State<T>& x, int i) {
    using std::abs;
    return abs(system.holding_friction(x, i)) -
           T(1 + 2 * release_tolerance) * system.wing().hinges[i].limit;
  }

private:
  /// Whether any could pass its limit: at the step's end, or by twice its change over the step.
  template <class AnySystem>
  [[nodiscard]] bool comes_near(const AnySystem& system, const Step<T>& step) const {
    using std::abs;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!system.sticks(i)) continue;
      const T after = excess(system, step.x1, i), change = abs(after - before_[i]);
      if (larger(after, before_[i]) + T(2) * change > T(-0.05) * system.wing().hinges[i].limit)
        return true;
    }
    return false;
  }

  template <class Function> [[nodiscard]] static T locate(T lower, T upper, Function f) {
    const T below = f(lower), above = f(upper);
    if (!(below < T(0))) return lower;
    std::uintmax_t iterations = 60;
    const auto root = boost::math::tools::toms748_solve(
        f, lower, upper, below, above, boost::math::tools::eps_tolerance<T>(40), iterations);
    return root.second;
  }

  std::vector<T> before_;
};

} // namespace wingspread
