/// Free bases in packs: watches how far each run's base turns.
#pragma once

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
    base_ = base_at_end_ = {none, none, none, none};
  }

  void load(int lane, const LaneTask& task) { set_lane(lane, base_, task.base); }
  void unload(int lane, LaneResult& result) const { get_lane(lane, base_, result.base); }

  /// @return the lanes where the base's largest turn or rate may lie inside the step
  [[nodiscard]] Mask may_swing_further(const Layout& at, const Step<P>& step) {
    base_at_end_ = base_;
    return base_at_end_.raise_by_ends(at, step);
  }

  /// Keeps the excursions up to the end of an accepted step in these lanes.
  void accept(const Mask& these) { assign_where(these, base_, base_at_end_); }

private:
  BaseExcursion<P> base_, base_at_end_; ///< up to the step's start, and up to its end
};

} // namespace wingspread
