/// The whole life of a wing by the dense formulation of dense_wing.hpp: hinges that are held and released, latches that
/// miss and let go again, stops at the far side, motors.
///
/// Held hinges are held by the moments that a linear solve gives, as sticking hinges in dry_friction.hpp. Steps are
/// those of Fehlberg's order-8 formula; events are found by bisection with real steps. core/ uses none of these.
#pragma once

#include "tests/support/dense_wing.hpp"
#include "tests/support/hinge_laws.hpp"

#include <Eigen/LU>
#include <boost/math/tools/minima.hpp>
#include <boost/numeric/odeint.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace wingspread::oracle {

class WholeLife {
public:
  struct Event {
    int hinge;
    double time, rate;
  };

  /// @pre no exact friction and no smoothed latch
  explicit WholeLife(const Scene& scene) : scene_(scene), wing_(scene) {
    const std::size_t n = scene.hinges.size();
    engaged_.assign(n, 0), held_.assign(n, 0), side_.assign(n, -1), due_.assign(n, never);
    hold_moment.assign(n, 0);
    const WingState<double> start = wing_.initial_state();
    y_.resize(2 * (n + 3));
    write(start);
    released_.assign(n, 0), commands_.resize(n);
    motor_energy.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i)
      if (const auto& motor = scene.hinges[i].motor; motor && motor->table)
        commands_[i].emplace(motor->time, motor->rates, motor->interpolation, Beyond::constant);
    for (std::size_t i = 0; i < n; ++i) held_[i] = scene.hinges[i].release.has_value();
    for (std::size_t i = 0; i < n; ++i) schedule(static_cast<int>(i), Release::Event::time, -1);
    let_go_due();
  }

  std::vector<Event> releases, latches, missed, let_go;
  std::vector<double> hold_moment;  ///< largest |moment| of each hold, N·m
  std::vector<double> motor_energy; ///< of each motor while its latch is not engaged, J

  [[nodiscard]] double time() const { return t_; }
  [[nodiscard]] WingState<double> state() const { return state(y_); }
  [[nodiscard]] bool engaged(int hinge) const { return engaged_[hinge] != 0; }
  [[nodiscard]] WingBalance<double> balance() const { return wing_.balance(state()); }

  void run(double t_end, double longest = 0.01, double tolerance = 1e-12) {
    auto control = boost::numeric::odeint::make_controlled(tolerance, tolerance, Stepper());
    double h = 1e-4;
    sample_holds(y_, t_);
    while (t_ < t_end) {
      const double stretch =
          std::min({t_end, *std::min_element(due_.begin(), due_.end()), next_knot()});
      h = std::min(h, longest);
      const bool last = t_ + h >= stretch * (1 - 1e-15);
      if (last) h = stretch - t_;
      State next = y_;
      double t = t_, tried = h;
      if (control.try_step(right_side(), next, t, tried) == boost::numeric::odeint::fail) {
        h = tried;
        continue;
      }
      const double step = t - t_;
      h = std::max(tried, 1e-7);
      const int happens = earliest(step);
      add_motor_work(happens < 0 ? step : where_);
      if (happens < 0) {
        search_holds(step);
        y_ = next, t_ = last ? stretch : t;
        sample_holds(y_, t_);
      } else {
        search_holds(where_);
        y_ = after(where_), t_ += where_;
        sample_holds(y_, t_);
        apply(happens);
        h = 1e-5;
      }
      const bool released = let_go_due();
      if (!released && happens < 0) continue;
      sample_holds(y_, t_); // moments jump where a latch with a damper engages
      h = 1e-5;
    }
  }

private:
  using State = std::vector<double>;
  using Stepper = boost::numeric::odeint::runge_kutta_fehlberg78<State>;
  static constexpr double never = std::numeric_limits<double>::infinity();

  [[nodiscard]] int size() const { return wing_.size(); }
  [[nodiscard]] int half() const { return size() + 3; }

  [[nodiscard]] WingState<double> state(const State& y) const {
    const int n = size();
    WingState<double> s = wing_.initial_state();
    for (int i = 0; i < n; ++i) {
      s.angles(i) = y[i], s.rates(i) = y[half() + i];
      s.engagement(i) = engaged_[i] ? 1 : 0;
    }
    s.base_position = {y[n], y[n + 1]}, s.base_angle = y[n + 2];
    s.base_velocity = {y[half() + n], y[half() + n + 1]}, s.base_rate = y[half() + n + 2];
    return s;
  }
  void write(const WingState<double>& s) {
    const int n = size();
    for (int i = 0; i < n; ++i) y_[i] = s.angles(i), y_[half() + i] = s.rates(i);
    y_[n] = s.base_position.x(), y_[n + 1] = s.base_position.y(), y_[n + 2] = s.base_angle;
    y_[half() + n] = s.base_velocity.x(), y_[half() + n + 1] = s.base_velocity.y();
    y_[half() + n + 2] = s.base_rate;
  }

  [[nodiscard]] double beyond(const State& y, int i) const { return wing_.overtravel(i, y[i]); }
  [[nodiscard]] double along(const State& y, int i) const { return wing_.sense(i) * y[half() + i]; }

  [[nodiscard]] double elastic_hold(const State& y, int i) const {
    const Hinge& hinge = scene_.hinges[i];
    if (!held_[i] || !hinge.hold) return 0;
    return -hinge.hold->stiffness * (y[i] - hinge.stowed) - hinge.hold->damping * y[half() + i];
  }

  // ---- motors, along the travel

  /// The command less the rate.
  [[nodiscard]] double lag(const State& y, double t, int i) const {
    const Motor& motor = *scene_.hinges[i].motor;
    const double since = t - released_[i];
    const double rate = motor.table ? motor.scale * commands_[i]->value(since) : motor.rate;
    return rate - along(y, i);
  }
  [[nodiscard]] double motor_torque(const State& y, double t, int i) const {
    const std::optional<Motor>& motor = scene_.hinges[i].motor;
    if (!motor || held_[i]) return 0;
    return std::min(std::max(motor->gain * lag(y, t, i), -motor->torque_limit),
                    motor->torque_limit);
  }
  [[nodiscard]] double next_knot() const {
    double next = never;
    for (int i = 0; i < size(); ++i)
      if (scene_.hinges[i].motor && !held_[i])
        for (const double knot : scene_.hinges[i].motor->time)
          if (released_[i] + knot > t_ * (1 + 1e-14)) next = std::min(next, released_[i] + knot);
    return next;
  }
  /// Simpson's rule over the next step of h, with real steps.
  void add_motor_work(double h) {
    if (std::none_of(scene_.hinges.begin(), scene_.hinges.end(),
                     [](const Hinge& hinge) { return hinge.motor.has_value(); }))
      return;
    const State middle = after(0.5 * h), last = after(h);
    for (int i = 0; i < size(); ++i) {
      if (engaged_[i]) continue;
      const auto power = [&](const State& y, double t) {
        return motor_torque(y, t, i) * along(y, i);
      };
      motor_energy[i] +=
          h / 6 * (power(y_, t_) + 4 * power(middle, t_ + 0.5 * h) + power(last, t_ + h));
    }
  }

  /// The hinges' own moments, with motors and elastic holds.
  [[nodiscard]] Vector<double> own_moments(const State& y, double t) const {
    Vector<double> moments = wing_.moments(state(y));
    for (int i = 0; i < size(); ++i)
      moments(i) += wing_.sense(i) * motor_torque(y, t, i) + elastic_hold(y, i);
    return moments;
  }

  /// Accelerations, and the moments of the holds in `holds`.
  [[nodiscard]] WingResponse<double> respond(const State& y, double t,
                                             Vector<double>* holds) const {
    const WingState<double> now = state(y);
    Vector<double> moments = own_moments(y, t);
    std::vector<int> held;
    for (int i = 0; i < size(); ++i)
      if (held_[i] && !scene_.hinges[i].hold) held.push_back(i);
    if (holds) *holds = Vector<double>::Zero(size());
    for (int i = 0; holds && i < size(); ++i) (*holds)(i) = elastic_hold(y, i);
    if (held.empty()) return wing_.respond(now, moments);
    const Vector<double> free = wing_.respond(now, moments).hinge_accelerations;
    const auto count = static_cast<Eigen::Index>(held.size());
    Matrix<double> yields(count, count);
    Vector<double> wanted(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      Vector<double> pushed = moments;
      pushed(held[k]) += 1;
      const Vector<double> more = wing_.respond(now, pushed).hinge_accelerations - free;
      for (Eigen::Index j = 0; j < count; ++j) yields(j, k) = more(held[j]);
      wanted(k) = -free(held[k]);
    }
    const Vector<double> holding = yields.fullPivLu().solve(wanted);
    for (Eigen::Index k = 0; k < count; ++k) {
      moments(held[k]) += holding(k);
      if (holds) (*holds)(held[k]) = holding(k);
    }
    WingResponse<double> response = wing_.respond(now, moments);
    for (const int i : held) response.hinge_accelerations(i) = 0;
    return response;
  }

  [[nodiscard]] std::function<void(const State&, State&, double)> right_side() const {
    return [this](const State& y, State& dydt, double t) {
      const WingResponse<double> r = respond(y, t, nullptr);
      dydt.resize(y.size());
      for (int k = 0; k < half(); ++k) dydt[k] = y[half() + k];
      const int n = size();
      for (int i = 0; i < n; ++i) dydt[half() + i] = r.hinge_accelerations(i);
      dydt[half() + n] = r.base_acceleration.x(), dydt[half() + n + 1] = r.base_acceleration.y();
      dydt[half() + n + 2] = r.base_angular_acceleration;
    };
  }

  /// The state after a real step of h from the present one.
  [[nodiscard]] State after(double h) const {
    State next(y_.size());
    Stepper().do_step(right_side(), y_, t_, next, h);
    return next;
  }

  void sample_holds(const State& y, double t) {
    Vector<double> holds;
    (void)respond(y, t, &holds);
    for (int i = 0; i < size(); ++i) hold_moment[i] = std::max(hold_moment[i], std::abs(holds(i)));
  }
  /// Looks for the largest moment of each hold inside the next step of h.
  void search_holds(double h) {
    for (int i = 0; i < size(); ++i) {
      if (!held_[i]) continue;
      const auto minus = [&](double s) {
        Vector<double> holds;
        (void)respond(s == 0 ? y_ : after(s), t_ + s, &holds);
        return -std::abs(holds(i));
      };
      const double first = minus(0), middle = minus(0.5 * h), last = minus(h);
      const double bend = std::abs(first - 2 * middle + last);
      if (-std::min({first, middle, last}) + bend < hold_moment[i]) continue;
      if (std::abs(first - last) > 4 * bend) continue;
      const auto [s, least] = boost::math::tools::brent_find_minima(minus, 0., h, 26);
      hold_moment[i] = std::max(hold_moment[i], -least);
    }
  }

  // ---- events: of each hinge a pass of its latch, a latch that lets go, an angle that a hold waits for, and the
  // deflections at which its law bends: Fehlberg's estimate does not see these

  enum { passes, opens, seen, contact, low, high, driving, braking, kinds };

  /// Where the law of a hinge bends, beyond its latched angle.
  [[nodiscard]] double bend(int kind, const Hinge& hinge) const {
    if (kind == contact) return hinge.far_stop ? hinge.far_stop->gap : never;
    if (!hinge.latch) return never;
    return kind == low ? -0.5 * hinge.latch->backlash : 0.5 * hinge.latch->backlash;
  }

  /// Negative until the event.
  [[nodiscard]] double gap(int event, const State& y, double t) const {
    const int i = event / kinds;
    const Hinge& hinge = scene_.hinges[i];
    switch (event % kinds) {
    case passes:
      if (!hinge.latch || engaged_[i] || (held_[i] && !hinge.hold)) return -1;
      return -side_[i] * beyond(y, i);
    case opens: {
      if (!hinge.latch || !engaged_[i] || !hinge.latch->holding_moment) return -1;
      if (!(beyond(y, i) < -0.5 * hinge.latch->backlash)) return -1;
      const double moment = latch_moment(*hinge.latch, y[i] - hinge.latched, y[half() + i]);
      return wing_.sense(i) * moment - *hinge.latch->holding_moment;
    }
    case contact:
    case low:
    case high: {
      const double at = bend(event % kinds, hinge), start = beyond(y_, i) - at;
      if (at == never || start == 0 || (event % kinds != contact && !engaged_[i])) return -1;
      return start < 0 ? beyond(y, i) - at : at - beyond(y, i);
    }
    case driving:
    case braking: { // the motor reaches or leaves its limit
      if (!hinge.motor || held_[i] || !(hinge.motor->gain > 0)) return -1;
      const double limit =
          (event % kinds == driving ? 1 : -1) * hinge.motor->torque_limit / hinge.motor->gain;
      const double start = lag(y_, t_, i) - limit, now = lag(y, t, i) - limit;
      if (std::abs(start) < 1e-13) return -1; // the last event was this one
      return start < 0 ? now : -now;
    }
    default:
      if (!held_[i] || !hinge.release || hinge.release->event != Release::Event::passed ||
          due_[i] < never || hinge.release->fails != 0)
        return -1;
      return wing_.travel(hinge.release->after, y[hinge.release->after]) - hinge.release->angle;
    }
  }

  /// The earliest event in the next step of h, and in where_ its instant; −1: none.
  [[nodiscard]] int earliest(double h) {
    int first = -1;
    where_ = h;
    State end = after(h);
    for (int event = 0; event < kinds * size(); ++event) {
      if (gap(event, end, t_ + where_) < 0) continue;
      double left = 0, right = where_;
      for (int k = 0; k < 80 && right - left > 1e-16 * (1 + t_); ++k) {
        const double middle = 0.5 * (left + right);
        (gap(event, after(middle), t_ + middle) < 0 ? left : right) = middle;
      }
      where_ = right, first = event, end = after(right);
    }
    return first;
  }

  void apply(int event) {
    const int i = event / kinds;
    const Hinge& hinge = scene_.hinges[i];
    const Event now{i, t_, y_[half() + i]};
    if (event % kinds > seen) return;
    if (event % kinds == seen) return note(hinge.release->after, Release::Event::passed, i);
    if (event % kinds == opens) {
      engaged_[i] = 0, side_[i] = -1;
      return void(let_go.push_back(now));
    }
    const double most = hinge.latch->capture_rate.value_or(never);
    if (std::abs(now.rate) > most) {
      side_[i] = -side_[i];
      return void(missed.push_back(now));
    }
    engaged_[i] = 1;
    latches.push_back(now);
    note(i, Release::Event::latched, -1);
  }

  void schedule(int i, Release::Event event, int after) {
    const std::optional<Release>& release = scene_.hinges[i].release;
    if (!release || release->fails != 0 || release->event != event || due_[i] < never) return;
    if (event != Release::Event::time && release->after != after) return;
    if (held_[i]) due_[i] = (event == Release::Event::time ? release->time : t_) + release->delay;
  }
  /// Something has happened to a hinge. @param watcher of Event::passed
  void note(int hinge, Release::Event event, int watcher) {
    for (int i = 0; i < size(); ++i)
      if (watcher < 0 || i == watcher) schedule(i, event, hinge);
  }
  bool let_go_due() {
    bool any = false;
    for (bool again = true; again;) {
      again = false;
      for (int i = 0; i < size(); ++i) {
        if (!held_[i] || due_[i] > t_) continue;
        held_[i] = 0, due_[i] = never, released_[i] = t_;
        if (t_ > 0) releases.push_back({i, t_, 0});
        note(i, Release::Event::released, -1);
        any = again = true;
      }
    }
    return any;
  }

  Scene scene_;
  DenseWing<double> wing_;
  State y_;
  double t_ = 0, where_ = 0;
  std::vector<char> engaged_, held_;
  std::vector<int> side_; ///< of its latched angle on which an open hinge is: −1 towards stowed
  std::vector<double> due_, released_;
  std::vector<std::optional<Table<double>>> commands_; ///< r of each motor with a table
};

} // namespace wingspread::oracle
