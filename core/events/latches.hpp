/// Where latches engage: a hinge passes its latched angle in the deploying sense,
/// and its latch is a spring and a damper from then on.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/instant.hpp"
#include "core/mechanics/system.hpp"
#include "core/outcome.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// Body i's latch as it engages at (x, t), told in the scene's own order.
template <class T>
[[nodiscard]] LatchEvent latch_event(const Wing<T>& wing, const Layout& at, const State<T>& x,
                                     const T& t, int i) {
  LatchEvent event{wing.hinge_of[i], static_cast<double>(t), std::vector<double>(at.bodies)};
  for (int j = 1; j <= at.bodies; ++j)
    event.rates[wing.hinge_of[j]] = static_cast<double>(x[at.rate(j)]);
  return event;
}

/// Whether a waiting latch engages at t, or does at the same instant.
/// @param gap, rate its signed distance past the latched angle, rad; that distance's rate, rad/s
template <class T> [[nodiscard]] auto engages_at(const T& t, const T& gap, const T& rate) {
  return gap + one_instant(t) * larger(rate, T(0)) >= T(0);
}

/// The latches of one run that have not engaged yet.
template <class T, class AnySystem> class Latches {
public:
  explicit Latches(AnySystem& system) : system_(system), at_(system.layout()) {}

  /// A run begins.
  void start() {
    left_ = 0;
    for (int i = 1; i <= at_.bodies; ++i) left_ += system_.wing().hinges[i].has_latch;
  }

  [[nodiscard]] int left() const { return left_; }
  /// Whether hinge i may engage: one that sticks cannot, as it does not move.
  [[nodiscard]] bool may_engage(int i) const {
    return system_.wing().hinges[i].has_latch && !system_.work().engaged[i] && !system_.sticks(i);
  }

  /// Signed distance past the latched angle; engagement is where it reaches 0 from below.
  [[nodiscard]] T gap(const State<T>& x, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    return hinge.sense * (x[at_.angle(i)] - hinge.latched);
  }
  [[nodiscard]] T gap_rate(const State<T>& x, int i) const {
    return system_.wing().hinges[i].sense * x[at_.rate(i)];
  }

  /// The first s in [0, 1] at which hinge i reaches its latched angle in the step; none if it does
  /// not.
  [[nodiscard]] std::optional<T> first_engagement(const Step<T>& step, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    Quintic<T> angle = step.coordinate(at_.angle(i), at_.freedoms());
    for (T& c : angle) c = hinge.sense * (c - hinge.latched);
    return first_nonnegative(angle);
  }

  /// At the start of a step: engages the hinge that was due (0: none), and with it every waiting
  /// one that stands at its latched angle, all at this one instant.
  /// @param latches those that engage are added
  /// @return whether there was any
  bool engage_those_there(int due, const Step<T>& step, std::vector<LatchEvent>& latches) {
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!may_engage(i)) continue;
      if (i != due && !engages_at(step.t, gap(step.x, i), gap_rate(step.x, i))) continue;
      system_.engage(i);
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
