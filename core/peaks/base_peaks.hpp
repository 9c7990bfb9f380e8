/// Largest changes of a free base's angle and rate since the start of the run.
///
/// Its angle is coordinate 2 of the state (layout.hpp). Inside a step both are polynomials in Bernstein form, whose
/// coefficients bound them: halves of the step that cannot exceed the known maximum are dropped.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/layout.hpp"

namespace wingspread {

/// Raises `most` to the largest |p(s)|, s in [0, 1], to within a relative 1e-12.
template <class T> void raise_magnitude(T& most, const Quintic<T>& p, int halvings = 40) {
  using std::abs;
  most = larger(most, larger(T(abs(p.front())), T(abs(p.back()))));
  if (halvings == 0 || !(bound(p) > most * T(1 + 1e-12))) return;
  Quintic<T> left, right;
  halve(p, left, right);
  raise_magnitude(most, left, halvings - 1);
  raise_magnitude(most, right, halvings - 1);
}

/// The largest changes of a free base's angle and rate since the start.
template <class T> struct BaseExcursion {
  static constexpr int coordinate = 2;

  T angle{}, rate{};             ///< the largest so far, rad and rad/s
  T first_angle{}, first_rate{}; ///< at the start

  void start(const Layout& at, const State<T>& x) {
    angle = rate = T(0);
    if (at.base == 0) return;
    first_angle = x[coordinate];
    first_rate = x[coordinate + at.freedoms()];
  }

  void over_step(const Layout& at, const Step<T>& step) {
    if (at.base == 0) return;
    const auto [turn, turning] = changes(at, step);
    raise_magnitude(angle, turn);
    raise_magnitude(rate, turning);
  }

  /// Raises the maxima to the step's ends, for runs in packs.
  /// @return the lanes in which the maximum may lie inside the step, so that over_step must search
  [[nodiscard]] auto raise_by_ends(const Layout& at, const Step<T>& step) {
    const auto [turn, turning] = changes(at, step);
    const auto doubtful = raise_by_ends(angle, turn);
    return doubtful || raise_by_ends(rate, turning);
  }

private:
  struct Changes {
    Quintic<T> angle, rate;
  };
  /// Since the start.
  [[nodiscard]] Changes changes(const Layout& at, const Step<T>& step) const {
    Changes now;
    now.angle = step.coordinate(coordinate, at.freedoms());
    now.rate = step.rate(coordinate, at.freedoms());
    for (T& c : now.angle) c = c - first_angle;
    for (T& c : now.rate) c = c - first_rate;
    return now;
  }

  [[nodiscard]] static auto raise_by_ends(T& most, const Quintic<T>& p) {
    using std::abs;
    most = larger(most, larger(T(abs(p.front())), T(abs(p.back()))));
    return !(bound(p) <= T(most * T(1 + 1e-12)));
  }
};

} // namespace wingspread
