/// The search for kinks of laws (kinks.hpp) inside a step.
#pragma once

#include "core/dense/latch_states.hpp"
#include "core/events/leaps.hpp"
#include "core/laws/smoothed_latch.hpp"

#include <optional>

namespace wingspread {

/// Finds the first kink that matters in a step.
template <class T, class AnySystem> class KinkSearch {
public:
  KinkSearch(const AnySystem& system, const Step<T>& step, const KinkLimit& limit)
      : system_(system), step_(step), limit_(limit) {}

  struct Found {
    Kink<T> kink;
    T s; ///< fraction of the step
  };

  [[nodiscard]] std::optional<Found> first() {
    if (!limit_.refused) search_hinges();
    const int motors = static_cast<int>(system_.wing().motors.size());
    for (int i = 1; i < motors; ++i)
      if (!system_.is_locked(i) && system_.motor_runs(i)) search_motor(i);
    const int loops = static_cast<int>(system_.wing().loops.size());
    for (int l = 0; l < loops; ++l) search_loop(l);
    if (system_.layout().smoothed && !limit_.leaps_only)
      for (int i = 1; i <= system_.layout().bodies; ++i)
        if (system_.wing().hinges[i].has_latch) search_smoothed_latch(i);
    return first_;
  }

  /// The fraction of the step at the first kink that matters, among those of hinges' own laws.
  [[nodiscard]] std::optional<T> first_of_hinges() {
    counts_twists_ = true;
    search_hinges();
    if (!first_) return std::nullopt;
    return first_->s;
  }

private:
  using Of = typename Kink<T>::Of;

  void search_hinges() {
    const int hinges = static_cast<int>(system_.wing().real.size());
    for (int i = 1; i < hinges; ++i)
      if (!system_.is_locked(i)) search_hinge(i);
  }

  void search_hinge(int i) {
    const RealHingeTerms<T>& real = system_.wing().real[i];
    if (limit_.leaps_only && !real.has_tables()) return;
    const Layout& at = system_.layout();
    const Quintic<T> angle = step_.coordinate(at.angle(i), at.freedoms());
    for (const CurveTorqueTerms<T>* torque : {&real.spring, &real.harness})
      if (torque->curve) search_knots(*torque->curve, torque->weight, i, angle);
    if (real.friction.level) search_knots(*real.friction.level, real.friction.weight, i, angle);
    if (!limit_.leaps_only) search_rates(i, step_.rate(at.angle(i), at.freedoms()));
  }

  void search_rates(int i, const Quintic<T>& rate) {
    using std::abs;
    const RealHingeTerms<T>& real = system_.wing().real[i];
    for_each_kink_of_rate(
        real, system_.work().modes[i], [&](const T& there, bool acts, const HingeStop<T>* stop) {
          if (!acts) return;
          const T turn = stop ? turn_of(*stop, i)
                              : T(abs(T(1) - real.damper.exponent) * real.damper.near_zero);
          offer_passage({Of::rate, i, there, T(0)}, rate, {i, T(0), turn, T(0)});
        });
  }

  /// Jump of d(moment)/d(rate) of a stop at the rate at which it lets go, N·m·s/rad.
  [[nodiscard]] T turn_of(const HingeStop<T>& stop, int i) const {
    const int angle = system_.layout().angle(i);
    const T depth = larger(stop.depth(step_.x[angle]), stop.depth(step_.x1[angle]));
    return stop.terms.stiffness * stop.terms.dissipation * larger(depth, T(0));
  }

  void search_motor(int i) {
    const MotorTerms<T>& motor = system_.wing().motors[i];
    const Layout& at = system_.layout();
    const Quintic<T> rate = step_.rate(at.angle(i), at.freedoms());
    const Quintic<T> excess = motor_excess(system_.work().motors[i], step_.t, step_.h, rate);
    if (!(motor_regime(motor, excess) == T(2))) return;
    for (const T& at_limit : {T(motor.limit / motor.gain), T(-motor.limit / motor.gain)})
      offer_passage({Of::excess, i, at_limit, T(0)}, excess, {i, T(0), motor.gain, T(0)});
  }

  /// Knots of a curve of hinge i's angle.
  void search_knots(const Curve& curve, const T& weight, int i, const Quintic<T>& angle) {
    using std::abs;
    if (limit_.leaps_only && !leaps_over(curve, angle)) return;
    const T size = abs(weight);
    for_each_knot(curve, angle, [&](const T& knot, const T& turn, const T& bend, const T& twist) {
      offer_passage({Of::angle, i, knot, T(0)}, angle,
                    {i, T(0), size * turn, size * bend, size * twist});
    });
  }

  [[nodiscard]] static bool leaps_over(const Curve& curve, const Quintic<T>& u) {
    const ValueRange<T> way = hull(u);
    return detail::passes_knots_twice(curve, static_cast<double>(u.front()),
                                      static_cast<double>(u.back()), static_cast<double>(way.low),
                                      static_cast<double>(way.high));
  }

  /// Calls visit(knot, jump of the slope, of half the second derivative and of a sixth of the third) for the knots in
  /// the hull of u.
  template <class Visit>
  static void for_each_knot(const Curve& curve, const Quintic<T>& u, Visit&& visit) {
    using std::abs;
    T low = u[0], high = u[0];
    for (const T& c : u) low = smaller(low, c), high = larger(high, c);
    const std::vector<double>& knots = curve.knots();
    for (std::size_t k = 0; k < knots.size(); ++k) {
      const T knot(knots[k]);
      if (knot < low || knot > high) continue;
      const auto& before = curve.pieces()[k].c;
      const auto& after = curve.pieces()[k + 1].c;
      const double way = k > 0 ? knots[k] - knots[k - 1] : 0;
      const double slope = before[1] + way * (2 * before[2] + way * 3 * before[3]);
      const double half_bend = before[2] + way * 3 * before[3];
      visit(knot, T(abs(T(after[1] - slope))), T(abs(T(after[2] - half_bend))),
            T(abs(T(after[3] - before[3]))));
    }
  }

  void search_loop(int l) {
    const LoopTerms<T>& loop = system_.wing().loops[l];
    if (system_.is_locked(loop.first) && system_.is_locked(loop.second)) return;
    const bool only_jumps = limit_.leaps_only;
    if (only_jumps && !jumps(loop)) return;
    const Quintic<T> elastic = elastic_over_step(system_, step_, l);
    if (loop.table && !only_jumps) search_gear(loop, largest(elastic.front(), elastic.back()));
    if (!(bound(elastic) > loop.slack_beyond)) return;
    const T jump = jumps(loop) ? jump_of_loop(loop, elastic, step_.h) : T(0);
    const T turn(only_jumps ? 0 : 0.5);
    for (const T& at : {T(-loop.slack_beyond), loop.slack_beyond}) {
      offer_passage({Of::strands, l, at, T(0)}, elastic, {loop.second, jump, turn, T(0)});
      const T gear = largest_gear(loop);
      offer_passage({Of::strands, l, at, T(0)}, elastic,
                    {loop.first, gear * jump, gear * turn, T(0)});
    }
  }

  /// Knots of a loop's table: a monotone cubic, whose slope is continuous; the moment at hinge a is that slope times τ.
  /// @param elastic the largest |K e| at the step's ends
  void search_gear(const LoopTerms<T>& loop, const T& elastic) {
    const Layout& at = system_.layout();
    const Quintic<T> angle = step_.coordinate(at.angle(loop.first), at.freedoms());
    Quintic<T> travel = angle;
    for (T& c : travel) c = loop.sense_a * (c - loop.stowed_a);
    if (limit_.leaps_only && !leaps_over(*loop.table, travel)) return;
    for_each_knot(
        *loop.table, travel, [&](const T& knot, const T& turn, const T& bend, const T& /*twist*/) {
          const T angle_there = fused(loop.sense_a, knot, loop.stowed_a);
          const Kink<T> kink{Of::angle, loop.first, angle_there, T(0)};
          const T gear = largest_gear(loop);
          offer_passage(kink, angle,
                        {loop.first, turn * elastic,
                         fused(gear * loop.stiffness, turn, T(2) * bend * elastic),
                         gear * loop.stiffness * bend});
          offer_passage(kink, angle,
                        {loop.second, T(0), loop.stiffness * turn, loop.stiffness * bend});
        });
  }

  /// The ends of a latch's smooth steps h(u): h'' jumps there by 6. At S = 0 nothing is seen of it, for S rises from 0
  /// as the cube of time. Once S ≥ ε the latch does not depend on S any more.
  void search_smoothed_latch(int i) {
    const Layout& at = system_.layout();
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    const int k = at.latch(i);
    const T& epsilon = system_.epsilon();
    if (!(step_.x[k] < epsilon)) return;
    const T bend = T(3) / (epsilon * epsilon);
    const Quintic<T> angle = step_.coordinate(at.angle(i), at.freedoms());
    for (const T& beyond : {T(0), epsilon})
      offer_passage({Of::angle, i, fused(hinge.sense, beyond, hinge.latched), T(0)}, angle,
                    {i, T(0), T(0), bend, T(0), true});
    const Quintic<T> rate = step_.rate(at.angle(i), at.freedoms());
    offer_passage({Of::latch, i, epsilon, T(0)}, latch_state(system_, step_, i),
                  {i, T(0), T(0), bend * most_of_smoothed_latch(hinge, angle, rate)});
  }

  [[nodiscard]] static T largest(const T& a, const T& b) {
    using std::abs;
    return larger(T(abs(a)), T(abs(b)));
  }

  /// Offers the first passage of u over kink.at that matters.
  void offer_passage(Kink<T> kink, Quintic<T> u, const KinkChange<T>& change) {
    const T speed = bound(derivative(u, step_.h));
    for (T& c : u) c = c - kink.at;
    Quintic<T> rest = u;
    T from(0);
    for (int root = 0; root < 6; ++root) { // a quintic has five
      if (rest[0] == T(0)) rest = without_root_at_start(rest);
      const bool falls = rest[0] > T(0);
      if (falls)
        for (T& c : rest) c = -c;
      const std::optional<T> there = rest[0] < T(0) ? first_nonnegative(rest) : std::nullopt;
      if (!there) return;
      const T s = fused(T(1) - from, *there, from);
      if (first_ && !(s < first_->s)) return;
      if (!(s < T(1))) return;
      if (matters(s, speed, change)) {
        kink.way = falls ? T(-1) : T(1);
        first_ = Found{kink, s};
        return;
      }
      from = s;
      rest = part_of(u, s, T(1));
      rest[0] = T(0);
    }
  }

  /// (1).
  [[nodiscard]] bool matters(const T& s, const T& speed, const KinkChange<T>& change) const {
    using std::abs;
    const Layout& at = system_.layout();
    const int r = change.of_latch ? at.latch(change.hinge) : at.rate(change.hinge);
    const T mobility = change.of_latch ? T(1) : mobility_bound(system_, change.hinge);
    const T tau = limit_.refused ? step_.h : T(step_.h * smaller(s, T(T(1) - s)));
    const T way = speed * tau;
    const T third = counts_twists_ ? T(way * change.twist / T(4)) : T(0);
    const T impulse =
        tau * (change.jump + way * fused(T(0.5), change.turn, way * (change.bend / T(3) + third)));
    const T rate = larger(T(abs(step_.x[r])), T(abs(step_.x1[r])));
    return mobility * impulse > fused(T(limit_.rtol), rate, T(limit_.atol));
  }

  const AnySystem& system_;
  const Step<T>& step_;
  const KinkLimit limit_;
  bool counts_twists_ = false;
  std::optional<Found> first_;
};

} // namespace wingspread
