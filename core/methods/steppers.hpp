/// The methods by name, and the one place that knows them all.
#pragma once

#include "core/methods/adams_bashforth_moulton.hpp"
#include "core/methods/bulirsch_stoer.hpp"
#include "core/methods/dop853.hpp"
#include "core/methods/runge_kutta.hpp"
#include "core/methods/seulex.hpp"

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

[[nodiscard]] constexpr bool is_implicit(Method method) {
  return method == Method::rosenbrock_w || method == Method::seulex;
}

/// Steps of these grow so long that the quintic through a step's ends may miss what happens inside.
[[nodiscard]] constexpr bool takes_long_steps(Method method) {
  return method == Method::fehlberg78 || method == Method::dop853 ||
         method == Method::bulirsch_stoer || method == Method::adams_bashforth_moulton ||
         method == Method::seulex;
}

} // namespace wingspread
