/// Wings whose hinges have exact friction.
#pragma once

#include "tests/support/closed_forms.hpp"

namespace wingspread::oracle {

/// The scene with its exact friction regularized over `width`, rad/s.
inline Scene regularized(Scene scene, double width) {
  for (Hinge& hinge : scene.hinges) {
    if (hinge.friction.model != FrictionModel::exact) continue;
    hinge.friction.model = FrictionModel::regularized;
    hinge.friction.regularization_rate = width;
  }
  return scene;
}

/// Whether a sticking hinge has kept its angle, up to round-off: a method adds up weighted copies of the constant angle,
/// and their sum is not exact.
inline bool stayed(double angle, double at) { return std::abs(angle - at) < 1e-13 * std::abs(at); }

/// The seed scene with exact friction on root, mid and tip.
inline Scene rubbed_seed(double root, double mid, double tip) {
  Scene scene = seed_scene();
  rub(scene.hinges[0], root), rub(scene.hinges[1], mid), rub(scene.hinges[2], tip);
  return scene;
}

/// Three panels that are nearly in line. The outer hinges lack the torque to move. The root's acceleration does not release
/// them; the shock of the root's latch does.
inline Scene held_until_the_root_latches() {
  Scene scene = rubbed_seed(0.3, 4, 1.5);
  const HingeTorque springs[] = {{5, 5}, {0.2, 0.2}, {0.1, 0.1}};
  for (int i = 0; i < 3; ++i) scene.hinges[i].spring = springs[i];
  scene.hinges[1].stowed = scene.hinges[2].stowed = 0.4;
  return scene;
}

/// The root's motion in this scene while the outer hinges stick: that of one rigid body.
inline ConstantDrive held_root(const Scene& scene) {
  const DenseWing<double> wing(regularized(scene, 1));
  WingState<double> state = wing.initial_state();
  state.rates(0) = 1;
  return {(5 - 0.3) / (2 * wing.balance(state).kinetic), std::numbers::pi / 2};
}

/// A panel on a prescribed base, without spring:
/// sticks by `static_level`, slides against `kinetic`.
inline Scene carried_panel(double kinetic, double static_level) {
  Scene scene = latching_panel();
  scene.base.motion = BaseMotion::prescribed;
  scene.hinges[0].spring = {0, 0};
  rub(scene.hinges[0], kinetic, static_level);
  return scene;
}

} // namespace wingspread::oracle
