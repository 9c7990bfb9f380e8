/// The parts that both reference integrators of reference_run.hpp share: the dense wing as an ordinary differential
/// equation, the search for peaks inside a step, and the record of a run.
///
/// The flat state y, for n hinges (2n + 6, n more when the latch is smoothed, one more when the base
/// is driven by a table of time):
///
/// | part        | entries       | unit       |
/// |-------------|---------------|------------|
/// | φ           | n             | rad        |
/// | x_0, θ_0    | 3             | m, rad     |
/// | φ̇           | n             | rad/s      |
/// | ẋ_0, ω_0    | 3             | m/s, rad/s |
/// | S           | n, smoothed   | s          |
/// | t           | 1, base by a table | s     |
#pragma once

#include "tests/support/dry_friction.hpp"
#include "tests/support/reference_run.hpp"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread::oracle {

/// The dense wing as ẏ = f(y), between engagements.
template <class Scalar> class WingOde {
public:
  WingOde(const Scene& scene, const std::optional<double>& smoothing)
      : friction_(scene), wing_(DryFriction<Scalar>::removed(scene)),
        smoothed_(smoothing.has_value()), timed_(scene.base.table != nullptr),
        epsilon_(smoothing.value_or(0)), latched_(scene.hinges.size(), false) {}

  [[nodiscard]] const DenseWing<Scalar>& wing() const { return wing_; }
  [[nodiscard]] bool smoothed() const { return smoothed_; }
  [[nodiscard]] int hinges() const { return wing_.size(); }
  [[nodiscard]] int dimension() const {
    return (smoothed_ ? 3 : 2) * hinges() + 6 + (timed_ ? 1 : 0);
  }
  [[nodiscard]] bool latched(int hinge) const { return latched_[hinge]; }
  [[nodiscard]] bool awaits_latch(int hinge) const {
    return wing_.has_latch(hinge) && !latched_[hinge];
  }

  /// Notes that a hinge has reached its latch. Unless latches are smoothed, the latch's moment acts from now on.
  void latch(int hinge) { latched_[hinge] = true; }

  /// The exact friction and its present contact states.
  [[nodiscard]] const DryFriction<Scalar>& friction() const { return friction_; }
  /// Decides again which hinges at rest stick. Call after every event.
  void settle(const Vector<Scalar>& y) {
    if (friction_.any()) friction_.settle(wing_, state(y));
  }
  /// Sets the rate of a hinge that has come to rest to exactly zero.
  void stop(int hinge, Vector<Scalar>& y) const { y(half() + hinge) = 0; }
  /// Negative while a hinge keeps its contact state: it slides on in the same sense, or sticks on.
  [[nodiscard]] Scalar contact_gap(int hinge, const Vector<Scalar>& y) const {
    if (!friction_.acts(hinge)) return Scalar(-1);
    if (!friction_.sticks(hinge)) return Scalar(-friction_.sense(hinge) * y(half() + hinge));
    const WingState<Scalar> now = state(y);
    return friction_.excess(wing_, now, friction_.respond(wing_, now), hinge);
  }

  [[nodiscard]] Vector<Scalar> initial() const {
    const WingState<Scalar> state = wing_.initial_state();
    Vector<Scalar> y = Vector<Scalar>::Zero(dimension());
    y.head(half()) << state.angles, state.base_position, state.base_angle;
    y.segment(half(), half()) << state.rates, state.base_velocity, state.base_rate;
    return y;
  }

  [[nodiscard]] WingState<Scalar> state(const Vector<Scalar>& y) const {
    const int n = hinges();
    WingState<Scalar> state{y.head(n),
                            y.segment(half(), n),
                            Vector<Scalar>(n),
                            y.template segment<2>(n),
                            y.template segment<2>(half() + n),
                            y(n + 2),
                            y(half() + n + 2),
                            timed_ ? y(dimension() - 1) : Scalar(0)};
    for (int i = 0; i < n; ++i) state.engagement(i) = engagement(i, y);
    return state;
  }

  /// ẏ, with Ṡ = the smooth step of the overtravel over [0, ε].
  [[nodiscard]] Vector<Scalar> derivative(const Vector<Scalar>& y) const {
    const WingResponse<Scalar> response = respond(y);
    Vector<Scalar> result(dimension());
    if (timed_) result(dimension() - 1) = 1;
    result.head(half()) = y.segment(half(), half());
    result.segment(half(), half()) << response.hinge_accelerations, response.base_acceleration,
        response.base_angular_acceleration;
    for (int i = 0; smoothed_ && i < hinges(); ++i)
      result(2 * half() + i) = smooth_step<Scalar>(overtravel(i, y) / epsilon_);
    return result;
  }

  /// 3n values: |M| of every hinge, N·m; |f| of every hinge, N; the angle of every hinge beyond its stowed angle, rad.
  [[nodiscard]] Vector<Scalar> magnitudes(const Vector<Scalar>& y) const {
    const WingResponse<Scalar> response = respond(y);
    const int n = hinges();
    Vector<Scalar> result(3 * n);
    result.head(2 * n) << response.moments.cwiseAbs(), response.forces.colwise().norm().transpose();
    for (int i = 0; i < n; ++i) result(2 * n + i) = std::max<Scalar>(-wing_.travel(i, y(i)), 0);
    return result;
  }

  [[nodiscard]] Scalar overtravel(int hinge, const Vector<Scalar>& y) const {
    return wing_.overtravel(hinge, y(hinge));
  }
  /// The rate of overtravel: positive while deploying, rad/s.
  [[nodiscard]] Scalar overtravel_rate(int hinge, const Vector<Scalar>& y) const {
    return wing_.sense(hinge) * y(half() + hinge);
  }

private:
  [[nodiscard]] WingResponse<Scalar> respond(const Vector<Scalar>& y) const {
    return friction_.any() ? friction_.respond(wing_, state(y)) : wing_.respond(state(y));
  }
  [[nodiscard]] int half() const { return hinges() + 3; }
  [[nodiscard]] Scalar engagement(int hinge, const Vector<Scalar>& y) const {
    if (!wing_.has_latch(hinge)) return Scalar(0);
    if (!smoothed_) return Scalar(latched_[hinge] ? 1 : 0);
    return smooth_step<Scalar>(y(2 * half() + hinge) / epsilon_);
  }

  DryFriction<Scalar> friction_;
  DenseWing<Scalar> wing_;
  bool smoothed_, timed_;
  Scalar epsilon_;
  std::vector<bool> latched_;
};

/// The largest value so far of each of several quantities, and its time.
template <class Scalar> class PeakTable {
public:
  explicit PeakTable(int quantities)
      : values_(Vector<Scalar>::Constant(quantities, Scalar(-1))),
        times_(Vector<Scalar>::Zero(quantities)) {}

  void offer(int quantity, const Scalar& value, const Scalar& time) {
    if (!(value > values_(quantity))) return;
    values_(quantity) = value;
    times_(quantity) = time;
  }

  /// Raises the peaks to what the quantities reach in [lower, upper].
  /// @param at time → all quantities; smooth in [lower, upper], except where a magnitude is 0
  /// @param intervals number of equal parts of the first sampling, ≥ 2
  template <class At>
  void hunt(const Scalar& lower, const Scalar& upper, int intervals, const At& at) {
    const Scalar width = (upper - lower) / intervals;
    std::vector<Vector<Scalar>> samples;
    for (int i = 0; i <= intervals; ++i)
      samples.push_back(at(i < intervals ? Scalar(lower + i * width) : upper));
    for (int quantity = 0; quantity < values_.size(); ++quantity) {
      int best = 0;
      for (int i = 0; i <= intervals; ++i)
        if (samples[i](quantity) > samples[best](quantity)) best = i;
      offer(quantity, samples[best](quantity), best < intervals ? lower + best * width : upper);
      const int middle = std::clamp(best, 1, intervals - 1);
      if (may_exceed(quantity, samples[middle - 1], samples[middle], samples[middle + 1]))
        refine(quantity, lower + (middle - 1) * width, lower + (middle + 1) * width, at);
    }
  }

  [[nodiscard]] std::vector<ReferencePeak> peaks(int first, int count) const {
    std::vector<ReferencePeak> result;
    for (int i = first; i < first + count; ++i)
      result.push_back({static_cast<double>(values_(i)), static_cast<double>(times_(i))});
    return result;
  }

private:
  /// Whether the parabola through three equidistant samples has its peak in or near their interval, and this peak, plus
  /// the second difference as a margin, exceeds the largest value so far.
  [[nodiscard]] bool may_exceed(int quantity, const Vector<Scalar>& left,
                                const Vector<Scalar>& middle, const Vector<Scalar>& right) const {
    using std::abs;
    const Scalar a = left(quantity), b = middle(quantity), c = right(quantity);
    const Scalar curvature = a - 2 * b + c;
    if (!(curvature < 0) || abs(a - c) > -3 * curvature) return false;
    return b - (a - c) * (a - c) / (8 * curvature) - curvature > values_(quantity);
  }

  template <class At>
  void refine(int quantity, const Scalar& lower, const Scalar& upper, const At& at) {
    const auto negative = [&](const Scalar& time) { return Scalar(-at(time)(quantity)); };
    const int bits = std::numeric_limits<Scalar>::digits / 2;
    const auto found = boost::math::tools::brent_find_minima(negative, lower, upper, bits);
    offer(quantity, -found.second, found.first);
  }

  Vector<Scalar> values_, times_;
};

/// Records a run's events, peaks and audits step by step.
template <class Scalar> class RunBook {
public:
  RunBook(WingOde<Scalar>& ode, const ReferenceOptions& options, const Vector<Scalar>& y)
      : ode_(ode), coincidence_(options.coincidence), peaks_(3 * ode.hinges()),
        start_(ode.wing().balance(ode.state(y))) {}

  /// After an accepted step [lower, upper] that ended in y; `at` gives the state inside it.
  template <class StateAt>
  void step(const Scalar& lower, const Scalar& upper, int intervals, const StateAt& at) {
    peaks_.hunt(lower, upper, intervals,
                [&](const Scalar& time) { return ode_.magnitudes(at(time)); });
    audit(at(upper));
    ++outcome_.steps;
  }

  /// Latches a hinge at time t and state y, and all other hinges that are due at the same instant. Updates the peaks with
  /// the values just after.
  void latch(int hinge, const Scalar& time, const Vector<Scalar>& y) {
    const auto due = [&](int other) {
      return other == hinge ||
             (ode_.awaits_latch(other) && ode_.overtravel_rate(other, y) > 0 &&
              ode_.overtravel(other, y) + coincidence_ * ode_.overtravel_rate(other, y) >= 0);
    };
    const Vector<double> rates = ode_.state(y).rates.template cast<double>();
    for (int i = 0; i < ode_.hinges(); ++i) {
      if (!due(i)) continue;
      outcome_.latches.push_back(
          {i, static_cast<double>(time), std::vector<double>(rates.begin(), rates.end())});
      ode_.latch(i);
    }
    settle(time, y);
  }

  /// Decides which hinges stick, and updates the peaks with the values just after.
  void settle(const Scalar& time, const Vector<Scalar>& y) {
    ode_.settle(y);
    const Vector<Scalar> magnitudes = ode_.magnitudes(y);
    for (int i = 0; i < magnitudes.size(); ++i) peaks_.offer(i, magnitudes(i), time);
  }

  /// The outcome of a run that ends in y.
  [[nodiscard]] ReferenceOutcome close(const Vector<Scalar>& y) {
    outcome_.peak_moment = peaks_.peaks(0, ode_.hinges());
    outcome_.peak_force = peaks_.peaks(ode_.hinges(), ode_.hinges());
    outcome_.overtravel = peaks_.peaks(2 * ode_.hinges(), ode_.hinges());
    outcome_.final = ode_.state(y).template cast<double>();
    outcome_.initial_balance = in_double(start_);
    outcome_.final_balance = in_double(ode_.wing().balance(ode_.state(y)));
    return outcome_;
  }

private:
  [[nodiscard]] static WingBalance<double> in_double(const WingBalance<Scalar>& balance) {
    return {static_cast<double>(balance.kinetic), static_cast<double>(balance.potential),
            balance.linear_momentum.template cast<double>(),
            static_cast<double>(balance.angular_momentum)};
  }

  void audit(const Vector<Scalar>& y) {
    using std::abs;
    const WingBalance<Scalar> now = ode_.wing().balance(ode_.state(y));
    const auto raise = [](double& largest, const Scalar& change) {
      largest = std::max(largest, static_cast<double>(abs(change)));
    };
    if (outcome_.latches.empty())
      raise(outcome_.energy_drift,
            (now.kinetic - start_.kinetic) + (now.potential - start_.potential));
    raise(outcome_.momentum_drift, now.linear_momentum.x() - start_.linear_momentum.x());
    raise(outcome_.momentum_drift, now.linear_momentum.y() - start_.linear_momentum.y());
    raise(outcome_.spin_drift, now.angular_momentum - start_.angular_momentum);
  }

  WingOde<Scalar>& ode_;
  Scalar coincidence_;
  PeakTable<Scalar> peaks_;
  WingBalance<Scalar> start_;
  ReferenceOutcome outcome_;
};

} // namespace wingspread::oracle
