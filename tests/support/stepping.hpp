/// Single steps of a method on a wing, without events, step control or interpolant.
#pragma once

#include "core/methods/steppers.hpp"
#include "tests/support/random_scenes.hpp"

#include <cmath>
#include <vector>

namespace wingspread::oracle {

/// A wing on a fixed base, and a state. No latch engages during steps: it is engaged from the start, or open.
template <class T> struct TestWing {
  Wing<T> wing;
  Workspace<T> work;
  System<T, Tree, BaseMotion::fixed> system;
  State<T> start;

  /// At the scene's start, latches open.
  explicit TestWing(const Scene& scene) : wing(made(scene)), system(wing, std::nullopt, work) {
    system.start(start);
  }
  TestWing(const TestWing&) = delete;
  TestWing& operator=(const TestWing&) = delete;

  void engage_all() {
    for (int i = 1; i <= wing.size(); ++i) system.engage(i);
  }
  /// @param x the angles, then the rates
  void start_from(const std::vector<double>& x) { start.assign(x.begin(), x.end()); }

private:
  [[nodiscard]] static Wing<T> made(const Scene& scene) {
    Wing<T> wing = make_wing<T>(scene, outward_order(scene));
    set_parameters(wing, scene);
    return wing;
  }
};

/// The seed wing half-way to its latches, folding back a little.
template <class T> struct SwingingWing : TestWing<T> {
  SwingingWing() : TestWing<T>(seed_scene()) {
    this->start_from({1.2, -2.5, 2.7, -0.5, 0.4, -0.6});
  }
};

/// The seed wing with every latch engaged, ringing: eigenvalues from 9 to 196 1/s.
template <class T> struct RingingWing : TestWing<T> {
  RingingWing() : TestWing<T>(seed_scene()) {
    this->engage_all();
    this->start_from({0.01, -0.02, 0.015, -0.5, 0.4, -0.6});
  }
};

/// The data that a method carries from step to step.
template <class T> struct Stepping {
  T t = T(0), made = T(0); ///< made: the last trial step
  State<T> x, dxdt, x1, dxdt1;

  template <class AnySystem>
  Stepping(AnySystem& system, const State<T>& start)
      : x(start), dxdt(start.size()), x1(start.size()), dxdt1(start.size()) {
    system(x, dxdt, t);
  }

  template <class Stepper, class AnySystem>
  [[nodiscard]] StepVerdict attempt(Stepper& stepper, AnySystem& system, const T& h) {
    made = h;
    return stepper.attempt(system, Start<T>{t, x, dxdt}, made, x1, dxdt1);
  }

  template <class Stepper> void accept(Stepper& stepper, const StepVerdict& verdict, const T& h) {
    stepper.accepted(verdict, static_cast<double>(h));
    t = t + h;
    std::swap(x, x1);
    std::swap(dxdt, dxdt1);
  }
};

/// Tolerances so loose that every step is accepted.
inline constexpr Tolerance any_error{0, 1e200};

/// The state after `count` equal steps of h, whatever their errors.
template <class T, class Stepper>
[[nodiscard]] State<T> after_steps(Stepper& stepper, TestWing<T>& wing, const T& h, int count,
                                   const Tolerance& tolerance = any_error) {
  Stepping<T> at(wing.system, wing.start);
  stepper.restart(tolerance);
  for (int k = 0; k < count; ++k) {
    (void)at.attempt(stepper, wing.system, h);
    at.t = at.t + h;
    std::swap(at.x, at.x1);
    std::swap(at.dxdt, at.dxdt1);
  }
  return at.x;
}

/// Largest |a − b|.
template <class T> [[nodiscard]] T apart(const State<T>& a, const State<T>& b) {
  using std::abs;
  T largest(0);
  for (std::size_t k = 0; k < a.size(); ++k) largest = larger(largest, T(abs(a[k] - b[k])));
  return largest;
}

/// Tolerances with which Seulex extrapolates just `order` columns, 3 to 10, and accepts every step.
[[nodiscard]] inline Tolerance seulex_of_order(int order) {
  return {std::pow(10., -(order - 1.5) / 0.6), 1e200};
}
/// Tolerances with which BulirschStoer extrapolates two columns, and accepts every step.
inline constexpr Tolerance bulirsch_stoer_of_order_4{1e200, 1e200};
/// Tolerances with which BulirschStoer extrapolates five columns, and refuses every step.
inline constexpr Tolerance bulirsch_stoer_of_order_10{1e-30, 1e-30};

} // namespace wingspread::oracle
