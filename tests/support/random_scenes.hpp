/// Scenes for tests: seeded random ones, the seed scene, and scenes with a known answer.
#pragma once

#include "core/scene/scene.hpp"
#include "tests/support/dense_wing.hpp"

#include <cstdint>
#include <optional>
#include <random>

namespace wingspread::oracle {

/// Draws that are the same on every platform: they use mt19937_64, but no distribution of <random>, because
/// implementations of these differ.
class Draws {
public:
  explicit Draws(std::uint64_t seed) : engine_(seed) {}
  [[nodiscard]] double uniform(double lower, double upper);     ///< in [lower, upper)
  [[nodiscard]] double log_uniform(double lower, double upper); ///< 0 < lower
  [[nodiscard]] double sign();                                  ///< −1 or 1
  [[nodiscard]] bool chance(double probability);
  [[nodiscard]] int below(int count);                 ///< in [0, count)
  [[nodiscard]] Eigen::Vector2d vector(double reach); ///< each component in [−reach, reach)

private:
  std::mt19937_64 engine_;
};

/// What random_scene may draw.
struct RandomScene {
  int bodies = 5;
  bool branching = true;            ///< false: a chain
  std::optional<BaseMotion> motion; ///< none: any of the three
  bool springs = true;
  bool harness = true;
  bool friction = true;                      ///< regularized
  bool latches = true;                       ///< on every hinge
  double mass_lower = 0.1, mass_upper = 100; ///< kg, log-uniform
  double reach = 1;                          ///< of the hinge vectors, m
};

/// A random scene. Bodies and hinges stand in random order. Inertias are log-uniform in
/// [0.02, 0.5]·mass·reach².
[[nodiscard]] Scene random_scene(std::uint64_t seed, const RandomScene& options = {});

/// A random state: angles in a full turn, rates up to 2 rad/s, each latch engaged with probability 1/2, and a motion of
/// the base that the scene allows.
[[nodiscard]] WingState<double> random_state(std::uint64_t seed, const Scene& scene);

/// The three-panel seed scene.
[[nodiscard]] Scene seed_scene();

/// A tumbling free spacecraft with two mirrored three-panel wings,
/// the left one's springs 3 % stronger.
[[nodiscard]] Scene two_wing_free_spacecraft();

/// A free spacecraft at rest with two mirrored two-panel wings: its latches engage in pairs.
[[nodiscard]] Scene symmetric_tree();

/// One panel (10 kg, 0.5 kg·m², centre of mass 0.5 m from its hinge) on a fixed base at the origin,
/// from 90° to 0 under a spring that goes from 2 N·m to none: no friction, no latch. It swings as
/// φ = π/2 cos(ωt), ω² = 2/(π/2 · 3).
[[nodiscard]] Scene harmonic_panel();

/// The same panel under a constant 2 N·m, with a latch (1e4 N·m/rad, 100 N·m·s/rad). Its acceleration is constant before
/// the latch engages; then it is a damped oscillator.
[[nodiscard]] Scene latching_panel();

} // namespace wingspread::oracle
