/// The events of a run: latches that engage or let go, hinges that come to rest or are released, angles at which laws
/// change, holds that let go.
#pragma once

#include "core/events/contact.hpp"
#include "core/events/edge_crossing.hpp"
#include "core/events/kink_search.hpp"
#include "core/events/latches.hpp"
#include "core/events/releases.hpp"
#include "core/events/slipping.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// `latch`: a latch engages. `rest`: a sliding hinge stops. `release`: friction releases a stuck hinge. `graze`: the
/// load of a stuck hinge comes so near its limit that only a step of the method can decide. `edge`: a real hinge
/// reaches an angle at which its law changes. `kink`: a law bends or jumps (kinks.hpp), and the equations stay as they
/// are. `let_go`: an engaged latch lets go. `seen`: another hinge reaches the angle for which a hold waits.
enum class Event { latch, rest, release, graze, edge, kink, let_go, seen };

/// An event inside a step.
template <class T> struct Due {
  Event event;
  int hinge;
  T s;                    ///< fraction of the step
  T slope;                ///< rate of a release's indicator, N·m/s
  Edge edge = Edge::stop; ///< of an edge
  Kink<T> kink{};         ///< of a kink
};

/// Which events are searched in a step.
struct EventSearch {
  std::optional<KinkLimit> kinks{}; ///< which kinks are events too; none: none is
  bool releases = true;             ///< whether a stuck hinge may let go
  const std::vector<char>* hinges =
      nullptr; ///< 1 … n: whether it may have another event; null: any may
};

/// Finds the events of one run and applies them.
template <class T, class AnySystem> class Events {
public:
  explicit Events(AnySystem& system) : system_(system), latches_(system), releases_(system) {}

  /// Starts a run.
  void start() {
    latches_.start();
    releases_.start();
  }

  /// Latches that are not engaged.
  [[nodiscard]] int latches_left() const { return latches_.left(); }
  [[nodiscard]] const Releases<T, AnySystem>& releases() const { return releases_; }

  /// Whether hinge i can still latch.
  [[nodiscard]] bool may_latch(int i) const { return latches_.may_engage(i); }

  /// Starts a step in which hinges stick. @pre the last evaluation was at x, the step's start
  void begin_step(const State<T>& x) { holding_.begin_step(system_, x); }

  /// Excess of the friction of stuck hinges over its limit at the step's start, 1 … n, N·m.
  [[nodiscard]] std::vector<T>& excess_before() { return holding_.before(); }

  /// The earliest event in the step. The interpolant decides whether an event happens. Overwrites x and dxdt.
  [[nodiscard]] std::optional<Due<T>> first(const Step<T>& step, State<T>& x, State<T>& dxdt,
                                            const EventSearch& search = {}) {
    std::optional<Due<T>> first;
    if (search.kinks && (system_.wing().is_real() || system_.layout().smoothed))
      if (const auto found = KinkSearch<T, AnySystem>(system_, step, *search.kinks).first())
        first = Due<T>{Event::kink, 0, found->s, T(0), Edge::stop, found->kink};
    const auto offer = [&](Event event, int i, const std::optional<T>& s, const T& slope) {
      if (s && (!first || *s < first->s)) first = Due<T>{event, i, *s, slope};
    };
    const auto may_happen = [&](int i) { return !search.hinges || (*search.hinges)[i] != 0; };
    for_each_edge(system_, [&](int i, Edge edge) {
      if (system_.is_locked(i) || !may_happen(i)) return;
      const std::optional<T> s = first_crossing(system_, step, i, edge);
      if (s && (!first || *s < first->s)) first = Due<T>{Event::edge, i, *s, T(0), edge};
    });
    for (int i = 1; i <= system_.layout().bodies; ++i) {
      if (!may_happen(i)) continue;
      if (latches_.may_engage(i)) offer(Event::latch, i, latches_.first_engagement(step, i), T(0));
      if (sliding_sense(system_, i) != 0) offer(Event::rest, i, first_rest(system_, step, i), T(0));
      if (latches_.may_let_go(i)) offer(Event::let_go, i, first_letting_go(system_, step, i), T(0));
      if (releases_.held() > 0) offer(Event::seen, i, releases_.first_passage(step, i), T(0));
    }
    if (search.releases && system_.work().locked > 0) {
      const auto release = holding_.first_release(system_, step, x, dxdt);
      if (release)
        offer(release->graze ? Event::graze : Event::release, release->hinge, release->s,
              release->slope);
    }
    return first;
  }

  /// The jump of a loop's moment in a refused step, if it is the first kink of a loop, motor or smoothed latch that
  /// matters there.
  [[nodiscard]] std::optional<Due<T>> first_jump(const Step<T>& step, KinkLimit limit) const {
    limit.refused = true;
    const auto found = KinkSearch<T, AnySystem>(system_, step, limit).first();
    if (!found || found->kink.of != Kink<T>::Of::strands) return std::nullopt;
    return Due<T>{Event::kink, 0, found->s, T(0), Edge::stop, found->kink};
  }

  /// A function of the state that reaches 0 from below at the event, and its derivatives by time at the step's end.
  struct Indicator {
    T value, slope;
    T bend = T(0); ///< rate of the slope; 0 where unknown
  };
  [[nodiscard]] Indicator indicator(const Due<T>& due, const Step<T>& step) const {
    const int i = due.hinge;
    switch (due.event) {
    case Event::latch:
      return {latches_.gap(step.x1, i), latches_.gap_rate(step.x1, i),
              latches_.gap_rate(step.dxdt1, i)};
    case Event::rest: {
      const int r = system_.layout().rate(i);
      const T against(-sliding_sense(system_, i));
      return {against * step.x1[r], against * step.dxdt1[r]};
    }
    case Event::edge: {
      const T way(way_over(system_, i, due.edge));
      const T angle = edge_angle(system_.wing(), i, due.edge);
      const Layout& at = system_.layout();
      return {way * (step.x1[at.angle(i)] - angle), way * step.x1[at.rate(i)],
              way * step.dxdt1[at.rate(i)]};
    }
    case Event::let_go:
      return indicator_of_letting_go(step, i);
    case Event::seen: {
      const int k = releases_.seen_by(i), r = system_.layout().rate(k);
      const T& sense = system_.wing().hinges[k].sense;
      return {releases_.passed_by(step.x1, i), sense * step.x1[r], sense * step.dxdt1[r]};
    }
    case Event::kink: {
      // just past it, so that the next step begins on the other side; of strands, before it: see cross()
      const Jet<T> u = argument(system_, due.kink, step.x1, step.dxdt1, T(step.t + step.h));
      const T beyond = beyond_rounding(system_, due.kink, step.x1);
      const bool before = due.kink.of == Kink<T>::Of::strands;
      return {due.kink.way * (u.value - due.kink.at) + (before ? beyond : T(-beyond)),
              due.kink.way * u.first, due.kink.way * u.second};
    }
    case Event::release:
    case Event::graze:
      break;
    }
    return {SlipSearch<T>::excess(system_, step.x1, i), due.slope};
  }

  /// Applies, at the start of a step, the event `due` and all simultaneous ones: engages latches and lets them go, sets
  /// the rates of hinges that come to rest to zero, and lets holds go.
  /// @param record to which the events are appended
  /// @return whether the right-hand side has changed
  [[nodiscard]] bool apply(const std::optional<Due<T>>& due, Step<T>& step, LatchRecord record) {
    const auto hinge_of = [&](Event event) { return due && due->event == event ? due->hinge : 0; };
    const bool passes = due && due->event == Event::edge && due->edge == Edge::pass;
    const int latching = passes ? due->hinge : hinge_of(Event::latch);
    const int resting = hinge_of(Event::rest);
    const std::size_t missed_before = record.missed.size();
    const bool engaged = latches_.engage_simultaneous(latching, step, record);
    const bool missed = record.missed.size() > missed_before; // settle_edges decides the new side
    const bool rested = stop_simultaneous(system_, resting, step);
    if (due && due->event == Event::edge)
      meet_edges_simultaneous(system_, due->hinge, due->edge, step);
    const bool let_go = system_.wing().can_let_go &&
                        latches_.disengage_simultaneous(hinge_of(Event::let_go), step, record);
    const bool released = releases_.release_due(hinge_of(Event::seen), step, record);
    const bool changes = due && due->event != Event::graze && due->event != Event::kink;
    return changes || engaged || missed || rested || let_go || released;
  }

private:
  /// A latch lets go where it bears on its stowed side and its load reaches the holding moment: the later of both. With
  /// a damper the load may have reached it before.
  [[nodiscard]] Indicator indicator_of_letting_go(const Step<T>& step, int i) const {
    const Layout& at = system_.layout();
    const CaptureTerms<T>& latch = system_.wing().real[i].capture;
    const T &angle = step.x1[at.angle(i)], &rate = step.x1[at.rate(i)],
            &acceleration = step.dxdt1[at.rate(i)];
    const Indicator side{-latch.deflection(angle), -(latch.sense * rate),
                         -(latch.sense * acceleration)};
    const Indicator load{latch.excess(angle, rate), latch.excess_rate(angle, rate, acceleration)};
    const bool side_is_later =
        side.slope > T(0) &&
        (!(load.slope > T(0)) || -side.value * load.slope > -load.value * side.slope);
    return side_is_later ? side : load;
  }

  AnySystem& system_;
  Latches<T, AnySystem> latches_;
  Releases<T, AnySystem> releases_;
  SlipSearch<T> holding_;
};

} // namespace wingspread
