/// Runs on free bases in packs: what each keeps of its momenta, and how far its base has turned.
///
/// A step accepted is given the momenta that it keeps, as Integrator::restore_momentum does, and the
/// right-hand side is evaluated anew at its end. The method's own end is left as it was for a run
/// that asks: it does that itself.
#pragma once

#include "core/mechanics/energy.hpp"
#include "core/packs/fields.hpp"
#include "core/peaks/base_peaks.hpp"

namespace wingspread {

template <int W> class FreeBases {
  using P = Pack<W>;
  using Mask = typename P::Mask;

public:
  FreeBases() {
    const P none(0.0);
    kept_ = {{none, none}, {none, none}, none};
    base_ = after_ = {none, none, none, none};
    projections_ = none;
  }

  void carry(int lane, const Handover& run) {
    set_lane(lane, kept_, run.kept);
    set_lane(lane, base_, run.base);
    projections_.v[lane] = 0;
  }

  /// Gives the step's end what is kept. Cost an evaluation and a pass outward.
  template <class Topology>
  void restore_momenta(System<P, Topology, BaseMotion::free>& system, Step<P>& step) {
    by_method_ = step.x1, slope_by_method_ = step.dxdt1, forces_by_method_ = system.work().forces;
    if (!system.wing().plates.empty()) return; // the air takes some
    const P end = step.t + step.h;
    keep_momentum(system, kept_, step.x1, end);
    system(step.x1, step.dxdt1, end);
  }

  /// @return where the base's largest turn or rate may lie inside the step
  [[nodiscard]] Mask may_swing_further(const Layout& at, const Step<P>& step) {
    after_ = base_;
    return after_.raise_by_ends(at, step);
  }

  /// A step was accepted, in these lanes. @param restores whether momenta are restored
  void accept(const Mask& these, bool restores) {
    assign_where(these, base_, after_);
    if (restores) projections_ = select(these, P(projections_ + P(1.0)), projections_);
  }

  /// Evaluations made for momenta since the lane's run was taken.
  [[nodiscard]] const P& projections() const { return projections_; }

  /// The method's own end of the step made last, and the excursion up to its start.
  /// @param forces whether they are asked for
  void hand_back(int lane, const Place& place, bool forces) const {
    get_lane(lane, by_method_, place.x1), get_lane(lane, slope_by_method_, place.dxdt1);
    if (forces) get_lane(lane, forces_by_method_, place.forces_at_end);
    get_lane(lane, base_, place.base);
  }

private:
  Conserved<P> kept_;
  BaseExcursion<P> base_, after_; ///< up to the step's start, and to its end
  State<P> by_method_, slope_by_method_;
  std::vector<Vec2<P>> forces_by_method_;
  P projections_;
};

} // namespace wingspread
