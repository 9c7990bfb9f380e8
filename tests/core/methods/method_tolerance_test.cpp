// What the tolerances of a method mean: errors are shares of the state, in whatever unit the state is.
#include "core/methods/steppers.hpp"
#include "tests/support/stepping.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <type_traits>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr double rung_out = 0.25; // s: nine periods of the fastest mode

/// The seed wing on its latches, without drives. So small that its motion is linear to the last bit.
template <class T> struct LinearWing : TestWing<T> {
  explicit LinearWing(double size) : TestWing<T>(without_drives()) {
    this->engage_all();
    std::vector<double> x{0.01, -0.02, 0.015, -0.5, 0.4, -0.6};
    for (double& component : x) component *= size;
    this->start_from(x);
  }
  [[nodiscard]] static Scene without_drives() {
    Scene scene = seed_scene();
    for (Hinge& hinge : scene.hinges) hinge.spring = {}, hinge.harness = {}, hinge.friction = {};
    return scene;
  }
};

struct Rung {
  State<double> x;
  std::vector<double> steps; ///< trial steps, s
};

template <class Stepper> Rung ring_out(Stepper stepper, double size, const Tolerance& tolerance) {
  LinearWing<double> wing(size);
  Stepping<double> at(wing.system, wing.start);
  stepper.restart(tolerance);
  Rung rung;
  for (double h = 1e-4; at.t < rung_out && rung.steps.size() < 5000;) {
    const double rest = rung_out - at.t;
    const StepVerdict verdict = at.attempt(stepper, wing.system, std::min(h, rest));
    rung.steps.push_back(at.made);
    h = at.made * verdict.factor;
    if (!verdict.accepted()) {
      stepper.rejected();
      continue;
    }
    at.accept(stepper, verdict, at.made);
    if (at.made == rest) at.t = rung_out;
  }
  rung.x = at.x;
  return rung;
}

} // namespace

TEST_CASE(
    "the unit of a state changes no step of a method, and its errors are shares of the state") {
  constexpr double size = 0x1p-200, unit = 0x1p12;
  LinearWing<long double> exact(size);
  Adaptive<long double, Fehlberg78<long double>> fehlberg;
  const State<long double> there = after_steps<long double>(fehlberg, exact, rung_out / 400.L, 400);
  Steppers<double> methods_there_are;
  for (std::size_t m = 0; m < method_names.size(); ++m)
    methods_there_are.with(static_cast<Method>(m), [&](auto& fresh) {
      if (std::decay_t<decltype(fresh)>::fixed_step) return;
      for (const double rtol : {1e-4, 1e-8}) {
        const double atol = 1e-2 * rtol * size;
        const Rung rung = ring_out(fresh, size, {rtol, atol});
        CAPTURE(method_names[m], rtol, rung.steps.size());
        const State<long double> got(rung.x.begin(), rung.x.end());
        CHECK(static_cast<double>(apart(got, there)) < 100 * rtol * size);
        Rung other = ring_out(fresh, unit * size, {rtol, unit * atol});
        CHECK(rung.steps == other.steps);
        for (double& component : other.x) component /= unit;
        CHECK(rung.x == other.x);
      }
    });
}
