/// The work of a motor on its hinge while the hinge's latch is not engaged.
#pragma once

#include "core/dense/step.hpp"
#include "core/laws/motor.hpp"
#include "core/mechanics/workspace.hpp"

namespace wingspread {

/// Work of one motor over a step, by the dense output.
template <class T> class MotorOverStep {
public:
  template <class AnySystem>
  MotorOverStep(const AnySystem& system, const Step<T>& step, int i)
      : terms_(system.wing().motors[i]), piece_(system.work().motors[i]), h_(step.h),
        rate_(step.rate(system.layout().angle(i), system.layout().freedoms())),
        excess_(motor_excess(piece_, step.t, step.h, rate_)) {}

  /// Whether the motor may reach its limit or leave it inside the step. For a pack: in which lanes.
  [[nodiscard]] Truth<T> may_pass_limit() const { return motor_regime(terms_, excess_) == T(2); }
  /// Work over the step, J. @pre !may_pass_limit()
  [[nodiscard]] T work() const {
    return motor_work(terms_, piece_, excess_, rate_, h_, T(0), T(1));
  }
  /// The same where the motor may pass its limit.
  [[nodiscard]] T work_by_parts() const {
    return motor_work_by_parts(terms_, piece_, excess_, rate_, h_);
  }

private:
  const MotorTerms<T>& terms_;
  const MotorPiece<T>& piece_;
  T h_;
  Quintic<T> rate_, excess_;
};

/// Adds each running motor's work over a step, while its hinge's latch is open.
/// @param energy J, by hinge 0 … n; empty if not asked for
template <class T, class AnySystem>
void add_motor_energy(std::vector<T>& energy, const AnySystem& system, const Step<T>& step) {
  for (int i = 1; i < static_cast<int>(energy.size()); ++i) {
    if (!system.motor_runs(i) || system.work().engaged[i]) continue;
    const MotorOverStep<T> motor(system, step, i);
    energy[i] = energy[i] + (motor.may_pass_limit() ? motor.work_by_parts() : motor.work());
  }
}

} // namespace wingspread
