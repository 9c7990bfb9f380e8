/// One evaluation of the right-hand side in any state, and its difference from the dense solve.
#pragma once

#include "core/mechanics/energy.hpp"
#include "core/mechanics/system.hpp"
#include "tests/support/dense_wing.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace wingspread::oracle {

/// Relative hinge accelerations, hinge forces and moments of the recursion, in Scene order, the
/// base's accelerations, and the energies.
template <class T> struct Evaluated {
  std::vector<T> hinge;
  std::vector<Vec2<T>> force;
  std::vector<T> moment;
  Vec2<T> base;
  T base_spin;
  T kinetic, potential;
};

template <class T, BaseMotion M>
Evaluated<T> evaluate(const Wing<T>& wing, const WingState<double>& state) {
  Workspace<T> work;
  System<T, Tree, M> system(wing, std::nullopt, work);
  const Layout& at = system.layout();
  State<T> x, dxdt;
  system.start(x);
  dxdt = x;
  if (M == BaseMotion::free) {
    const int v = at.freedoms();
    x[0] = T(state.base_position.x()), x[1] = T(state.base_position.y()),
    x[2] = T(state.base_angle);
    x[v] = T(state.base_velocity.x()), x[v + 1] = T(state.base_velocity.y()),
    x[v + 2] = T(state.base_rate);
  }
  for (int i = 1; i <= at.bodies; ++i) {
    const int hinge = wing.hinge_of[i];
    x[at.angle(i)] = T(state.angles[hinge]);
    x[at.rate(i)] = T(state.rates[hinge]);
    if (state.engagement[hinge] > 0) system.engage(i);
  }
  system.find_sides(x);
  system.want_forces(true);
  system(x, dxdt, T(0));
  Evaluated<T> out{std::vector<T>(at.bodies),
                   std::vector<Vec2<T>>(at.bodies),
                   std::vector<T>(at.bodies),
                   {},
                   T(0),
                   T(0),
                   T(0)};
  for (int i = 1; i <= at.bodies; ++i) {
    out.hinge[wing.hinge_of[i]] = dxdt[at.rate(i)];
    out.force[wing.hinge_of[i]] = work.forces[i];
    out.moment[wing.hinge_of[i]] = system.moment(x, i);
  }
  if (M == BaseMotion::free) {
    const int v = at.freedoms();
    out.base = {dxdt[v], dxdt[v + 1]}, out.base_spin = dxdt[v + 2];
  } else { // as told, as seen by one who falls
    out.base = work.frames[0].acceleration + wing.base.gravity;
    out.base_spin = work.frames[0].angular_acceleration;
  }
  out.kinetic = kinetic_energy(system, x, T(0));
  out.potential = potential_energy(system, x, T(0));
  return out;
}

template <class T> Evaluated<T> evaluate(const Scene& scene, const WingState<double>& state) {
  Scene posed = scene; // a prescribed base stands at t = 0 where the state has it
  if (scene.base.motion == BaseMotion::prescribed)
    posed.base.angle = state.base_angle, posed.base.rate = state.base_rate;
  Wing<T> wing = make_wing<T>(posed, outward_order(posed));
  set_parameters(wing, posed);
  switch (wing.base.motion) { // gravity accelerates a fixed base upwards
  case BaseMotion::prescribed:
    return evaluate<T, BaseMotion::prescribed>(wing, state);
  case BaseMotion::free:
    return evaluate<T, BaseMotion::free>(wing, state);
  case BaseMotion::fixed:
    break;
  }
  return evaluate<T, BaseMotion::fixed>(wing, state);
}

/// The largest |a − b| and the largest |b| of a kind.
struct Deviation {
  double worst = 0, scale = 0;
  template <class A, class B> void note(const A& got, const B& expected) {
    REQUIRE(std::isfinite(static_cast<double>(got))); // std::max would ignore a NaN
    const B difference = B(got) - expected;
    worst = std::max(worst, std::abs(static_cast<double>(difference)));
    scale = std::max(scale, std::abs(static_cast<double>(expected)));
  }
  [[nodiscard]] double relative() const { return scale > 0 ? worst / scale : worst; }
};

/// The largest relative deviation of accelerations. Angular ones (hinges and base) are relative to the largest angular
/// one; linear ones of the base to the largest of all.
template <class T, class Reference>
double acceleration_deviation(const Evaluated<T>& got, const WingResponse<Reference>& expected) {
  Deviation turning, base;
  for (std::size_t i = 0; i < got.hinge.size(); ++i)
    turning.note(got.hinge[i], expected.hinge_accelerations[i]);
  turning.note(got.base_spin, expected.base_angular_acceleration);
  base.scale = turning.scale;
  base.note(got.base.x, expected.base_acceleration.x());
  base.note(got.base.y, expected.base_acceleration.y());
  return std::max(turning.relative(), base.relative());
}

template <class T, class Reference>
double force_deviation(const Evaluated<T>& got, const WingResponse<Reference>& expected) {
  Deviation forces;
  for (std::size_t i = 0; i < got.force.size(); ++i) {
    forces.note(got.force[i].x, expected.forces(0, i));
    forces.note(got.force[i].y, expected.forces(1, i));
  }
  return forces.relative();
}

template <class T, class Reference>
double moment_deviation(const Evaluated<T>& got, const WingResponse<Reference>& expected) {
  Deviation moments;
  for (std::size_t i = 0; i < got.moment.size(); ++i)
    moments.note(got.moment[i], expected.moments[i]);
  return moments.relative();
}

} // namespace wingspread::oracle
