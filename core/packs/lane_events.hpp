/// Events of the runs in the lanes: latches that engage or let go, edges, hinges that come to rest, angles for which
/// holds wait.
///
/// The tests inside a step are the first tests of a run alone. They exclude an event, or leave the search to the run.
#pragma once

#include "core/events/contact.hpp"
#include "core/events/latches.hpp"
#include "core/events/slipping.hpp"
#include "core/packs/fields.hpp"
#include "core/packs/pack_engine.hpp"

#include <array>
#include <vector>

namespace wingspread {

template <int W> class LaneEvents {
  using P = Pack<W>;
  using Mask = typename P::Mask;

public:
  /// @param real size of Wing::real
  void resize(const Layout& at, std::size_t real) {
    const P none(0.0);
    for (std::vector<P>* v : {&waits_, &slides_, &awaits_angle_}) v->assign(at.bodies + 1, none);
    for (std::vector<P>& ways : ways_) ways.assign(real, none);
    may_happen_.assign(at.bodies + 1, Mask{});
  }

  /// Copies the states of the run's latches, contacts and holds, and on which side of its edges each hinge is.
  void load(int lane, const Workspace<double>& work) {
    for (std::size_t i = 1; i < waits_.size(); ++i) {
      slides_[i].v[lane] = sense_of(work.contact[i]);
      waits_[i].v[lane] = work.engaged[i] ? 0 : 1;
      awaits_angle_[i].v[lane] = work.watches[i] ? 1 : 0;
    }
    for (int e = 0; e < edges_of_hinge; ++e)
      for (std::size_t i = 1; i < ways_[e].size(); ++i)
        ways_[e][i].v[lane] = work.above[i][e] != 0 ? -1 : 1;
  }

  /// The lanes in which the latch of hinge i is not engaged.
  [[nodiscard]] Mask waits(int i) const { return waits_[i] > P(0.0); }

  /// @return lanes in which an event may lie inside the step
  template <class AnySystem>
  [[nodiscard]] Mask lie_inside(const AnySystem& system, const Step<P>& step) {
    const auto& wing = system.wing();
    Mask any{};
    for (int i = 1; i <= wing.size(); ++i) {
      Mask found{};
      const HingeTerms<P>& hinge = wing.hinges[i];
      if (hinge.has_latch && !has_capture(wing, i))
        found = found || (waits(i) && may_engage(system, step, i));
      if (wing.can_let_go) found = found || may_let_go(system, step, i);
      if (!wing.real.empty())
        found = found || (!system.is_locked(i) && may_pass_edge(system, step, i));
      if (wing.can_stick) found = found || (slides(i) && may_come_to_rest(system, step, i));
      if (waits_for_hinge(wing, i))
        found = found || (watches(i) && may_pass_awaited_angle(system, step, i));
      may_happen_[i] = found;
      any = any || found;
    }
    return any;
  }

  /// Copies which hinges may have events in the last step out of a lane.
  void unload(int lane, LaneResult& result) const {
    for (std::size_t i = 1; i < may_happen_.size(); ++i)
      result.may_happen[i] = may_happen_[i].bits[lane] != 0 ? 1 : 0;
  }

  /// @return lanes in which an event of hinge i lies within an instant of the step's end
  template <class AnySystem>
  [[nodiscard]] Mask lie_at_end(const AnySystem& system, const Step<P>& step, int i) const {
    const auto& wing = system.wing();
    Mask found{};
    if (wing.hinges[i].has_latch) found = found || (waits(i) && engages_at_end(system, step, i));
    if (wing.can_stick) found = found || (slides(i) && rests_at_end(system, step, i));
    if (waits_for_hinge(wing, i)) found = found || (watches(i) && is_seen_at_end(system, step, i));
    return found;
  }

private:
  template <class AnySystem>
  [[nodiscard]] static Quintic<P> angle_of(const AnySystem& system, const Step<P>& step, int i) {
    return step.coordinate(system.layout().angle(i), system.layout().freedoms());
  }

  /// Lanes in which hinge i may reach `there` in this sense in the step.
  template <class AnySystem>
  [[nodiscard]] static Mask may_reach(const AnySystem& system, const Step<P>& step, int i,
                                      const P& there, const P& sense) {
    Mask any{};
    const Layout& at = system.layout();
    for (const P& c : step.distance(at.angle(i), at.freedoms(), there))
      any = any || !(sense * c < P(0.0));
    return any;
  }

  [[nodiscard]] static bool waits_for_hinge(const Wing<P>& wing, int i) {
    return !wing.releases.empty() && wing.releases[i].after > 0;
  }

  template <class AnySystem>
  [[nodiscard]] static Mask may_engage(const AnySystem& system, const Step<P>& step, int i) {
    const HingeTerms<P>& hinge = system.wing().hinges[i];
    return may_reach(system, step, i, hinge.latched, hinge.sense);
  }

  template <class AnySystem>
  [[nodiscard]] Mask may_pass_edge(const AnySystem& system, const Step<P>& step, int i) const {
    const auto& wing = system.wing();
    Mask any{};
    if (!wing.real[i].has_edge()) return any;
    const Layout& at = system.layout();
    const Quintic<P> way = step.way(at.angle(i), at.freedoms());
    for (int e = 0; e < edges_of_hinge; ++e) {
      const Edge edge = static_cast<Edge>(e);
      const bool passes = edge == Edge::pass;
      if (!has_edge(wing, i, edge, wing.hinges[i].has_latch && !passes)) continue;
      const P start = step.x[at.angle(i)] - edge_angle(wing, i, edge);
      const bool of_latch = edge == Edge::backlash_low || edge == Edge::backlash_high;
      for (const P& c : way) {
        const Mask stays = ways_[e][i] * (start + c) < P(0.0);
        any = any || (of_latch ? !stays && !waits(i) : passes ? !stays && waits(i) : !stays);
      }
    }
    return any;
  }

  /// The first test of first_letting_go, where the latch is engaged.
  template <class AnySystem>
  [[nodiscard]] Mask may_let_go(const AnySystem& system, const Step<P>& step, int i) const {
    const CaptureTerms<P>& latch = system.wing().real[i].capture;
    const Mask engaged = latch.may_let_go() && !waits(i);
    if (!any(engaged)) return engaged;
    const Quintic<P> angle = angle_of(system, step, i);
    const Layout& at = system.layout();
    const Quintic<P> rate = step.rate(at.angle(i), at.freedoms());
    return engaged && !(latch.most_excess(hull(angle), hull(rate)) < P(0.0));
  }

  /// The first test of Releases::first_passage.
  template <class AnySystem>
  [[nodiscard]] static Mask may_pass_awaited_angle(const AnySystem& system, const Step<P>& step,
                                                   int i) {
    const ReleaseTerms<P>& hold = system.wing().releases[i];
    return may_reach(system, step, hold.after, hold.angle, system.wing().hinges[hold.after].sense);
  }
  /// As Releases::passes_now.
  template <class AnySystem>
  [[nodiscard]] static Mask is_seen_at_end(const AnySystem& system, const Step<P>& step, int i) {
    const Layout& at = system.layout();
    const ReleaseTerms<P>& hold = system.wing().releases[i];
    const P& sense = system.wing().hinges[hold.after].sense;
    return engages_at(P(step.t + step.h), P(sense * (step.x1[at.angle(hold.after)] - hold.angle)),
                      P(sense * step.x1[at.rate(hold.after)]));
  }

  [[nodiscard]] Mask slides(int i) const { return !(slides_[i] == P(0.0)); }
  [[nodiscard]] Mask watches(int i) const { return awaits_angle_[i] > P(0.0); }

  /// Whether a hinge that slides may turn back: the first test of first_rest.
  template <class AnySystem>
  [[nodiscard]] Mask may_come_to_rest(const AnySystem& system, const Step<P>& step, int i) const {
    Mask any{};
    for (const P& c : way_to_rest(system.layout(), step, i, -slides_[i]))
      any = any || !(c < P(0.0));
    return any;
  }

  /// As Latches::engage_simultaneous.
  template <class AnySystem>
  [[nodiscard]] Mask engages_at_end(const AnySystem& system, const Step<P>& step, int i) const {
    const Layout& at = system.layout();
    const HingeTerms<P>& hinge = system.wing().hinges[i];
    const bool may_miss = has_capture(system.wing(), i);
    const P way = may_miss ? ways_[static_cast<int>(Edge::pass)][i] : hinge.sense;
    const P gap = way * (step.x1[at.angle(i)] - hinge.latched), rate = way * step.x1[at.rate(i)];
    const Mask there = engages_at(P(step.t + step.h), gap, rate);
    return may_miss ? there && rate > P(0.0) : there;
  }

  /// As stop_simultaneous.
  template <class AnySystem>
  [[nodiscard]] Mask rests_at_end(const AnySystem& system, const Step<P>& step, int i) const {
    const int r = system.layout().rate(i);
    const P rate = -(slides_[i] * step.x1[r]);
    return rests_at(P(step.t + step.h), rate, P(-(slides_[i] * step.dxdt1[r])));
  }

  std::vector<Mask>
      may_happen_; ///< 1 … n: lanes in which an event of the hinge may lie inside the last step
  std::vector<P> waits_;  ///< 1: the latch is not engaged, else 0
  std::vector<P> slides_; ///< sense in which a hinge slides against exact friction; 0: it does not
  std::vector<P> awaits_angle_; ///< 1: the hinge's hold waits for another hinge's angle, else 0
  std::array<std::vector<P>, edges_of_hinge> ways_; ///< 1: edge above the angle; −1: below
};

/// Locked hinges of the runs in the lanes: the moments on them at a step's ends, and whether friction may release a
/// stuck one inside the step.
///
/// The first test is SlipSearch::comes_near, by the same expressions: it excludes a release, and never finds one.
template <int W> class LaneLocks {
  using P = Pack<W>;
  using Mask = typename P::Mask;

public:
  void resize(const Layout& at) {
    const P none(0.0);
    for (std::vector<P>* v : {&before_, &at_end_, &excess_before_, &excess_at_end_})
      v->assign(at.bodies + 1, none);
    holds_ = none;
  }

  /// Sets the locked hinges of a lane. @param task null: the lane has no run
  void load(int lane, const LaneTask* task, Workspace<P>& work) {
    for (std::size_t i = 1; i < before_.size(); ++i) {
      const bool sticks = task && is_locked(task->work.contact[i]);
      work.locks[i].v[lane] = !sticks ? 0 : task->work.contact[i] == Contact::held ? 2 : 1;
      before_[i].v[lane] = sticks ? task->held_before[i] : 0;
      excess_before_[i].v[lane] = sticks ? task->excess_before[i] : 0;
    }
    work.locked += (task ? task->work.locked : 0) - locked_[lane];
    locked_[lane] = task ? task->work.locked : 0;
    holds_.v[lane] = locked_[lane] > 0 ? 1 : 0;
  }

  /// @param moved whether the lane's state is no longer that of the task
  void unload(int lane, LaneResult& result, bool moved) const {
    if (locked_[lane] == 0) return;
    get_lane(lane, at_end_, result.held_at_end);
    if (!moved) return;
    get_lane(lane, before_, result.held_before);
    get_lane(lane, excess_before_, result.excess_before);
  }

  /// The lanes in which any hinge is locked.
  [[nodiscard]] Mask lanes() const { return holds_ > P(0.0); }
  /// Moments on stuck hinges at the step's start, 1 … n, N·m.
  [[nodiscard]] const std::vector<P>& before() const { return before_; }

  /// Keeps the moments on stuck hinges at the step's end. @pre the system's last evaluation was there
  template <class AnySystem> void keep_at_end(const AnySystem& system, const Step<P>& step) {
    at_end_ = system.work().holding;
    for (int i = 1; i < static_cast<int>(before_.size()); ++i)
      if (any(system.is_locked(i))) excess_at_end_[i] = SlipSearch<P>::excess(system, step.x1, i);
  }

  /// @return lanes in which the friction of a stuck hinge may pass its limit. @pre as keep_at_end
  template <class AnySystem>
  [[nodiscard]] Mask may_release(const AnySystem& system, const Step<P>& step) {
    keep_at_end(system, step);
    Mask found{};
    if (!system.wing().can_stick) return found; // only holds lock hinges
    bound_.over_step(system, step);
    for (int i = 1; i < static_cast<int>(before_.size()); ++i) {
      const Mask locked = system.is_locked(i);
      const auto slips = [&] {
        const P limit = system.static_limit(step.x, i);
        return locked && may_slip(bound_, i, excess_before_[i], excess_at_end_[i],
                                  negligible_load(bound_, i, limit));
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
  HeldLoadBound<P> bound_;
  std::array<int, W> locked_{}; ///< number of locked hinges in each lane
  P holds_;                     ///< 1 in lanes with a locked hinge, else 0
};

} // namespace wingspread
