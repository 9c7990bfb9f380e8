// Every method by itself: its order down to round-off, its estimate, what it makes of NaN, and what
// it makes of a tolerance. Their stability is in stability_test.cpp.
#include "core/deployment.hpp"
#include "tests/support/reference_run.hpp"
#include "tests/support/stepping.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

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

/// visit(stepper, what it is) with all but the multistep method.
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

/// What a step of h, h/2, … is off, and what the method thinks that it is.
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
    const Verdict verdict = at.attempt(stepper, wing.system, T(h));
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
    if (method.name == "runge_kutta4") // by Richardson the error of what it goes on with
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

TEST_CASE("the order of the multistep method climbs to eight, its corrector's to nine") {
  constexpr double span = 0.125;
  RingingWing<Quad> quad;
  Adaptive<Quad, Fehlberg78<Quad>> fehlberg; // off by 1e-18
  const auto exact = after_steps<Quad>(fehlberg, quad, Quad(span) / 256, 256);
  check_multistep<long double>(exact, span, 64, 1e-16); // its coefficients are doubles
  check_multistep<double>(exact, span, 64, 1e-14);
}

namespace {

/// A wing whose accelerations turn into something else at one evaluation.
template <class AnySystem> struct Faulty : AnySystem {
  double what;
  int left; ///< evaluations until then

  explicit Faulty(const AnySystem& system, double number = 0,
                  int evaluations = std::numeric_limits<int>::max())
      : AnySystem(system), what(number), left(evaluations) {}

  template <class T> void operator()(const State<T>& x, State<T>& dxdt, const T& t) {
    AnySystem::operator()(x, dxdt, t);
    if (left-- == 0) dxdt.back() = T(what);
  }
  template <class T> void stage(const State<T>& x, State<T>& dxdt, const T& t) {
    (*this)(x, dxdt, t);
  }
};

/// A method in the middle of its run.
template <class Stepper> struct UnderWay {
  RingingWing<double> wing;
  Stepping<double> at{wing.system, wing.start};
  Stepper stepper;
  double h = 1e-4;

  explicit UnderWay(const Stepper& fresh) : stepper(fresh) {
    stepper.restart(tolerance);
    int accepted = 0;
    for (int tries = 0; tries < 40 && accepted < 12; ++tries) accepted += go_on(stepper, h);
    REQUIRE(accepted == 12);
  }

  /// One try. @return whether it was accepted
  bool go_on(Stepper& with, double& step) {
    const Verdict verdict = at.attempt(with, wing.system, step);
    if (verdict.accepted())
      at.accept(with, verdict, step);
    else
      with.rejected();
    step *= verdict.factor;
    return verdict.accepted();
  }

  static constexpr Tolerance tolerance{1e-6, 1e-8};
};

} // namespace

TEST_CASE("a number that is none, at any evaluation of a step, rejects that step and no other") {
  Steppers<double> methods_there_are;
  for (std::size_t m = 0; m < method_names.size(); ++m)
    methods_there_are.with(static_cast<Method>(m), [&](auto& fresh) {
      using Stepper = std::decay_t<decltype(fresh)>;
      UnderWay<Stepper> run(fresh);
      const auto start = run.at;
      Faulty counting{run.wing.system};
      auto sound = run.stepper;
      REQUIRE(run.at.attempt(sound, counting, run.h).accepted());
      const int evaluations = std::numeric_limits<int>::max() - counting.left;
      REQUIRE(evaluations >= (method_names[m] == "adams_bashforth_moulton" ? 2 : 4));

      for (const double what :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (int k = 0; k < evaluations; ++k) {
          CAPTURE(method_names[m], what, k, evaluations);
          run.at = start;
          auto poisoned = run.stepper;
          Faulty faulty{run.wing.system, what, k};
          const Verdict verdict = run.at.attempt(poisoned, faulty, run.h);
          REQUIRE(faulty.left < 0);
          REQUIRE_FALSE(verdict.accepted());
          poisoned.rejected();
          if (Stepper::fixed_step) continue;
          REQUIRE(verdict.factor > 0);
          REQUIRE(verdict.factor < 1);
          // as if nothing had been
          double h = run.h * verdict.factor;
          const double end = run.at.t + h;
          REQUIRE(run.go_on(poisoned, h));
          RingingWing<long double> exact;
          exact.start.assign(start.x.begin(), start.x.end());
          Adaptive<long double, Fehlberg78<long double>> fehlberg;
          const auto there = after_steps<long double>(fehlberg, exact, (end - start.t) / 4.L, 4);
          const State<long double> got(run.at.x.begin(), run.at.x.end());
          REQUIRE(apart(got, there) < 1e-6L);
        }
    });
}

namespace {

/// The seed wing to just after its last latch, in extended precision.
const ReferenceOutcome& seed_reference() {
  static const ReferenceOutcome outcome = [] {
    ReferenceOptions options;
    options.t_end = 7, options.rtol = 1e-15, options.atol = 1e-16;
    return high_precision_run<long double>(seed_scene(), options);
  }();
  return outcome;
}

/// What the seed wing's latches and its state at 7 s are off.
double deployment_error(const Integration& how) {
  Goal goal{.peak_moment = false, .peak_force = false, .audit = false, .to_t_end = true};
  const Outcome out = Deployment().run(seed_scene(), how, goal);
  CAPTURE(out.reason);
  REQUIRE(out.latches.size() == 3);
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    worst = std::max({worst, std::abs(out.latches[i].time - seed_reference().latches[i].time),
                      std::abs(out.final.angles[i] - seed_reference().final.angles(i)),
                      std::abs(out.final.rates[i] - seed_reference().final.rates(i))});
  return worst;
}

} // namespace

TEST_CASE("the error of a whole deployment follows the tolerance") {
  for (const MethodInfo& method : methods()) {
    if (method.name == "runge_kutta4") continue;
    // a method of order 3 takes 1e5 steps for 1e-11; extrapolation of a linear solve rounds
    const int last = method.name == "rosenbrock_w" ? 9 : 12;
    const double round_off = method.name == "seulex" ? 5e-9 : 5e-13;
    for (int digits = 3; digits <= last; ++digits) {
      Integration how;
      how.method = method.name, how.t_end = 7;
      how.rtol = std::pow(10., -digits), how.atol = 0.1 * how.rtol;
      CAPTURE(method.name, digits);
      CHECK(deployment_error(how) < 3 * how.rtol + round_off);
    }
  }
}

TEST_CASE("the error of a whole deployment falls with the fourth power of a fixed step") {
  double before = 0;
  for (const double step : {4e-3, 2e-3, 1e-3, 5e-4}) {
    Integration how;
    how.method = "runge_kutta4", how.step = step, how.t_end = 7, how.rtol = how.atol = 1;
    const double error = deployment_error(how);
    CAPTURE(step, std::log10(error));
    if (before > 0) CHECK(std::log2(before / error) == Approx(4).margin(0.6));
    before = error;
  }
}
