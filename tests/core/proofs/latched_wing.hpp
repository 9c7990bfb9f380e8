/// A wing all of whose latches have engaged, with its bounds by modes.
#pragma once

#include "core/mechanics/energy.hpp"
#include "core/proofs/modal_bounds.hpp"
#include "core/proofs/remaining_energy.hpp"
#include "tests/support/decompositions.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/Dense>

#include <optional>

namespace wingspread::oracle {

/// A wing with all its latches engaged, and its linear model about rest.
template <BaseMotion M> struct Latched {
  /// @param end of the motion on a base that turns faster and faster, s
  explicit Latched(const Scene& scene, double end = 0)
      : wing(with_numbers(scene)), system(wing, std::nullopt, work), at(system.layout()),
        t_end(end) {
    State<double> x;
    system.start(x);
    for (int i = 1; i <= at.bodies; ++i) x[at.angle(i)] = wing.hinges[i].latched, x[at.rate(i)] = 0;
    system.find_sides(x);
    for (int i = 1; i <= at.bodies; ++i)
      if (wing.hinges[i].has_latch) system.engage(i);
    system.want_forces(true);
    remaining.prepare(system);
    still = x;
    has_model = tune(&still[at.rate(1)]);
    if (has_model) bear(rest());
  }

  /// Lets every latch with dissipation bear on the side on which its hinge stands.
  void bear(const State<double>& x) {
    for (int i = 1; i < static_cast<int>(wing.real.size()); ++i)
      if (wing.real[i].dissipation.present)
        system.note_crossing(i, Edge::backlash_high, x[at.angle(i)] > wing.hinges[i].latched);
  }

  /// @param rates rates about which dampers are linearized @return whether all modes decay
  bool tune(const double* rates) {
    modes.reset();
    if (make_rest_model(wing, work, &still[at.angle(1)], rates, t_end, model))
      modes = ModalBounds::make(model, remaining.least_stiffness(), &remaining.rest()[at.angle(1)]);
    return modes.has_value();
  }

  [[nodiscard]] State<double> rest() const {
    State<double> x = still;
    for (int i = 1; i <= at.bodies; ++i) x[at.angle(i)] = model.angles(i - 1);
    return x;
  }

  /// The bounds from a state on; empty if none exist.
  [[nodiscard]] std::optional<HingeBounds>
  bound(const State<double>& x, double t, const std::optional<double>& energy, double spin) const {
    return modes->bound(modes->start(&x[at.angle(1)], &x[at.rate(1)], t), energy, spin);
  }
  /// The bounds inside the energy's box.
  [[nodiscard]] std::optional<HingeBounds> bound_in_reach(const State<double>& x, double energy,
                                                          double spin) {
    return modes->bound_in_reach(modes->start(&x[at.angle(1)], &x[at.rate(1)], 0), energy, spin);
  }

  [[nodiscard]] Eigen::VectorXd accelerations(const State<double>& x) {
    State<double> dxdt(at.size());
    system(x, dxdt, 0);
    return Eigen::Map<Eigen::VectorXd>(&dxdt[at.rate(1)], at.bodies);
  }

  /// Largest rate at which the linear model changes, rad/s.
  [[nodiscard]] double fastest() const {
    const int n = at.bodies;
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(2L * n, 2L * n);
    L.topRightCorner(n, n).setIdentity();
    L.bottomLeftCorner(n, n) = -model.mass.inverse() * model.stiffness;
    L.bottomRightCorner(n, n) = -model.mass.inverse() * model.damping;
    return L.eigenvalues().cwiseAbs().maxCoeff();
  }

  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  Layout at;
  double t_end;
  RemainingEnergy<double> remaining;
  State<double> still;
  RestModel model;
  std::optional<ModalBounds> modes;
  bool has_model = false;

private:
  static Wing<double> with_numbers(const Scene& scene) {
    Wing<double> made = make_wing<double>(scene, outward_order(scene));
    set_parameters(made, scene);
    return made;
  }
};

inline Scene with_latches(Scene scene, Draws& draws) {
  for (Hinge& hinge : scene.hinges)
    hinge.latch = Latch{draws.log_uniform(1e3, 1e5), draws.log_uniform(1, 1e3)};
  return scene;
}

} // namespace wingspread::oracle
