/// What exact friction holds: the instant at which it no longer can.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/system.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace wingspread {

/// Friction within this much of the limit counts as past it when another hinge is just released:
/// mirrored wings let go together.
inline constexpr double release_tolerance = 1e-9;

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
  template <class AnySystem> void begin_step(const AnySystem& system, const State<T>& x) {
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
           T(1 + 2 * release_tolerance) * system.wing().hinges[i].static_friction;
  }

private:
  /// Whether any could pass its limit: at the step's end, or by twice its change over the step.
  template <class AnySystem>
  [[nodiscard]] bool comes_near(const AnySystem& system, const Step<T>& step) const {
    using std::abs;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!system.sticks(i)) continue;
      const T after = excess(system, step.x1, i), change = abs(after - before_[i]);
      if (larger(after, before_[i]) + T(2) * change >
          T(-0.05) * system.wing().hinges[i].static_friction)
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
