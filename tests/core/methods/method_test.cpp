// How every method treats an acceleration that is not finite, and a step that it has refused.
#include "core/methods/steppers.hpp"
#include "tests/support/stepping.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <type_traits>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A wing with one wrong acceleration at one evaluation.
template <class AnySystem> struct Faulty : AnySystem {
  double what;
  int left; ///< evaluations before that one

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
  template <class T> void end_step(State<T>& x, State<T>& dxdt, const T& t) { (*this)(x, dxdt, t); }
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

  /// Makes one trial step. @return whether it was accepted
  bool go_on(Stepper& with, double& step) {
    const StepVerdict verdict = at.attempt(with, wing.system, step);
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
      const bool by_series = method_names[m] == "taylor"; // evaluates at the step's end alone
      REQUIRE(evaluations >= (by_series                                      ? 1
                              : method_names[m] == "adams_bashforth_moulton" ? 2
                                                                             : 4));

      for (const double what :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (int k = 0; k < evaluations; ++k) {
          CAPTURE(method_names[m], what, k, evaluations);
          run.at = start;
          auto poisoned = run.stepper;
          Faulty faulty{run.wing.system, what, k};
          const StepVerdict verdict = run.at.attempt(poisoned, faulty, run.h);
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

TEST_CASE("the step after a refused one does not grow, and the one after that may") {
  Steppers<double> methods_there_are;
  for (std::size_t m = 0; m < method_names.size(); ++m)
    methods_there_are.with(static_cast<Method>(m), [&](auto& fresh) {
      using Stepper = std::decay_t<decltype(fresh)>;
      // series fit their steps; odeint's extrapolation begins anew with a step of another size than it asked for
      const bool by_other_rules =
          method_names[m] == "taylor" || method_names[m] == "bulirsch_stoer";
      if (Stepper::fixed_step || by_other_rules) return;
      UnderWay<Stepper> run(fresh);
      const auto attempt = [&](double h) {
        return run.at.attempt(run.stepper, run.wing.system, h);
      };
      CAPTURE(method_names[m], run.h);
      double h = run.h;
      int doublings = 0;
      for (; attempt(h).accepted(); h *= 2) REQUIRE(++doublings < 12);
      run.stepper.rejected();
      h = 0.05 * run.h; // far below what the tolerance allows
      StepVerdict verdict = attempt(h);
      REQUIRE(verdict.accepted());
      CHECK(verdict.factor <= 1);
      run.at.accept(run.stepper, verdict, h);
      verdict = attempt(h);
      REQUIRE(verdict.accepted());
      CHECK(verdict.factor > 1);
    });
}
