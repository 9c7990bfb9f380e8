/// Where latches engage: the instant at which a hinge reaches its latched angle in the deploying sense. From then on
/// the latch is a spring and a damper.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/instant.hpp"
#include "core/mechanics/system.hpp"
#include "core/outcome.hpp"

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

/// Whether a latch engages at t or at an instant simultaneous with t.
/// @param gap, rate signed distance past the latched angle, rad, and its rate, rad/s
template <class T> [[nodiscard]] auto engages_at(const T& t, const T& gap, const T& rate) {
  return gap + one_instant(t) * larger(rate, T(0)) >= T(0);
}

/// The latches of one run that have not engaged.
template <class T, class AnySystem> class Latches {
public:
  explicit Latches(AnySystem& system) : system_(system), at_(system.layout()) {}

  /// Counts the latches at the start of a run.
  void start() {
    left_ = 0;
    for (int i = 1; i <= at_.bodies; ++i) left_ += system_.wing().hinges[i].has_latch;
  }

  [[nodiscard]] int left() const { return left_; }
  /// Whether hinge i has a latch that can still engage; a stuck hinge does not move.
  [[nodiscard]] bool may_engage(int i) const {
    return system_.wing().hinges[i].has_latch && !system_.work().engaged[i] && !system_.sticks(i);
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
    Quintic<T> angle = step.coordinate(at_.angle(i), at_.freedoms());
    for (T& c : angle) c = hinge.sense * (c - hinge.latched);
    return first_nonnegative(angle);
  }

  /// Engages, at the start of a step, hinge `due` (0: none) and every latch that engages simultaneously.
  /// @param latches to which the engagements are appended
  /// @return whether any latch engaged
  bool engage_those_there(int due, Step<T>& step, std::vector<LatchEvent>& latches) {
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!may_engage(i)) continue;
      if (i != due && !engages_at(step.t, gap(step.x, i), gap_rate(step.x, i))) continue;
      system_.engage(i);
      // exactly at the edge, where settle_edges decides its side
      if (has_edge_at_latch(system_.wing(), i))
        step.x[at_.angle(i)] = system_.wing().hinges[i].latched;
      --left_;
      latches.push_back(latch_event(system_.wing(), at_, step.x, step.t, i));
      any = true;
    }
    return any;
  }

private:
  AnySystem& system_;
  const Layout at_;
  int left_ = 0;
};

} // namespace wingspread
