/// The methods by name, and the one place that knows them all.
#pragma once

#include "core/methods/dop853.hpp"
#include "core/methods/seulex.hpp"
#include "core/peaks/peaks.hpp"

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
  seulex
};
inline constexpr std::array<std::string_view, 9> method_names{"runge_kutta4",
                                                              "cash_karp54",
                                                              "dopri5",
                                                              "fehlberg78",
                                                              "dop853",
                                                              "bulirsch_stoer",
                                                              "adams_bashforth_moulton",
                                                              "rosenbrock_w",
                                                              "seulex"};

[[nodiscard]] inline std::string name_of(Method method) {
  return std::string(method_names[static_cast<std::size_t>(method)]);
}

/// One of each method; only those used ever allocate.
template <class T> class Steppers {
public:
  /// visit(stepper) with the one that `method` names.
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
    case Method::dopri5:
      break;
    }
    return visit(dopri5_);
  }

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
};

/// Steps of these grow so long that the quintic through a step's ends may miss what happens inside.
[[nodiscard]] constexpr bool takes_long_steps(Method method) {
  return method == Method::fehlberg78 || method == Method::dop853 ||
         method == Method::bulirsch_stoer || method == Method::adams_bashforth_moulton ||
         method == Method::seulex;
}

/// The error of the quintic over a step against its tolerance, in hundredths of what the
/// coordinates move: near 1 a step spans a quarter of a period. Estimated by the difference to the
/// cubic at the middle, h/32 (φ̇0 − φ̇1) + h²/64 (φ̈0 + φ̈1). @return > 1 if the step is too long; the
/// difference grows with h³
template <class T>
[[nodiscard]] T roughness(const Layout& at, const T& h, const State<T>& dxdt, const State<T>& dxdt1,
                          const T& atol) {
  using std::abs;
  T worst(0);
  for (int k = 0; k < at.freedoms(); ++k) {
    const int a = at.freedoms() + k;
    const T gap = fused(T(h / T(32)), dxdt[k] - dxdt1[k], h * h / T(64) * (dxdt[a] + dxdt1[a]));
    const T move = fused(h, larger(T(abs(dxdt[k])), T(abs(dxdt1[k]))), T(T(1e3) * atol));
    worst = larger(worst, T(abs(gap)) / (T(0.01) * move));
  }
  return worst;
}

/// The largest factor to the next step, or try, that a step's roughness leaves.
template <class P> [[nodiscard]] P factor_by_roughness(const P& rough) {
  const P root = exp2_roughly(P(P(-1.0 / 3) * log2_roughly(larger(rough, P(0.1)))));
  return select(rough > P(1), larger(P(P(0.8) * root), P(0.2)),
                select(rough > P(0.1), P(P(0.9) * root), P(1e10)));
}

/// Makes a verdict obey the roughness of its step.
inline void limit_roughness(double rough, Verdict& verdict) {
  const double factor = factor_by_roughness(rough);
  verdict =
      rough > 1 ? Verdict{2, factor} : Verdict{verdict.error, std::min(verdict.factor, factor)};
}

/// The error of Fehlberg's quadrature of a smoothed latch's state (Fehlberg78 is blind to it), in
/// units of the tolerance: against Boole's rule on the dense output.
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
