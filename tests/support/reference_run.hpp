/// Whole deployments by routes that share nothing with core/: the dense formulation of
/// dense_wing.hpp integrated by SUNDIALS CVODE (multistep, its own root finding), or by
/// Fehlberg's order-8 Runge–Kutta formula in extended or quadruple precision (events and peaks
/// located by real steps, never on an interpolant).
///
/// The laws of real hinges have kinks and jumps (hinge_laws.hpp). The step control treats them as any other error: it
/// reduces the steps until the error is within tolerance. At a jump this ends only if the smallest possible steps meet the
/// tolerance: use 1e-14 rather than 1e-16 in long double.
#pragma once

#include "core/scene/scene.hpp"
#include "tests/support/dense_wing.hpp"

#include <optional>
#include <vector>

namespace wingspread::oracle {

struct ReferenceOptions {
  double t_end = 12;               ///< s; the run never ends before
  double rtol = 1e-12;             ///< relative, per step; high_precision_run can do with 1e-17
  double atol = 1e-13;             ///< absolute, per step, rad, rad/s, m, m/s
  double max_step = 0.05;          ///< s
  bool stiff = false;              ///< CVODE: BDF instead of Adams
  std::optional<double> smoothing; ///< ε of the smoothed latch, rad and s; none: event latch
  double coincidence = 1e-10;      ///< s; latches due this soon after another engage with it
};

/// A hinge reached its latched angle from the stowed side.
struct ReferenceLatch {
  int hinge;                 ///< index into Scene::hinges
  double time;               ///< s
  std::vector<double> rates; ///< φ̇ of all hinges then, Scene order, rad/s
};

/// The largest magnitude of a quantity, and when it was first reached. The time is known to about
/// the square root of the precision of the value.
struct ReferencePeak {
  double value = -1;
  double time = 0; ///< s
};

/// The results of a reference run. Vectors over hinges are in Scene order.
struct ReferenceOutcome {
  std::vector<ReferenceLatch> latches;    ///< in order of time
  std::vector<ReferencePeak> peak_moment; ///< of |M|, N·m
  std::vector<ReferencePeak> peak_force;  ///< of |f|, N
  std::vector<ReferencePeak> overtravel;  ///< beyond the stowed angle, ≥ 0, rad
  WingState<double> final;
  WingBalance<double> initial_balance, final_balance;
  double energy_drift = 0;   ///< largest |E(t) − E(0)| up to the first latch, J
  double momentum_drift = 0; ///< largest change of a component of linear momentum, kg·m/s
  double spin_drift = 0;     ///< largest change of angular momentum, kg·m²/s
  long steps = 0;            ///< accepted
};

/// CVODE in double, Adams or BDF.
/// @throws std::runtime_error when CVODE gives up.
[[nodiscard]] ReferenceOutcome cvode_run(const Scene& scene, const ReferenceOptions& options = {});

/// Fehlberg, order 8, in Scalar: long double or Quad (some hundred times slower).
/// @throws std::runtime_error when the step size underflows.
template <class Scalar>
[[nodiscard]] ReferenceOutcome high_precision_run(const Scene& scene,
                                                  const ReferenceOptions& options = {});

extern template ReferenceOutcome high_precision_run<long double>(const Scene&,
                                                                 const ReferenceOptions&);
extern template ReferenceOutcome high_precision_run<Quad>(const Scene&, const ReferenceOptions&);

} // namespace wingspread::oracle
