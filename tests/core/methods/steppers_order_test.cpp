// Every method by itself: its order down to round-off, and its estimate.
#include "core/methods/steppers.hpp"
#include "tests/support/stepping.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A method of one step; one that chooses its order, at a fixed one.
struct OneStep {
  std::string name;
  int order;
  int estimate;         ///< order of the formula that the estimate compares with; 0: no number
  Tolerance tolerance;  ///< that all steps meet
  double round_off = 4; ///< of a step, in epsilons
  bool decimal = false; ///< its coefficients are known to the digits of a double
};

/// Calls visit(stepper, its description) for all one-step methods but taylor: its order is too high for the reference.
template <class T, class Visit> void with_one_step_methods(const Visit& visit) {
  visit(RungeKutta4<T>(), OneStep{"runge_kutta4", 4, 4, any_error});
  visit(Adaptive<T, CashKarp54<T>>(), OneStep{"cash_karp54", 5, 4, any_error});
  visit(Adaptive<T, DormandPrince5<T>>(), OneStep{"dopri5", 5, 4, any_error});
  visit(Adaptive<T, Fehlberg78<T>>(), OneStep{"fehlberg78", 8, 7, any_error});
  visit(Adaptive<T, DormandPrince853<T>>(), OneStep{"dop853", 8, 7, any_error, 4, true});
  visit(Adaptive<T, RosenbrockW<T>>(), OneStep{"rosenbrock_w", 3, 2, any_error, 4, true});
  visit(BulirschStoer<T>(), OneStep{"bulirsch_stoer", 4, 0, bulirsch_stoer_of_order_4});
  visit(BulirschStoer<T>(), OneStep{"bulirsch_stoer", 10, 0, bulirsch_stoer_of_order_10, 32});
  for (int order = 3; order <= 10; ++order) // the weights of the extrapolation grow as some 3^order
    visit(Seulex<T>(),
          OneStep{"seulex", order, order - 1, seulex_of_order(order), 5 * std::pow(3, order)});
}

constexpr int halvings = 7;

/// The wing's states after h, h/2, … by Fehlberg's formula in quad, sixteen times as fine: of its
/// own error 16⁻⁸ is left.
template <class AWing> std::vector<State<Quad>> exact_steps(double h) {
  AWing wing;
  std::vector<State<Quad>> exact;
  for (int k = 0; k < halvings; ++k, h /= 2) {
    Adaptive<Quad, Fehlberg78<Quad>> fehlberg;
    exact.push_back(after_steps<Quad>(fehlberg, wing, Quad(h) / 16, 16));
  }
  return exact;
}

/// Errors of steps h, h/2, …, and the method's estimates of them.
struct Series {
  std::vector<double> errors, estimates;
};

template <class T, class Stepper>
Series steps(Stepper& stepper, TestWing<T>& wing, const std::vector<State<Quad>>& exact, double h,
             const Tolerance& tolerance) {
  Series series;
  for (int k = 0; k < halvings; ++k, h /= 2) {
    Stepping<T> at(wing.system, wing.start);
    stepper.restart(tolerance);
    const StepVerdict verdict = at.attempt(stepper, wing.system, T(h));
    const State<Quad> got(at.x1.begin(), at.x1.end());
    series.errors.push_back(static_cast<double>(apart(got, exact[k])));
    series.estimates.push_back(verdict.error * tolerance.atol);
  }
  return series;
}

/// Each halving divides the error by 2^(order + 1), at first by a little less, until it is below
/// `floor`, where it stays.
/// @return how often it did
int check_order(const std::vector<double>& errors, int order, double floor) {
  int above = 0;
  double slope = 0;
  for (int k = 1; k < halvings; ++k) {
    CAPTURE(k, order, std::log10(errors[k - 1]), std::log10(errors[k]), std::log10(floor));
    REQUIRE(std::isfinite(errors[k]));
    if (errors[k] < floor) continue;
    slope = std::log2(errors[k - 1] / errors[k]);
    CHECK(slope > order + 0.4);
    ++above;
  }
  CAPTURE(order);
  if (above > 0) CHECK(slope == Approx(order + 1).margin(0.5));
  return above;
}

template <class AWing, class QuadWing> void check_orders(double h) {
  using T = typename decltype(AWing::start)::value_type;
  constexpr bool quad = std::is_same_v<T, Quad>;
  const double epsilon = std::ldexp(1., 1 - std::numeric_limits<T>::digits);
  const auto exact = exact_steps<QuadWing>(h);
  AWing wing;
  const double rate = static_cast<double>(
      apart(Stepping<T>(wing.system, wing.start).dxdt, State<T>(wing.start.size(), T(0))));
  with_one_step_methods<T>([&](auto stepper, const OneStep& method) {
    CAPTURE(method.name);
    const Series of = steps<T>(stepper, wing, exact, h, method.tolerance);
    const double round_off = method.round_off * epsilon;
    const double floor = method.decimal ? std::max(round_off, h * rate * 0x1p-52) : round_off;
    const int above = check_order(of.errors, method.order, floor);
    CHECK(above >= (quad ? method.decimal ? 1 : 2 : 0));
    if (!quad || method.estimate == 0) return;
    check_order(of.estimates, method.estimate, 1e-24);
    if (method.name == "runge_kutta4") // Richardson estimates the error of the two half steps
      CHECK(of.estimates.back() == Approx(of.errors.back()).epsilon(0.05));
    else
      CHECK(of.estimates.front() > of.errors.front()); // of the formula that it does not go on with
  });
}

/// What adams_bashforth_moulton is off after `span` in `count` equal steps. It starts with order
/// 1, so its first step is 2⁻³² of them; until it has gone one of them, it doubles them.
template <class T>
double multistep_error(TestWing<T>& wing, const State<Quad>& exact, double span, int count) {
  AdamsBashforthMoulton<T> method;
  method.restart(any_error);
  Stepping<T> at(wing.system, wing.start);
  const T h = T(span) / T(count);
  const auto step = [&](const T& part) {
    at.accept(method, at.attempt(method, wing.system, part), part);
  };
  step(h * T(0x1p-32));
  while (at.t < h) step(at.t);
  for (int k = 1; k < count; ++k) step(h);
  return static_cast<double>(apart(State<Quad>(at.x.begin(), at.x.end()), exact));
}

/// @param count of steps from which on the error falls as it should
template <class T>
void check_multistep(const State<Quad>& exact, double span, int count, double round_off) {
  RingingWing<T> wing;
  double before = multistep_error(wing, exact, span, count);
  for (int k = 0; k < 5; ++k) {
    const double error = multistep_error(wing, exact, span, count *= 2);
    CAPTURE(count, std::log10(before), std::log10(error), std::log10(round_off));
    if (error > round_off) CHECK(std::log2(before / error) == Approx(8.6).margin(0.9));
    before = error;
  }
  CHECK(before < round_off);
}

} // namespace

TEST_CASE("the error of a step, and its estimate, fall with the order that the method claims") {
  check_orders<RingingWing<Quad>, RingingWing<Quad>>(1. / 1024);
  check_orders<SwingingWing<Quad>, SwingingWing<Quad>>(1. / 8);
}

TEST_CASE("in double the error of a step falls so down to round-off, and stays there") {
  check_orders<RingingWing<double>, RingingWing<Quad>>(1. / 1024);
  check_orders<SwingingWing<double>, SwingingWing<Quad>>(1. / 8);
}

TEST_CASE("a step so short that nothing curves moves the state by its rates, to rounding") {
  SwingingWing<double> wing;
  with_one_step_methods<double>([&](auto stepper, const OneStep& method) {
    const double rounding = method.name == "bulirsch_stoer" ? method.round_off : 4;
    for (const double h : {1e-15, 1e-14, 1e-13, 1e-12}) {
      Stepping<double> at(wing.system, wing.start);
      stepper.restart(method.tolerance);
      REQUIRE(std::isfinite(at.attempt(stepper, wing.system, h).error));
      for (std::size_t c = 0; c < at.x.size(); ++c) {
        CAPTURE(method.name, method.order, h, c, at.x[c], at.x1[c], at.dxdt[c]);
        CHECK(std::abs(at.x1[c] - (at.x[c] + h * at.dxdt[c])) <=
              rounding * 0x1p-52 * std::abs(at.x[c]) + 1e-21);
      }
    }
  });
}

TEST_CASE("the order of the multistep method climbs to eight, its corrector's to nine") {
  constexpr double span = 0.125;
  RingingWing<Quad> quad;
  Adaptive<Quad, Fehlberg78<Quad>> fehlberg; // off by 1e-18
  const auto exact = after_steps<Quad>(fehlberg, quad, Quad(span) / 256, 256);
  check_multistep<long double>(exact, span, 64, 1e-16); // its coefficients are doubles
  check_multistep<double>(exact, span, 64, 1e-14);
}
