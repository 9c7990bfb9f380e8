/// The linear model of a wing about a configuration, from core/'s right-hand side.
///
/// | symbol | meaning                                            | shape | unit      |
/// |--------|----------------------------------------------------|-------|-----------|
/// | y      | hinge angles minus those at rest                   | n     | rad       |
/// | M      | mass matrix in hinge angles, at the configuration  | n×n   | kg·m²     |
/// | K, D   | stiffness and damping of the hinges, diagonal      | n×n   | N·m/rad … |
/// | λ      | eigenvalues of [0 E; −M⁻¹K −M⁻¹D]                  | 2n    | 1/s       |
///
/// The model is exact at rest only: elsewhere moments depend on the panels' directions, and the model neglects this.
#pragma once

#include "core/mechanics/system.hpp"

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace wingspread::study {

/// A complex pair, given by the eigenvalue above the real axis, or a real eigenvalue.
using Eigenvalue = std::complex<double>;

/// A wing on a fixed base with its right-hand side. Its latches can be engaged one by one or all together.
class LinearWing {
public:
  using AnySystem = System<double, Tree, BaseMotion::fixed>;

  explicit LinearWing(const Scene& scene);
  LinearWing(const LinearWing&) = delete;
  LinearWing& operator=(const LinearWing&) = delete;

  [[nodiscard]] AnySystem& system() { return system_; }
  [[nodiscard]] int hinges() const { return wing_.size(); }

  /// @param hinge index into Scene::hinges
  void engage(int hinge);
  void engage_all();

  /// A state of these angles and rates, Scene order.
  [[nodiscard]] State<double> state(const std::vector<double>& angles,
                                    const std::vector<double>& rates) const;

  /// The state at rest in which springs and engaged latches balance. @pre all latches are engaged
  [[nodiscard]] State<double> rest() const;

  /// λ of the hinges with engaged latches, the others free to turn: one of each complex pair, slowest first.
  [[nodiscard]] std::vector<Eigenvalue> eigenvalues(const State<double>& x);

private:
  Wing<double> wing_;
  Workspace<double> work_;
  AnySystem system_;
};

} // namespace wingspread::study
