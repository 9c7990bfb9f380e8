/// A wing all of whose latches have engaged, with its bounds by energy alone.
#pragma once

#include "core/proofs/energy_bounds.hpp"
#include "core/proofs/remaining_energy.hpp"
#include "tests/support/random_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wingspread::oracle {

/// A wing with all latches engaged that it has.
template <BaseMotion M = BaseMotion::fixed> struct LatchedWing {
  /// @param stuck hinges that stick when the bounds are prepared, and slip afterwards
  explicit LatchedWing(const Scene& scene, const std::vector<int>& stuck = {})
      : wing(with_numbers(scene)), system(wing, std::nullopt, work), at(system.layout()) {
    for (int i = 1; i <= at.bodies; ++i)
      if (wing.hinges[i].has_latch) system.engage(i);
    for (const int i : stuck) system.set_contact(i, Contact::stuck);
    remaining.prepare(system);
    bounds.prepare(system);
    for (const int i : stuck) system.set_contact(i, Contact::none);
    rest = remaining.rest();
    system.want_forces(true);
  }

  /// What no energy exceeds from this state on, at its own time.
  [[nodiscard]] double energy(const State<double>& x, double t) {
    return remaining.energy(system, x, t).value().whole;
  }

  /// Largest share of its bound that any moment or force takes at the state rest + s·way, s such
  /// that the state has the energy.
  struct Shares {
    double moment = 0, force = 0;
  };
  Shares shares(const State<double>& way, double energy_given, double t = 0) {
    State<double> x;
    double low = 0, high = 1;
    const auto put = [&](double s) {
      x = rest;
      for (int k = 0; k < at.size(); ++k) x[k] += s * way[k];
      return energy(x, t);
    };
    while (put(high) < energy_given) high *= 2;
    for (int pass = 0; pass < 60; ++pass)
      (put((low + high) / 2) < energy_given ? low : high) = (low + high) / 2;
    put(low);
    const double given = energy_given * (1 + 1e-9);
    bounds.bound(system, remaining, {given, given});
    return taken(x, t);
  }

  /// Of the bounds as they were made last.
  Shares taken(const State<double>& x, double t) {
    State<double> dxdt(at.size());
    system(x, dxdt, t);
    Shares worst;
    for (int i = 1; i <= at.bodies; ++i) {
      const Vec2<double>& f = system.work().forces[i];
      worst.moment = std::max(worst.moment, std::abs(system.moment(x, i)) / bounds.moment[i]);
      worst.force = std::max(worst.force, std::sqrt(dot(f, f)) / bounds.force[i]);
    }
    return worst;
  }

  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  Layout at;
  RemainingEnergy<double> remaining;
  EnergyBounds<double> bounds;
  State<double> rest;

private:
  static Wing<double> with_numbers(const Scene& scene) {
    Wing<double> made = make_wing<double>(scene, outward_order(scene));
    set_parameters(made, scene);
    return made;
  }
};

} // namespace wingspread::oracle
