/// Answers in closed form, or by one quadrature, for scenes with real hinges.
///
/// | symbol | meaning                                   | unit          |
/// |--------|-------------------------------------------|---------------|
/// | I      | inertia of a panel about its hinge        | kg·m²         |
/// | ω_0, ω | rate at the start, and after a way        | rad/s         |
/// | way    | angle turned through                      | rad           |
#pragma once

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

namespace wingspread::oracle {

/// The root of f between a and b, to round-off.
template <class Function> [[nodiscard]] double root_between(double a, double b, const Function& f) {
  std::uintmax_t tries = 200;
  const boost::math::tools::eps_tolerance<double> enough(52);
  const auto bracket = boost::math::tools::toms748_solve(f, a, b, enough, tries);
  return std::midpoint(bracket.first, bracket.second);
}

/// Time and rate at which a hinge reaches an angle.
struct Arrival {
  double time, rate; ///< s, rad/s
};

// ---- dampers on one panel, nothing else

/// I ω̇ = −c ω.
[[nodiscard]] inline Arrival viscous_arrival(double inertia, double c, double start, double way) {
  const double rate = start - c * way / inertia;
  return {inertia / c * std::log(start / rate), rate};
}

/// I ω̇ = −A ω^p, p other than 1 and 2.
[[nodiscard]] inline Arrival power_law_arrival(double inertia, double A, double p, double start,
                                               double way) {
  const double a = A / inertia;
  const double rate = std::pow(std::pow(start, 2 - p) - (2 - p) * a * way, 1 / (2 - p));
  return {(std::pow(start, 1 - p) - std::pow(rate, 1 - p)) / ((1 - p) * a), rate};
}

/// I ω̇ = −2 T r/(1 + r²), r = ω/ω_p: (1 + r²) dr = −2 T/(I ω_p²) dφ, (1/r + r) dr = −2 T/(I ω_p) dt.
[[nodiscard]] inline Arrival eddy_current_arrival(double inertia, double torque, double peak_rate,
                                                  double start, double way) {
  const double first = start / peak_rate;
  const double gone = 2 * torque * way / (inertia * peak_rate * peak_rate);
  const double r = root_between(0, first, [&](double x) {
    return (first - x) * (1 + (first * first + first * x + x * x) / 3) - gone;
  });
  const double elapsed = std::log(first / r) + (first * first - r * r) / 2;
  return {inertia * peak_rate / (2 * torque) * elapsed, r * peak_rate};
}

/// I ω̇ = −B ω².
[[nodiscard]] inline Arrival drag_arrival(double inertia, double B, double start, double way) {
  const double growth = std::exp(B / inertia * way);
  return {(growth - 1) * inertia / (B * start), start / growth};
}

/// The time of a quasi-static motion along `way`. The torque T falls linearly from `first` to `last`, and the rate is
/// ω = T^n'/A'. Any consistent units.
[[nodiscard]] inline double quasi_static_time(double first, double last, double way, double A,
                                              double exponent) {
  const double slope = (first - last) / way, n = exponent - 1;
  return A / (n * slope) * (std::pow(last, -n) - std::pow(first, -n));
}

// ---- contacts

/// The rate, > 0, at which a body leaves a contact I δ̈ = −k δ (1 + c δ̇) that it hit with `speed`: u − ln(1 + u) with
/// u = c δ̇ has the same value when it leaves as when it hits.
[[nodiscard]] inline double hunt_crossley_rebound(double c, double speed) {
  const auto height = [](double u) { return u - std::log1p(u); };
  const double h = height(c * speed);
  // u − ln(1 + u) ≥ u²/2 for u < 0
  const double u = root_between(-std::min(std::sqrt(2 * h), 1 - 0x1p-40), 0,
                                [&](double x) { return height(x) - h; });
  return -u / c;
}

/// The largest depth δ of such a contact: ½ k δ² = I (u − ln(1 + u))/c².
[[nodiscard]] inline double hunt_crossley_depth(double inertia, double k, double c, double speed) {
  const double u = c * speed;
  return std::sqrt(2 * inertia * (u - std::log1p(u)) / k) / c;
}

/// The motion of a latch with backlash and without damping, at a time t after it engaged at `rate`. The hinge moves freely
/// between the edges of the backlash, and the spring k turns it back at each. @return angle from the latched one, and rate
struct Played {
  double angle, rate;
};
[[nodiscard]] inline Played backlash_motion(double inertia, double k, double backlash, double rate,
                                            double t) {
  const double w = std::sqrt(k / inertia), turn = std::numbers::pi / w;
  const double fly = backlash / rate, half = backlash / 2;
  double s = std::fmod(t, 2 * (fly + turn)) + fly / 2; // from the lower edge, upwards
  double sense = 1;
  if (s >= 2 * (fly + turn)) s -= 2 * (fly + turn);
  if (s >= fly + turn) s -= fly + turn, sense = -1; // the second half mirrors the first
  if (s <= fly) return {sense * (rate * s - half), sense * rate};
  const double c = std::cos(w * (s - fly));
  return {sense * (half + rate / w * std::sin(w * (s - fly))), sense * rate * c};
}

// ---- ground tests

/// The time and rate at which a pendulum, I φ̈ = −m g d sin φ, released at `amplitude`, first passes its lowest point.
[[nodiscard]] inline Arrival pendulum_arrival(double inertia, double weight_arm, double amplitude) {
  const double w = std::sqrt(weight_arm / inertia), k = std::sin(amplitude / 2);
  return {boost::math::ellint_1(k) / w, 2 * w * k};
}

// ---- equal panels with rigid synchronisation loops

/// The motion of EqualPanels (real_scenes.hpp) in the root's angle φ, from 0 to π/2.
struct RigidPanels {
  int panels;
  double mass, length;

  /// I(φ) of all panels for the root's rate, kg·m².
  [[nodiscard]] double inertia(double phi) const {
    const double n = panels, c = std::cos(phi), s = std::sin(phi);
    return mass * length * length * (n / 12 + n * (4 * n * n - 1) / 12 * c * c + n / 4 * s * s);
  }
  /// The work of the springs, J.
  [[nodiscard]] double work(double phi) const {
    const double x = 2 * phi;
    return 0.1 * (std::numbers::pi * phi - phi * phi / 2) +
           (panels - 1) * 0.05 * (1.5 * std::numbers::pi * x - x * x / 2);
  }
  [[nodiscard]] Arrival latch() const {
    const double end = std::numbers::pi / 2;
    // dt = √(I/(2 W)) dφ, and W ~ φ at first: over u = √φ it is smooth
    const auto slowness = [&](double u) {
      return 2 * u * std::sqrt(inertia(u * u) / (2 * work(u * u)));
    };
    using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
    return {Rule::integrate(slowness, 0.0, std::sqrt(end), 15, 1e-14),
            std::sqrt(2 * work(end) / inertia(end))};
  }
};

} // namespace wingspread::oracle
