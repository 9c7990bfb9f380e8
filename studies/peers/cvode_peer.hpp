/// SUNDIALS CVODE in the place of this project's integrator: the same right-hand side
/// (core/system.hpp), but CVODE's steps, its error control, its root finding for engagements and
/// its interpolant for peaks. What differs between the two in time is therefore integration alone.
#pragma once

#include "core/deployment.hpp"

#include <memory>

namespace wingspread::study {

/// Runs scenes one after another, keeping CVODE's memory. Not shared by threads.
class CvodePeer {
public:
  /// Adams–Moulton, orders 1–12, or BDF, orders 1–5; both solved by Newton's method with a dense
  /// Jacobian from difference quotients, CVODE's own defaults otherwise. (Adams with fixed-point
  /// iteration, its usual companion, takes a tenth less time up to the first latch, but three to
  /// four times as much over a whole run: latched wings are mildly stiff.)
  enum class Kind { adams, bdf };

  explicit CvodePeer(Kind kind);
  ~CvodePeer();
  CvodePeer(CvodePeer&&) noexcept;
  CvodePeer& operator=(CvodePeer&&) noexcept;

  /// Integrates a deployment as Deployment::run does: of `how` it takes rtol, atol, smoothing,
  /// t_end and max_steps; of `goal` peak_moment, peak_force and first_latch_only, and goes to t_end
  /// otherwise. It yields status, reason, latches, peaks and the work.
  /// @pre the scene's base is fixed, and no hinge has exact friction
  [[nodiscard]] Outcome run(const Scene& scene, const Integration& how, const Goal& goal);

private:
  struct Memory;
  Kind kind_;
  std::unique_ptr<Memory> memory_;
};

} // namespace wingspread::study
