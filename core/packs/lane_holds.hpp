/// Stuck hinges of the runs in the lanes: what holds them at both ends of a step, and whether one may let go inside.
///
/// The first test is Holding::comes_near, by the same expressions: it excludes a release, and never finds one.
#pragma once

#include "core/events/holding.hpp"
#include "core/packs/fields.hpp"
#include "core/packs/pack_engine.hpp"

#include <array>
#include <vector>

namespace wingspread {

template <int W> class LaneHolds {
  using P = Pack<W>;
  using Mask = typename P::Mask;

public:
  void resize(const Layout& at) {
    const P none(0.0);
    for (std::vector<P>* v : {&before_, &at_end_, &by_method_, &excess_before_, &excess_at_end_})
      v->assign(at.bodies + 1, none);
    holds_ = none;
  }

  /// Sets the hinges that stick in a lane. @param task null: the lane has no run
  void load(int lane, const LaneTask* task, Workspace<P>& work) {
    for (std::size_t i = 1; i < before_.size(); ++i) {
      const bool sticks = task && task->work.contact[i] == Contact::stuck;
      work.locks[i].v[lane] = sticks ? 1 : 0;
      before_[i].v[lane] = sticks ? task->held_before[i] : 0;
      excess_before_[i].v[lane] = sticks ? task->excess_before[i] : 0;
    }
    work.stuck += (task ? task->work.stuck : 0) - stuck_[lane];
    stuck_[lane] = task ? task->work.stuck : 0;
    holds_.v[lane] = stuck_[lane] > 0 ? 1 : 0;
  }

  /// @param by_method whether the run is given what held at the end before its momenta were restored
  /// @param moved whether the lane's state is no longer that of the task
  void unload(int lane, LaneResult& result, bool by_method, bool moved) const {
    if (stuck_[lane] == 0) return;
    get_lane(lane, by_method ? by_method_ : at_end_, result.held_at_end);
    if (!moved) return;
    get_lane(lane, before_, result.held_before);
    get_lane(lane, excess_before_, result.excess_before);
  }

  /// The lanes in which any hinge sticks.
  [[nodiscard]] Mask lanes() const { return holds_ > P(0.0); }
  /// Moments on stuck hinges at the step's start, 1 … n, N·m.
  [[nodiscard]] const std::vector<P>& before() const { return before_; }

  /// Keeps the moments on stuck hinges at the step's end. @pre the system's last evaluation was there
  template <class AnySystem> void keep_at_end(const AnySystem& system, const Step<P>& step) {
    at_end_ = system.work().holding;
    for (int i = 1; i < static_cast<int>(before_.size()); ++i)
      if (any(system.is_locked(i))) excess_at_end_[i] = Holding<P>::excess(system, step.x1, i);
  }

  /// @return lanes in which the friction of a stuck hinge may pass its limit. @pre as keep_at_end
  template <class AnySystem>
  [[nodiscard]] Mask may_release(const AnySystem& system, const Step<P>& step) {
    bound_.over_step(system, step);
    keep_at_end(system, step);
    by_method_ = at_end_;
    Mask found{};
    for (int i = 1; i < static_cast<int>(before_.size()); ++i) {
      const Mask locked = system.is_locked(i);
      const auto slips = [&] {
        return locked && may_slip(bound_, i, excess_before_[i], excess_at_end_[i]);
      };
      if (!any(slips())) continue;
      bound_.narrow(system, step, i);
      found = found || slips();
    }
    return found;
  }

  /// Moves to the end of an accepted step in these lanes.
  void accept(const Mask& these) {
    for (std::size_t i = 1; i < before_.size(); ++i) {
      before_[i] = select(these, at_end_[i], before_[i]);
      excess_before_[i] = select(these, excess_at_end_[i], excess_before_[i]);
    }
  }

private:
  // of stuck hinges, 1 … n, N·m: moments, and the excess of friction over its limit
  std::vector<P> before_, excess_before_; ///< at the step's start
  std::vector<P> at_end_, excess_at_end_;
  std::vector<P> by_method_; ///< at the end, before momenta are restored
  HeldLoadBound<P> bound_;
  std::array<int, W> stuck_{}; ///< hinges that stick in each lane
  P holds_;                    ///< 1 where any does, else 0
};

} // namespace wingspread
