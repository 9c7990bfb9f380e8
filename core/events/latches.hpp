/// Where latches engage: the instant at which a hinge reaches its latched angle in the deploying sense. From then on
/// the latch is a spring and a damper. A latch that may miss, or let go again: core/laws/latch_laws.hpp.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/edge_crossing.hpp"
#include "core/events/instant.hpp"
#include "core/mechanics/system.hpp"
#include "core/outcome.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace wingspread {

/// The engagement of hinge i at (x, t), in the scene's order of hinges.
template <class T>
[[nodiscard]] LatchEvent latch_event(const Wing<T>& wing, const Layout& at, const State<T>& x,
                                     const T& t, int i) {
  LatchEvent event{wing.hinge_of[i], static_cast<double>(t), std::vector<double>(at.bodies)};
  for (int j = 1; j <= at.bodies; ++j)
    event.rates[wing.hinge_of[j]] = static_cast<double>(x[at.rate(j)]);
  return event;
}

/// The events of latches and holds so far, each list in order of time.
struct LatchRecord {
  std::vector<LatchEvent>& latches; ///< engagements
  std::vector<HingeEvent>&missed, &let_go, &releases;
};

/// An event of hinge i at (x, t).
template <class T>
[[nodiscard]] HingeEvent hinge_event(const Wing<T>& wing, const Layout& at, const State<T>& x,
                                     const T& t, int i) {
  return {wing.hinge_of[i], static_cast<double>(t), static_cast<double>(x[at.rate(i)])};
}

/// Whether a latch engages at t or at an instant simultaneous with t.
/// @param gap, rate signed distance past the latched angle, rad, and its rate, rad/s
template <class T> [[nodiscard]] auto engages_at(const T& t, const T& gap, const T& rate) {
  return gap + one_instant_of_latches(t) * larger(rate, T(0)) >= T(0);
}

/// The first s in [0, 1] at which the engaged latch of hinge i lets go in the step; none if it does not. Halves pieces
/// whose bound on the latch's load does not exclude it.
template <class T, class AnySystem>
[[nodiscard]] std::optional<T> first_letting_go(const AnySystem& system, const Step<T>& step,
                                                int i) {
  struct Piece {
    Quintic<T> angle, rate;
    T lower, width;
  };
  const CaptureTerms<T>& latch = system.wing().real[i].capture;
  const Layout& at = system.layout();
  const Quintic<T> path = step.coordinate(at.angle(i), at.freedoms());
  constexpr int deepest = 45; // 3e-14 of the step: rounding
  std::array<Piece, deepest + 2> open;
  int count = 0;
  open[count++] = {path, step.rate(at.angle(i), at.freedoms()), T(0), T(1)};
  while (count > 0) {
    const Piece piece = open[--count];
    if (latch.most_excess(hull(piece.angle), hull(piece.rate)) < T(0)) continue;
    if (latch.lets_go(piece.angle[0], piece.rate[0])) return piece.lower;
    if (piece.width <= T(1.0 / (1LL << deepest))) {
      if (latch.lets_go(piece.angle[5], piece.rate[5])) return piece.lower + piece.width;
      continue;
    }
    Piece left{{}, {}, piece.lower, T(0.5) * piece.width};
    Piece right{{}, {}, piece.lower + left.width, left.width};
    halve(piece.angle, left.angle, right.angle), halve(piece.rate, left.rate, right.rate);
    open[count++] = right;
    open[count++] = left;
  }
  return std::nullopt;
}

/// The latches of one run that are not engaged.
template <class T, class AnySystem> class Latches {
public:
  explicit Latches(AnySystem& system) : system_(system), at_(system.layout()) {}

  /// Counts the latches at the start of a run.
  void start() {
    left_ = 0;
    for (int i = 1; i <= at_.bodies; ++i) left_ += system_.wing().hinges[i].has_latch;
  }

  [[nodiscard]] int left() const { return left_; }
  /// Whether hinge i has a latch that engages the next time that the hinge reaches its latched angle; a locked hinge
  /// does not move.
  [[nodiscard]] bool may_engage(int i) const { return is_open(i) && !may_miss(i); }
  /// Whether hinge i has an engaged latch that may let go now.
  [[nodiscard]] bool may_let_go(int i) const {
    return system_.wing().can_let_go && system_.work().engaged[i] && !system_.is_locked(i) &&
           system_.wing().real[i].capture.may_let_go();
  }

  /// Signed distance past the latched angle, rad: the latch engages where it reaches 0 from below.
  [[nodiscard]] T gap(const State<T>& x, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    return hinge.sense * (x[at_.angle(i)] - hinge.latched);
  }
  [[nodiscard]] T gap_rate(const State<T>& x, int i) const {
    return system_.wing().hinges[i].sense * x[at_.rate(i)];
  }

  /// The first s in [0, 1] at which hinge i reaches its latched angle in the step; none without one.
  [[nodiscard]] std::optional<T> first_engagement(const Step<T>& step, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    Quintic<T> past = step.distance(at_.angle(i), at_.freedoms(), hinge.latched);
    for (T& c : past) c = hinge.sense * c;
    return first_nonnegative(past);
  }

  /// Engages, at the start of a step, hinge `due` (0: none) and every latch that engages simultaneously.
  /// @param events to whose latches the engagements are appended; passes too fast for the latch are missed
  /// @return whether any latch engaged
  bool engage_simultaneous(int due, Step<T>& step, LatchRecord& events) {
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!is_open(i)) continue;
      if (may_miss(i) && !captures(i, due, step, events)) continue;
      if (!may_miss(i) && i != due && !engages_at(step.t, gap(step.x, i), gap_rate(step.x, i)))
        continue;
      system_.engage(i);
      // exactly at the edge, where settle_edges decides its side
      if (has_edge_at_latch(system_.wing(), i))
        step.x[at_.angle(i)] = system_.wing().hinges[i].latched;
      --left_;
      events.latches.push_back(latch_event(system_.wing(), at_, step.x, step.t, i));
      any = true;
    }
    return any;
  }

  /// Lets go, at the start of a step, the latch of hinge `due` (0: none), every latch that lets go simultaneously with it,
  /// and every latch that is loaded beyond its holding moment where it begins to bear on its stowed side.
  /// @return whether any let go
  bool disengage_simultaneous(int due, Step<T>& step, LatchRecord& events) {
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!may_let_go(i)) continue;
      const bool with_it = due != 0 && lets_go_now(i, step);
      if (i != due && !with_it && !lets_go_at_edge(i, step.x)) continue;
      // the step to the event may have ended on the other side, within its tolerance
      if (gap(step.x, i) > T(0)) step.x[at_.angle(i)] = system_.wing().hinges[i].latched;
      system_.disengage(i);
      ++left_;
      events.let_go.push_back(hinge_event(system_.wing(), at_, step.x, step.t, i));
      any = true;
    }
    return any;
  }

private:
  [[nodiscard]] bool is_open(int i) const {
    return system_.wing().hinges[i].has_latch && !system_.work().engaged[i] &&
           !system_.is_locked(i);
  }
  [[nodiscard]] bool may_miss(int i) const { return has_capture(system_.wing(), i); }

  /// Whether hinge i, whose latch may miss, passes its latched angle now, and slowly enough. If it passes, it is put
  /// there exactly: settle_edges decides its side.
  [[nodiscard]] bool captures(int i, int due, Step<T>& step, LatchRecord& events) const {
    using std::abs;
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    const T way(way_over(system_, i, Edge::pass));
    const T &rate = step.x[at_.rate(i)], along = way * rate;
    T& angle = step.x[at_.angle(i)];
    const bool there = along > T(0) && engages_at(step.t, T(way * (angle - hinge.latched)), along);
    if (i != due && !there) return false;
    angle = hinge.latched;
    if (abs(rate) <= system_.wing().real[i].capture.fastest) return true;
    events.missed.push_back(hinge_event(system_.wing(), at_, step.x, step.t, i));
    return false;
  }

  /// Whether the latch of hinge i lets go under its load, where it begins to bear on its stowed side.
  [[nodiscard]] bool lets_go_at_edge(int i, const State<T>& x) const {
    const CaptureTerms<T>& latch = system_.wing().real[i].capture;
    const T &angle = x[at_.angle(i)], &rate = x[at_.rate(i)];
    return !(latch.deflection(angle) > T(0)) && latch.sense * rate < T(0) &&
           latch.excess(angle, rate) >= T(0);
  }

  /// Whether the latch of hinge i lets go within one instant: it bears on its stowed side and its load reaches the
  /// holding moment.
  [[nodiscard]] bool lets_go_now(int i, const Step<T>& step) const {
    const CaptureTerms<T>& latch = system_.wing().real[i].capture;
    const T &angle = step.x[at_.angle(i)], &rate = step.x[at_.rate(i)],
            &acceleration = step.dxdt[at_.rate(i)];
    return engages_at(step.t, T(-latch.deflection(angle)), T(-(latch.sense * rate))) &&
           engages_at(step.t, latch.excess(angle, rate),
                      latch.excess_rate(angle, rate, acceleration));
  }

  AnySystem& system_;
  const Layout at_;
  int left_ = 0;
};

} // namespace wingspread
