// Measures the stability limits that `methods()` states, on real wings.
#include "core/deployment.hpp"
#include "tests/support/stepping.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <complex>
#include <map>
#include <numbers>
#include <string>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

using Real = long double;
using Complex = std::complex<Real>;

/// An engaged latch on a panel of 1 kg·m²: q̈ = −q − 2ζ q̇, eigenvalues λ = −ζ ± i √(1 − ζ²).
struct Oscillator : TestWing<Real> {
  explicit Oscillator(double zeta) : TestWing<Real>(scene(zeta)) {
    engage_all();
    start_from({1, 0});
  }

private:
  static Scene scene(double zeta) {
    Scene scene = latching_panel();
    scene.bodies[0].inertia = 1;
    scene.hinges[0].child_point = {0, 0};
    scene.hinges[0].spring = {0, 0};
    scene.hinges[0].latch = Latch{1, 2 * zeta};
    return scene;
  }
};

/// Where hλ stands: `degrees` from the negative real axis; 90: on the imaginary one.
Complex eigenvalue(double zeta) { return {-Real(zeta), std::sqrt(1 - Real(zeta) * Real(zeta))}; }
double damping(double degrees) { return degrees < 90 ? std::cos(degrees / 180 * pi) : 0; }

/// R(hλ), by which a step multiplies the eigenvector. One step is a polynomial of the matrix, p + q A
/// with A = [0 1; −1 −2ζ], that takes (1, 0) to (p, −q); so R = p + q λ.
template <class Stepper>
Complex amplification(Stepper& method, double h, double degrees,
                      const Tolerance& tolerance = any_error) {
  Oscillator wing(damping(degrees));
  const State<Real> x = after_steps<Real>(method, wing, Real(h), 1, tolerance);
  return x[0] - x[1] * eigenvalue(damping(degrees));
}

constexpr double longest = 1e4; // |hλ|

/// The longest step up to which all are stable, found in steps of 2 % and then by bisection; 0 if
/// the shortest grow, infinite if none does. |R| has to exceed 1 by more than its round-off.
template <class Stepper>
double stability_limit(Stepper& method, double degrees, const Tolerance& tolerance = any_error) {
  const auto grows = [&](double h) {
    return std::abs(amplification(method, h, degrees, tolerance)) > 1 + 1e-17L;
  };
  double stable = 0, unstable = 0.02;
  for (; !grows(unstable); unstable *= 1.02) {
    if (unstable > longest) return std::numeric_limits<double>::infinity();
    stable = unstable;
  }
  while (stable > 0 && unstable - stable > 1e-4 * stable) {
    const double middle = (stable + unstable) / 2;
    (grows(middle) ? unstable : stable) = middle;
  }
  return stable;
}

const MethodInfo& info(const std::string& name) {
  const auto found = std::find_if(methods().begin(), methods().end(),
                                  [&](const MethodInfo& method) { return method.name == name; });
  REQUIRE(found != methods().end());
  return *found;
}

/// @param steps that the method makes of one
template <class Stepper> void check_limits(const std::string& name, Stepper method, int steps = 1) {
  CAPTURE(name);
  CHECK(stability_limit(method, 0) / steps == Approx(info(name).real_limit).epsilon(1e-3));
  CHECK(stability_limit(method, 90) / steps == Approx(info(name).imaginary_limit).epsilon(1e-3));
}

/// Whether the latched wing, ringing so little that it is linear, comes to rest in equal steps of
/// h: where its springs hold it, 0.14 mrad beyond its latched angles.
template <class Stepper> bool stays_bounded(Stepper method, double h) {
  RingingWing<double> wing;
  for (double& v : wing.start) v *= 0.1;
  const State<double> x = after_steps<double>(method, wing, h, 1000);
  return std::all_of(x.begin(), x.end(), [](double v) { return std::abs(v) < 1e-3; });
}

} // namespace

TEST_CASE("one-step methods have the stability limits that they state") {
  check_limits("runge_kutta4", RungeKutta4<Real>(), 2);
  check_limits("cash_karp54", Adaptive<Real, CashKarp54<Real>>());
  check_limits("dopri5", Adaptive<Real, DormandPrince5<Real>>());
  check_limits("fehlberg78", Adaptive<Real, Fehlberg78<Real>>());
  check_limits("dop853", Adaptive<Real, DormandPrince853<Real>>());
  check_limits("taylor", Adaptive<Real, TaylorSeries<Real>>());
  check_limits("rosenbrock_w", Adaptive<Real, RosenbrockW<Real>>());
}

TEST_CASE("Cash and Karp's formula makes undamped motion grow at any step") {
  Adaptive<Real, CashKarp54<Real>> method;
  for (const double h : {0.01, 0.03, 0.1, 0.3})
    CHECK(double(std::abs(amplification(method, h, 90)) - 1) ==
          Approx(1.4e-4 * std::pow(h, 6)).epsilon(0.07));
}

TEST_CASE("the limits of extrapolation depend on its order") {
  BulirschStoer<Real> method;
  CHECK(stability_limit(method, 0, bulirsch_stoer_of_order_4) == Approx(4.457).epsilon(1e-3));
  CHECK(stability_limit(method, 90, bulirsch_stoer_of_order_4) == Approx(3.364).epsilon(1e-3));
  CHECK(stability_limit(method, 0, bulirsch_stoer_of_order_10) == Approx(5.995).epsilon(1e-3));
}

TEST_CASE("the multistep method's order gives way before its stability does") {
  // its order chosen by itself; after 2000 steps
  const auto after = [](double h, double degrees) {
    Oscillator wing(damping(degrees));
    AdamsBashforthMoulton<Real> method;
    Stepping<Real> at(wing.system, wing.start);
    method.restart(any_error);
    for (int k = 0; k < 2000; ++k)
      at.accept(method, at.attempt(method, wing.system, Real(h)), Real(h));
    return std::max(std::abs(at.x[0]), std::abs(at.x[1]));
  };
  CHECK(after(1.4, 0) < 1);
  CHECK_FALSE(after(1.5, 0) < 1);
  CHECK(after(0.5, 90) < 1);
  CHECK_FALSE(after(0.6, 90) < 1);
}

TEST_CASE("Rosenbrock's method is L-stable") {
  Adaptive<Real, RosenbrockW<Real>> method;
  for (const double degrees : {0., 30., 60., 89., 90.}) {
    CAPTURE(degrees);
    CHECK(stability_limit(method, degrees) == std::numeric_limits<double>::infinity());
    CHECK(std::abs(amplification(method, 1e6, degrees)) < 1e-5);
  }
}

TEST_CASE("linearly implicit extrapolation is L-stable but for 0.2 degrees of the imaginary axis",
          "[long]") {
  Seulex<Real> method;
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(info("seulex").real_limit == infinity);
  for (int order = 3; order <= 10; ++order) {
    const Tolerance tolerance = seulex_of_order(order);
    CAPTURE(order);
    for (const double degrees : {0., 45., 89.8})
      CHECK(stability_limit(method, degrees, tolerance) == infinity);
    CHECK(std::abs(amplification(method, 1e6, 0, tolerance)) < 1e-10);
    CHECK(std::abs(amplification(method, 1e6, 90, tolerance)) < 1e-10);
    // on the axis itself something grows, if by no more than 2 % a step
    CHECK(stability_limit(method, 90, tolerance) < 6);
    for (double h = 0.1; h < 100; h *= 1.1)
      CHECK(std::abs(amplification(method, h, 90, tolerance)) < 1.02);
  }
  CHECK(info("seulex").imaginary_limit == 0);
}

TEST_CASE("the latched wing rings out at 14.0 ms with rk4 and not at 14.8, dopri5 at 16.5 / 17.5") {
  CHECK(stays_bounded(RungeKutta4<double>(), 2 * 14.0e-3)); // it takes two steps as one
  CHECK_FALSE(stays_bounded(RungeKutta4<double>(), 2 * 14.8e-3));
  CHECK(stays_bounded(Adaptive<double, DormandPrince5<double>>(), 16.5e-3));
  CHECK_FALSE(stays_bounded(Adaptive<double, DormandPrince5<double>>(), 17.5e-3));
  CHECK(stays_bounded(Adaptive<double, CashKarp54<double>>(), 19e-3));
  CHECK_FALSE(stays_bounded(Adaptive<double, CashKarp54<double>>(), 20e-3));
  CHECK(stays_bounded(Adaptive<double, DormandPrince853<double>>(), 32e-3));
  CHECK_FALSE(stays_bounded(Adaptive<double, DormandPrince853<double>>(), 34e-3));
  CHECK(stays_bounded(Adaptive<double, RosenbrockW<double>>(), 1));
  CHECK(stays_bounded(Seulex<double>(), 1));
}

// As their authors state them: Runge-Kutta 1901; Cash & Karp 1990; Dormand & Prince 1980; Fehlberg 1968; Prince & Dormand 1981
// with Hairer's estimate; Rang & Angermann 2005. Methods that choose their order have none to state.
TEST_CASE("the stated orders are those of the formulas") {
  const std::map<std::string, int> orders{
      {"runge_kutta4", 4}, {"cash_karp54", 5},  {"dopri5", 5}, {"fehlberg78", 8},
      {"dop853", 8},       {"rosenbrock_w", 3}, {"taylor", 16}};
  for (const MethodInfo& method : methods()) {
    CAPTURE(method.name);
    const auto stated = orders.find(method.name);
    CHECK(method.order == (stated == orders.end() ? 0 : stated->second));
  }
  for (const auto& [name, order] : orders) CHECK(info(name).order == order);
}
