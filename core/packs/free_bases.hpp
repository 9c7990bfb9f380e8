/// Free bases in packs: restores the momenta that each run conserves, and watches how far its base
/// turns.
///
/// The end of an accepted step is given the conserved momenta, as Integrator::restore_momentum does, and
/// the right-hand side is evaluated there again. A run that asks gets the method's own end of the step,
/// because it restores the momenta itself.
#pragma once

#include "core/mechanics/energy.hpp"
#include "core/packs/fields.hpp"
#include "core/peaks/base_peaks.hpp"
#include "core/run/lane_protocol.hpp"

namespace wingspread {

template <int W> class FreeBases {
  using P = Pack<W>;
  using Mask = typename P::Mask;

public:
  FreeBases() {
    const P none(0.0);
    conserved_ = {{none, none}, {none, none}, none};
    base_ = base_at_end_ = {none, none, none, none};
    evaluations_ = none;
  }

  void load(int lane, const LaneTask& task) {
    set_lane(lane, conserved_, task.conserved);
    set_lane(lane, base_, task.base);
    evaluations_.v[lane] = 0;
  }

  /// @param forces whether they are asked for
  void unload(int lane, LaneResult& result, bool forces) const {
    get_lane(lane, by_method_, result.x1), get_lane(lane, slope_by_method_, result.dxdt1);
    if (forces) get_lane(lane, forces_by_method_, result.forces_at_end);
    get_lane(lane, base_, result.base);
  }

  /// Gives the step's end the conserved momenta. Costs an evaluation and a pass outward.
  template <class Topology>
  void restore_momenta(System<P, Topology, BaseMotion::free>& system, Step<P>& step) {
    by_method_ = step.x1, slope_by_method_ = step.dxdt1, forces_by_method_ = system.work().forces;
    if (!system.wing().plates.empty()) return; // air changes the momenta
    const P end = step.t + step.h;
    keep_momentum(system, conserved_, step.x1, end);
    system(step.x1, step.dxdt1, end);
  }

  /// @return the lanes where the base's largest turn or rate may lie inside the step
  [[nodiscard]] Mask may_swing_further(const Layout& at, const Step<P>& step) {
    base_at_end_ = base_;
    return base_at_end_.raise_by_ends(at, step);
  }

  /// Counts an accepted step in these lanes. @param restores whether momenta are restored
  void accept(const Mask& these, bool restores) {
    assign_where(these, base_, base_at_end_);
    if (restores) evaluations_ = select(these, P(evaluations_ + P(1.0)), evaluations_);
  }

  /// Evaluations made for momenta since `load`.
  [[nodiscard]] const P& evaluations() const { return evaluations_; }

private:
  Conserved<P> conserved_;
  BaseExcursion<P> base_, base_at_end_; ///< up to the step's start, and up to its end
  State<P> by_method_, slope_by_method_;
  std::vector<Vec2<P>> forces_by_method_;
  P evaluations_;
};

} // namespace wingspread
