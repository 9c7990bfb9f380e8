/// The laws of real hinges, written for the oracle alone. Tables use Hermite's basis and Gauss quadrature. Every moment is
/// a function of the present angles and rates, without memory. So an integrator meets the kinks (a stop, a strand that
/// goes slack) and the jumps (the edges of a backlash or of a window) themselves.
///
/// | symbol | meaning                                              | unit       |
/// |--------|------------------------------------------------------|------------|
/// | x, v   | travel s (φ − φ_stowed) of a hinge, and its rate     | rad, rad/s |
/// | y      | φ − φ_latched                                        | rad        |
/// | e      | elongation of a loop, g(x_a) − x_b                   | rad        |
#pragma once

#include "core/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace wingspread::oracle {

/// ∫ f over [from, to]: three points of Gauss & Legendre, exact to the fifth power.
template <class Scalar, class Function>
[[nodiscard]] Scalar gauss3(const Scalar& from, const Scalar& to, const Function& f) {
  using std::sqrt;
  const Scalar middle = (from + to) / 2, half = (to - from) / 2;
  const Scalar off = half * sqrt(Scalar(3) / 5);
  return half * (5 * f(Scalar(middle - off)) + 8 * f(middle) + 5 * f(Scalar(middle + off))) / 9;
}

/// A function through a table's knots.
template <class Scalar> class Table {
public:
  Table(std::vector<double> x, std::vector<double> y, Interpolation how, Beyond beyond) {
    if (x.front() > x.back()) std::reverse(x.begin(), x.end()), std::reverse(y.begin(), y.end());
    x_.assign(x.begin(), x.end());
    y_.assign(y.begin(), y.end());
    const bool monotone = how == Interpolation::monotone && x_.size() > 2;
    for (std::size_t k = 0; k + 1 < x_.size(); ++k) {
      left_.push_back(monotone ? slope_at(k) : chord(k));
      right_.push_back(monotone ? slope_at(k + 1) : chord(k));
    }
    if (beyond == Beyond::straight) before_ = left_.front(), after_ = right_.back();
  }

  [[nodiscard]] Scalar value(const Scalar& x) const {
    if (x <= x_.front()) return y_.front() + before_ * (x - x_.front());
    if (x >= x_.back()) return y_.back() + after_ * (x - x_.back());
    const std::size_t k = piece(x);
    const Scalar h = x_[k + 1] - x_[k], t = (x - x_[k]) / h, u = 1 - t;
    return (1 + 2 * t) * u * u * y_[k] + t * u * u * h * left_[k] +
           t * t * (3 - 2 * t) * y_[k + 1] - t * t * u * h * right_[k];
  }

  [[nodiscard]] Scalar slope(const Scalar& x) const {
    if (x <= x_.front()) return before_;
    if (x >= x_.back()) return after_;
    const std::size_t k = piece(x);
    const Scalar h = x_[k + 1] - x_[k], t = (x - x_[k]) / h;
    return 6 * t * (1 - t) * (y_[k + 1] - y_[k]) / h + (1 - t) * (1 - 3 * t) * left_[k] +
           t * (3 * t - 2) * right_[k];
  }

  /// ∫ from one angle to another, in either direction.
  [[nodiscard]] Scalar integral(const Scalar& from, const Scalar& to) const {
    if (from > to) return -integral(to, from);
    const auto f = [&](const Scalar& x) { return value(x); };
    Scalar sum{0}, at = from;
    for (const Scalar& knot : x_) {
      if (knot <= at || knot >= to) continue;
      sum += gauss3(at, knot, f);
      at = knot;
    }
    return sum + gauss3(at, to, f);
  }

  [[nodiscard]] const std::vector<Scalar>& knots() const { return x_; }

private:
  [[nodiscard]] std::size_t piece(const Scalar& x) const {
    std::size_t k = 0;
    while (k + 2 < x_.size() && x >= x_[k + 1]) ++k;
    return k;
  }
  [[nodiscard]] Scalar chord(std::size_t k) const {
    return (y_[k + 1] - y_[k]) / (x_[k + 1] - x_[k]);
  }

  /// Fritsch & Butland's slope in Brodlie's form: d d'/(α d' + (1 − α) d) with α = (1 + h'/(h + h'))/3 where the chords d
  /// and d' have equal signs, else 0.
  [[nodiscard]] Scalar slope_at(std::size_t k) const {
    const std::size_t last = x_.size() - 1;
    if (k == 0) return end_slope(x_[1] - x_[0], x_[2] - x_[1], chord(0), chord(1));
    if (k == last)
      return end_slope(x_[last] - x_[last - 1], x_[last - 1] - x_[last - 2], chord(last - 1),
                       chord(last - 2));
    const Scalar d = chord(k - 1), e = chord(k);
    if (!(d * e > 0)) return Scalar(0);
    const Scalar alpha = (1 + (x_[k + 1] - x_[k]) / (x_[k + 1] - x_[k - 1])) / 3;
    return d * e / (alpha * e + (1 - alpha) * d);
  }

  /// The end slope of the parabola through three points, limited to between 0 and three times the chord's slope where the
  /// parabola would not follow the table's shape.
  [[nodiscard]] static Scalar end_slope(const Scalar& h, const Scalar& next, const Scalar& d,
                                        const Scalar& e) {
    using std::abs;
    const Scalar slope = d + (d - e) * h / (h + next);
    if (!(slope * d > 0)) return Scalar(0);
    if (!(d * e > 0) && abs(slope) > 3 * abs(d)) return 3 * d;
    return slope;
  }

  std::vector<Scalar> x_, y_, left_, right_; ///< slopes at both ends of each piece
  Scalar before_{0}, after_{0};              ///< slopes beyond the ends
};

/// The accelerations of a base that is driven, at a time: by its table, else constant.
template <class Scalar> class DrivenBase {
public:
  explicit DrivenBase(const Base& base)
      : x_(base.acceleration.x()), y_(base.acceleration.y()), turning_(base.angular_acceleration),
        rate_(base.rate), scale_(base.table_scale) {
    if (!base.table) return;
    const BaseTable::Columns& columns = base.table->columns();
    const auto curve = [&](std::vector<double> values) {
      return Table<Scalar>(columns.time, std::move(values), base.table->interpolation(),
                           Beyond::constant);
    };
    if (!columns.acceleration.empty()) {
      std::vector<double> x, y;
      for (const auto& a : columns.acceleration) x.push_back(a.x()), y.push_back(a.y());
      x_table_ = curve(x), y_table_ = curve(y);
    }
    if (!columns.angular_acceleration.empty()) turning_table_ = curve(columns.angular_acceleration);
    if (!columns.rate.empty()) rate_table_ = curve(columns.rate);
  }

  [[nodiscard]] Scalar initial_rate() const {
    return rate_table_ ? Scalar(scale_ * rate_table_->value(Scalar(0))) : rate_;
  }
  /// (r̈_0, ω̇_0)
  [[nodiscard]] Eigen::Matrix<Scalar, 3, 1> accelerations(const Scalar& time) const {
    return {x_table_ ? Scalar(scale_ * x_table_->value(time)) : x_,
            y_table_ ? Scalar(scale_ * y_table_->value(time)) : y_,
            rate_table_      ? Scalar(scale_ * rate_table_->slope(time))
            : turning_table_ ? Scalar(scale_ * turning_table_->value(time))
                             : turning_};
  }

private:
  Scalar x_, y_, turning_, rate_, scale_;
  std::optional<Table<Scalar>> x_table_, y_table_, turning_table_, rate_table_;
};

/// A spring or a harness: scale · law + offset.
template <class Scalar> struct TorqueLaw {
  Scalar stowed{0}, latched{0};       ///< angles, rad
  Scalar at_stowed{0}, at_latched{0}; ///< N·m
  Scalar scale{1}, offset{0};
  std::optional<Table<Scalar>> deploying, stowing; ///< stowing: if measured both ways

  TorqueLaw() = default;
  TorqueLaw(const Hinge& hinge, const HingeTorque& torque)
      : stowed(hinge.stowed), latched(hinge.latched), at_stowed(torque.torque_stowed),
        at_latched(torque.torque_latched), scale(torque.scale), offset(torque.offset) {
    if (!torque.table) return;
    const TorqueTable& t = *torque.table;
    deploying.emplace(t.angle(), t.deploying(), t.interpolation(), Beyond::constant);
    if (t.both_ways()) stowing.emplace(t.angle(), t.stowing(), t.interpolation(), Beyond::constant);
  }

  [[nodiscard]] Scalar torque(const Scalar& angle) const {
    if (stowing) return scale * (stowing->value(angle) + deploying->value(angle)) / 2 + offset;
    if (deploying) return scale * deploying->value(angle) + offset;
    const Scalar x = (angle - stowed) / (latched - stowed);
    return scale * (at_stowed + (at_latched - at_stowed) * x) + offset;
  }
  /// Coulomb's level: half the difference between stowing and deploying torque, N·m; 0 without a stowing table.
  [[nodiscard]] Scalar level(const Scalar& angle) const {
    if (!stowing) return Scalar(0);
    return (stowing->value(angle) - deploying->value(angle)) / 2;
  }
  /// ∫ of the torque over the angle.
  [[nodiscard]] Scalar integral(const Scalar& from, const Scalar& to) const {
    if (stowing)
      return scale * (stowing->integral(from, to) + deploying->integral(from, to)) / 2 +
             offset * (to - from);
    if (deploying) return scale * deploying->integral(from, to) + offset * (to - from);
    return gauss3(from, to, [&](const Scalar& angle) { return torque(angle); });
  }
};

/// The moment of a damper, which opposes the rate.
template <class Scalar>
[[nodiscard]] Scalar damper_moment(const Damper& damper, const Scalar& angle, const Scalar& rate) {
  using std::abs;
  using std::pow;
  if (damper.window) {
    const auto [lower, upper] = std::minmax((*damper.window)[0], (*damper.window)[1]);
    if (angle < lower || angle > upper) return Scalar(0);
  }
  const Scalar scale(damper.scale), size = abs(rate);
  switch (damper.law) {
  case DamperLaw::viscous:
    break;
  case DamperLaw::power: {
    const Scalar w(damper.regularization_rate), p(damper.exponent);
    const Scalar slowest = size > w ? size : w;
    return -scale * Scalar(damper.coefficient) * pow(slowest, Scalar(p - 1)) * rate;
  }
  case DamperLaw::eddy_current: {
    const Scalar peak(damper.peak_rate);
    return -scale * Scalar(damper.peak_torque) * 2 * rate * peak / (peak * peak + rate * rate);
  }
  }
  return -scale * Scalar(damper.coefficient) * rate;
}

/// The moment of a stop along the travel; a stop pushes and never pulls.
template <class Scalar>
[[nodiscard]] Scalar stop_moment(const Stop& stop, const Scalar& x, const Scalar& v) {
  const Scalar depth = -x - Scalar(stop.gap);
  const Scalar push = 1 - Scalar(stop.dissipation) * v;
  return depth > 0 && push > 0 ? Scalar(stop.stiffness) * depth * push : Scalar(0);
}
template <class Scalar> [[nodiscard]] Scalar stop_energy(const Stop& stop, const Scalar& x) {
  const Scalar depth = -x - Scalar(stop.gap);
  return depth > 0 ? Scalar(stop.stiffness) * depth * depth / 2 : Scalar(0);
}

/// The angle by which an engaged latch is beyond its backlash; 0 within the backlash.
template <class Scalar> [[nodiscard]] Scalar latch_strain(const Latch& latch, const Scalar& y) {
  const Scalar play = Scalar(latch.backlash) / 2;
  if (y > play) return y - play;
  if (y < -play) return y + play;
  return Scalar(0);
}
template <class Scalar>
[[nodiscard]] Scalar latch_moment(const Latch& latch, const Scalar& y, const Scalar& rate) {
  using std::abs;
  if (latch.backlash > 0 && abs(y) <= Scalar(latch.backlash) / 2) return Scalar(0);
  const Scalar strain = latch_strain(latch, y), elastic = -Scalar(latch.stiffness) * strain;
  if (!latch.dissipation) return elastic - Scalar(latch.damping) * rate;
  const Scalar beyond = strain < 0 ? Scalar(-rate) : rate; // Hunt & Crossley's factor, both ways
  return elastic * (1 + Scalar(*latch.dissipation) * beyond);
}
template <class Scalar> [[nodiscard]] Scalar latch_energy(const Latch& latch, const Scalar& y) {
  const Scalar strain = latch_strain(latch, y);
  return Scalar(latch.stiffness) * strain * strain / 2;
}

/// A closed cable loop between the travels of two hinges.
template <class Scalar> struct Loop {
  int first, second; ///< indices into Scene::hinges
  Scalar ratio, stiffness, damping;
  std::optional<Scalar> preload;
  std::optional<Table<Scalar>> table;

  explicit Loop(const Synchronisation& loop)
      : first(loop.first), second(loop.second), ratio(loop.ratio), stiffness(loop.stiffness),
        damping(loop.damping) {
    if (loop.preload) preload = Scalar(*loop.preload);
    if (loop.table)
      table.emplace(loop.travel, loop.travel_of_second, Interpolation::monotone, Beyond::straight);
  }

  [[nodiscard]] Scalar slope(const Scalar& x) const { return table ? table->slope(x) : ratio; }
  [[nodiscard]] Scalar out_of_step(const Scalar& xa, const Scalar& xb) const {
    return (table ? table->value(xa) : Scalar(ratio * xa)) - xb;
  }
  [[nodiscard]] bool slack(const Scalar& e) const {
    using std::abs;
    return preload && stiffness * abs(e) > 2 * *preload;
  }
  /// τ along the travel of the second hinge.
  [[nodiscard]] Scalar pull(const Scalar& e, const Scalar& e_rate) const {
    const Scalar taut = stiffness * e + damping * e_rate;
    if (!slack(e)) return taut;
    return taut / 2 + (e > 0 ? *preload : Scalar(-*preload));
  }
  [[nodiscard]] Scalar energy(const Scalar& e) const {
    using std::abs;
    if (!slack(e)) return stiffness * e * e / 2;
    const Scalar edge = 2 * *preload / stiffness;
    const auto force = [&](const Scalar& x) { return pull(x, Scalar(0)); };
    return stiffness * edge * edge / 2 + gauss3(edge, Scalar(abs(e)), force);
  }
};

} // namespace wingspread::oracle
