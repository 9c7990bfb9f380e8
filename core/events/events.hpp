/// What interrupts a run at an instant of its own: latches that engage, hinges that come to rest or
/// are let go.
#pragma once

#include "core/events/contact.hpp"
#include "core/outcome.hpp"

#include <optional>
#include <vector>

namespace wingspread {

enum class Event { latch, rest, release };

/// An event inside a step.
template <class T> struct Due {
  Event event;
  int hinge;
  T s;     ///< fraction of the step
  T slope; ///< of a release's indicator, N·m/s
};

/// Body i's latch as it engages at (x, t), told in the scene's own order.
template <class T>
[[nodiscard]] LatchEvent latch_event(const Wing<T>& wing, const Layout& at, const State<T>& x,
                                     const T& t, int i) {
  LatchEvent event{wing.hinge_of[i], static_cast<double>(t), std::vector<double>(at.bodies)};
  for (int j = 1; j <= at.bodies; ++j)
    event.rates[wing.hinge_of[j]] = static_cast<double>(x[at.rate(j)]);
  return event;
}

/// Finds the events of one run, and brings them about.
template <class T, class AnySystem> class Events {
public:
  explicit Events(AnySystem& system) : system_(system), at_(system.layout()) {}

  /// A run begins.
  void start() {
    latches_left_ = 0;
    for (int i = 1; i <= at_.bodies; ++i) latches_left_ += system_.wing().hinges[i].has_latch;
  }

  /// Latches that have not engaged.
  [[nodiscard]] int latches_left() const { return latches_left_; }

  /// The last evaluation was at x, where the next step starts.
  void observe(const State<T>& x) {
    if (system_.work().stuck > 0) holding_.observe(system_, x);
  }

  /// The earliest one in the step, by the interpolant, whose word on whether it happens is final.
  /// x and dxdt are overwritten.
  [[nodiscard]] std::optional<Due<T>> first(const Step<T>& step, State<T>& x,
                                            State<T>& dxdt) const {
    std::optional<Due<T>> first;
    const auto offer = [&](Event event, int i, const std::optional<T>& s, const T& slope) {
      if (s && (!first || *s < first->s)) first = Due<T>{event, i, *s, slope};
    };
    for (int i = 1; i <= at_.bodies; ++i) {
      if (waits(i) && !system_.sticks(i)) offer(Event::latch, i, first_engagement(step, i), T(0));
      if (sliding_sense(system_, i) != 0) offer(Event::rest, i, first_rest(system_, step, i), T(0));
    }
    if (system_.work().stuck > 0) {
      const auto release = holding_.first_release(system_, step, x, dxdt);
      if (release) offer(Event::release, release->hinge, release->s, release->slope);
    }
    return first;
  }

  /// What reaches 0 from below at the event, and its rate, at the end of a step just made.
  struct Indicator {
    T value, slope;
  };
  [[nodiscard]] Indicator indicator(const Due<T>& due, const Step<T>& step) const {
    const int i = due.hinge;
    switch (due.event) {
    case Event::latch:
      return {gap(step.x1, i), gap_rate(step.x1, i)};
    case Event::rest: {
      const T against(-sliding_sense(system_, i));
      return {against * step.x1[at_.rate(i)], against * step.dxdt1[at_.rate(i)]};
    }
    case Event::release:
      break;
    }
    return {Holding<T>::excess(system_, step.x1, i), due.slope};
  }

  /// At the start of a step: what the event that was due, and others at the same instant, bring
  /// about. A hinge that comes to rest has its rate set to zero.
  /// @param latches those that engage are added
  /// @return whether anything happened; then the right-hand side is another
  [[nodiscard]] bool happen(const std::optional<Due<T>>& due, Step<T>& step,
                            std::vector<LatchEvent>& latches) {
    const int latching = due && due->event == Event::latch ? due->hinge : 0;
    const int resting = due && due->event == Event::rest ? due->hinge : 0;
    const bool engaged = engage_those_there(latching, step, latches);
    const bool rested = rest_those_there(resting, step);
    return due || engaged || rested;
  }

private:
  /// Signed distance past the latched angle; engagement is where it reaches 0 from below.
  [[nodiscard]] T gap(const State<T>& x, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    return hinge.sense * (x[at_.angle(i)] - hinge.latched);
  }
  [[nodiscard]] T gap_rate(const State<T>& x, int i) const {
    return system_.wing().hinges[i].sense * x[at_.rate(i)];
  }
  [[nodiscard]] bool waits(int i) const {
    return system_.wing().hinges[i].has_latch && !system_.work().engaged[i];
  }

  [[nodiscard]] std::optional<T> first_engagement(const Step<T>& step, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    Quintic<T> angle = step.coordinate(at_.angle(i), at_.freedoms());
    for (T& c : angle) c = hinge.sense * (c - hinge.latched);
    return first_nonnegative(angle);
  }

  /// How far apart two instants may be and still be one.
  [[nodiscard]] static T one_instant(const T& t) { return T(4096 * epsilon_of<T>) * t; }

  /// Engages the hinge that was due (0: none), and with it every waiting one that stands at its
  /// latched angle, all at this one instant.
  bool engage_those_there(int due, const Step<T>& step, std::vector<LatchEvent>& latches) {
    const T instant = one_instant(step.t);
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!waits(i) || system_.sticks(i)) continue;
      const T soon = gap(step.x, i) + instant * larger(gap_rate(step.x, i), T(0));
      if (i != due && !(soon >= T(0))) continue;
      system_.engage(i);
      --latches_left_;
      latches.push_back(latch_event(system_.wing(), at_, step.x, step.t, i));
      any = true;
    }
    return any;
  }

  /// The same for hinges that slide, and come to rest.
  bool rest_those_there(int due, Step<T>& step) {
    const T instant = one_instant(step.t);
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      const T against(-sliding_sense(system_, i));
      if (against == T(0)) continue;
      const T rate = against * step.x[at_.rate(i)], slope = against * step.dxdt[at_.rate(i)];
      const bool there = rate > T(0) || (slope > T(0) && rate + instant * slope >= T(0));
      if (i != due && !there) continue;
      step.x[at_.rate(i)] = T(0);
      any = true;
    }
    return any;
  }

  AnySystem& system_;
  const Layout at_;
  Holding<T> holding_;
  int latches_left_ = 0;
};

} // namespace wingspread
