/// How far a free base turns, and how fast, from where it was at the start.
///
/// Its angle is coordinate 2 of the state (layout.hpp). Inside a step both are polynomials in Bernstein form, whose
/// coefficients bound them: halves in which they cannot exceed what is known are dropped.
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
template <class T> class BaseExcursion {
public:
  static constexpr int coordinate = 2;

  void start(const Layout& at, const State<T>& x) {
    angle_ = rate_ = T(0);
    if (at.base == 0) return;
    first_angle_ = x[coordinate];
    first_rate_ = x[coordinate + at.freedoms()];
  }

  void over_step(const Layout& at, const Step<T>& step) {
    if (at.base == 0) return;
    Quintic<T> angle = step.coordinate(coordinate, at.freedoms());
    Quintic<T> rate = derivative(angle, step.h);
    for (T& c : angle) c = c - first_angle_;
    for (T& c : rate) c = c - first_rate_;
    raise_magnitude(angle_, angle);
    raise_magnitude(rate_, rate);
  }

  [[nodiscard]] const T& angle() const { return angle_; }
  [[nodiscard]] const T& rate() const { return rate_; }

private:
  T angle_{}, rate_{}, first_angle_{}, first_rate_{};
};

} // namespace wingspread
