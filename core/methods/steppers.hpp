/// The table of all methods, and the properties of each that the run loop and the engines use.
#pragma once

#include "core/dense/roughness.hpp"
#include "core/methods/adams_bashforth_moulton.hpp"
#include "core/methods/bulirsch_stoer.hpp"
#include "core/methods/dop853.hpp"
#include "core/methods/runge_kutta.hpp"
#include "core/methods/seulex.hpp"
#include "core/methods/taylor.hpp"

#include <array>
#include <string>
#include <string_view>

namespace wingspread {

enum class Method {
  runge_kutta4,
  cash_karp54,
  dopri5,
  fehlberg78,
  dop853,
  bulirsch_stoer,
  adams_bashforth_moulton,
  rosenbrock_w,
  seulex,
  taylor
};
inline constexpr std::array<std::string_view, 10> method_names{"runge_kutta4",
                                                               "cash_karp54",
                                                               "dopri5",
                                                               "fehlberg78",
                                                               "dop853",
                                                               "bulirsch_stoer",
                                                               "adams_bashforth_moulton",
                                                               "rosenbrock_w",
                                                               "seulex",
                                                               "taylor"};

[[nodiscard]] inline std::string name_of(Method method) {
  return std::string(method_names[static_cast<std::size_t>(method)]);
}

/// One object of each method. Only those that make steps allocate.
template <class T> class Steppers {
public:
  /// Calls visit(stepper) with the method's object and returns its result.
  template <class Visit> decltype(auto) with(Method method, Visit&& visit) {
    switch (method) {
    case Method::runge_kutta4:
      return visit(runge_kutta4_);
    case Method::cash_karp54:
      return visit(cash_karp54_);
    case Method::fehlberg78:
      return visit(fehlberg78_);
    case Method::dop853:
      return visit(dop853_);
    case Method::bulirsch_stoer:
      return visit(bulirsch_stoer_);
    case Method::adams_bashforth_moulton:
      return visit(adams_bashforth_moulton_);
    case Method::rosenbrock_w:
      return visit(rosenbrock_w_);
    case Method::seulex:
      return visit(seulex_);
    case Method::taylor:
      return visit(taylor_);
    case Method::dopri5:
      break;
    }
    return visit(dopri5_);
  }

  /// Calls make(), which makes trial steps by the method. The method's control of order and step stays as it was.
  template <class Make> auto keeping_control(Method method, Make&& make) {
    return with(method, [&](auto& stepper) {
      if constexpr (requires { stepper.control(); }) {
        const auto kept = stepper.control();
        const auto made = make();
        stepper.control() = kept;
        return made;
      } else {
        return make();
      }
    });
  }

  [[nodiscard]] Adaptive<T, TaylorSeries<T>>& taylor() { return taylor_; }

private:
  RungeKutta4<T> runge_kutta4_;
  Adaptive<T, CashKarp54<T>> cash_karp54_;
  Adaptive<T, DormandPrince5<T>> dopri5_;
  Adaptive<T, Fehlberg78<T>> fehlberg78_;
  Adaptive<T, DormandPrince853<T>> dop853_;
  BulirschStoer<T> bulirsch_stoer_;
  AdamsBashforthMoulton<T> adams_bashforth_moulton_;
  Adaptive<T, RosenbrockW<T>> rosenbrock_w_;
  Seulex<T> seulex_;
  Adaptive<T, TaylorSeries<T>> taylor_;
};

[[nodiscard]] constexpr bool is_implicit(Method method) {
  return method == Method::rosenbrock_w || method == Method::seulex;
}

/// Whether engines of packs have the method.
[[nodiscard]] constexpr bool has_lanes(Method method) {
  return method == Method::dopri5 || method == Method::dop853 || method == Method::taylor;
}

/// Whether steps may become so long that the quintic through their ends misses what happens inside; they
/// must obey `roughness`.
[[nodiscard]] constexpr bool takes_long_steps(Method method) {
  return method == Method::fehlberg78 || method == Method::dop853 ||
         method == Method::bulirsch_stoer || method == Method::adams_bashforth_moulton ||
         method == Method::seulex || method == Method::taylor;
}

/// Whether the error estimate expects a smooth right-hand side, and may accept a wrong step over a kink of a law
/// (core/events/kinks.hpp). Explicit formulas whose stages fill the step notice kinks.
[[nodiscard]] constexpr bool needs_smooth_laws(Method method) {
  return is_implicit(method) || method == Method::fehlberg78 || method == Method::bulirsch_stoer;
}

/// Rejects a step that is too rough (> 1), and limits the factor to the next.
inline void limit_roughness(double rough, StepVerdict& verdict) {
  const double factor = factor_by_roughness(rough);
  verdict = rough > 1 ? StepVerdict{2, factor}
                      : StepVerdict{verdict.error, std::min(verdict.factor, factor)};
}

/// Error of a smoothed latch's state over a step of Fehlberg78, in units of the tolerance. That state is a
/// pure quadrature, to which Fehlberg78's own estimate is blind: Boole's rule on the dense output judges it.
template <class T, class AnySystem>
[[nodiscard]] double quadrature_error(const AnySystem& system, const Step<T>& step,
                                      const Tolerance& tolerance) {
  using std::abs;
  const Layout& at = system.layout();
  double worst = 0;
  for (int i = 1; i <= at.bodies; ++i) {
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    if (!hinge.has_latch) continue;
    const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
    const auto f = [&](double s) {
      return engagement_rate(hinge, value(angle, T(s)), system.epsilon());
    };
    const T boole =
        step.h / T(90) * (T(7) * (f(0) + f(1)) + T(32) * (f(0.25) + f(0.75)) + T(12) * f(0.5));
    const T S = step.x1[at.latch(i)], gained = S - step.x[at.latch(i)];
    worst = std::max(worst, static_cast<double>(T(abs(gained - boole))) /
                                (tolerance.atol + tolerance.rtol * static_cast<double>(S)));
  }
  return worst;
}

} // namespace wingspread
