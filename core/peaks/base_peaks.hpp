/// Largest changes of a free base's angle and rate since the start of the run.
///
/// Its angle is coordinate 2 of the state (layout.hpp). Inside a step both are polynomials in Bernstein form, whose
/// coefficients bound them: halves of the step that cannot exceed the known maximum are dropped. A maximum inside a step
/// is in doubt until a step of the method that ends there confirms it.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/layout.hpp"
#include "core/peaks/maximum.hpp"

#include <optional>

namespace wingspread {

/// Raises `most` to the largest |p|, to within a relative 1e-12. @param first, last fractions of the step at p's ends
template <class T>
void raise_magnitude(Sampled<T>& most, const Quintic<T>& p, const T& first, const T& last,
                     int halvings = 40) {
  using std::abs;
  const T at_first = abs(p.front()), at_last = abs(p.back());
  if (at_first > most.value) most = {first, at_first};
  if (at_last > most.value) most = {last, at_last};
  if (halvings == 0 || !(bound(p) > most.value * T(1 + 1e-12))) return;
  Quintic<T> left, right;
  halve(p, left, right);
  const T middle = (first + last) / T(2);
  raise_magnitude(most, left, first, middle, halvings - 1);
  raise_magnitude(most, right, middle, last, halvings - 1);
}

template <class T> void raise_magnitude(T& most, const Quintic<T>& p) {
  Sampled<T> found{T(0), most};
  raise_magnitude(found, p, T(0), T(1));
  most = found.value;
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

  /// A maximum inside a step, known by the dense output alone.
  struct Doubt {
    bool of_rate;
    T s;    ///< fraction of the step
    T bend; ///< d²/dt² there, of the change since the start
    int corrections = 0;
  };

  /// Searches the step for a larger turn, or a larger change of the rate. Next to an end the dense output counts as exact.
  /// @return a maximum for `confirm`
  [[nodiscard]] std::optional<Doubt> doubtful(const Layout& at, const Step<T>& step, bool of_rate) {
    const Changes now = changes(at, step);
    const Quintic<T>& p = of_rate ? now.rate : now.angle;
    T& most = of_rate ? rate : angle;
    (void)raise_by_ends(most, p);
    Sampled<T> found{T(0), most};
    raise_magnitude(found, p, T(0), T(1));
    if (!(found.value > most)) return std::nullopt;
    if (found.s < T(next_to_an_end) || found.s > T(1 - next_to_an_end)) {
      most = found.value;
      return std::nullopt;
    }
    return Doubt{of_rate, found.s, value(derivative(derivative(p, step.h), step.h), found.s)};
  }

  /// Raises the maxima to the end of a step of the method to `doubt.s`, and corrects `doubt.s` by Newton's method.
  /// @param x, dxdt the state and its derivative there @param worth_a_step share of the maximum
  /// @return whether another step, to the new `doubt.s`, gains more than that; at most 4 corrections
  [[nodiscard]] bool confirm(Doubt& doubt, const Layout& at, const Step<T>& step, const State<T>& x,
                             const State<T>& dxdt, double worth_a_step) {
    using std::abs;
    const int r = coordinate + at.freedoms();
    const T turn = x[coordinate] - first_angle, turning = x[r] - first_rate;
    angle = larger(angle, T(abs(turn))), rate = larger(rate, T(abs(turning)));
    const T& change = doubt.of_rate ? turning : turn;
    const T late = (doubt.of_rate ? dxdt[r] : x[r]) / doubt.bend;
    const T gain = T(0.5) * late * late * abs(doubt.bend);
    doubt.s = doubt.s - late / step.h;
    return change * doubt.bend < T(0) && gain > T(worth_a_step) * abs(change) && doubt.s > T(0) &&
           doubt.s < T(1) && ++doubt.corrections < 4;
  }

  /// Raises the maxima to the step's ends.
  /// @return whether a maximum may lie inside the step, so that over_step must search; for a pack: in which lanes
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
