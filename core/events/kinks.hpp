/// Kinks: where a law bends or jumps inside its domain, and no event changes the law. A strand of a loop goes slack, a
/// hinge passes a knot of a table, a damper's power law its regularization rate, a stop the rate at which it lets go, a
/// motor its torque limit.
///
/// Estimates of extrapolation, of implicit methods and of Fehlberg's formula expect a smooth right-hand side: they may
/// accept a step over a kink and be wrong by a thousand tolerances. Their steps therefore end at the kinks that matter. So
/// do all methods' steps at the limits of motors, where loads have their peaks, and where a step may leap over a range of
/// angles with no stage there: a loop damps between the angles at which its strands go slack twice as much as outside, and
/// a table may be steep between two knots.
///
/// Let the law's change across the kink be jump + turn·abs(u − b) + bend·(u − b)². A step that meets the kink at the
/// time τ from its nearer end differs from one under the smooth law, by the impulse of that change:
///
///     Δφ̇ ≤ σ (jump τ + turn abs(u̇) τ²/2 + bend u̇² τ³/3),    σ ≥ (M⁻¹)_ii                           (1)
///
/// (mobility_bound). Where (1) is below the tolerance of a step, the kink does not matter.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/linear_solve.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

namespace wingspread {

/// Tolerance of a step, by which kinks matter.
struct KinkLimit {
  double rtol, atol;
  bool leaps_only = false; ///< of methods that do not need smooth laws
  bool refused =
      false; ///< the step is refused: it is not known on which side of a kink its last stage was
};

/// A function u of the state and its value b at a kink.
template <class T> struct Kink {
  enum class Of : signed char {
    angle,  ///< of hinge `index`
    rate,   ///< of hinge `index`
    excess, ///< of the rate that the motor of hinge `index` commands, over the hinge's
    strands ///< K e of loop `index`
  };
  Of of;
  int index;
  T at;
  T way; ///< in which u passes b: −1 or 1
};

/// The change of a law across a kink, as in (1), at a hinge; and the steepest u̇ of the step.
template <class T> struct KinkChange {
  int hinge;
  T jump, turn, bend;
};

/// u, u̇ and ü; of a rate ü is unknown, 0. @param x, dxdt the state at t and its derivative
template <class T, class AnySystem>
[[nodiscard]] Jet<T> argument(const AnySystem& system, const Kink<T>& kink, const State<T>& x,
                              const State<T>& dxdt, const T& t) {
  const Layout& at = system.layout();
  if (kink.of == Kink<T>::Of::excess) {
    const MotorPiece<T>& motor = system.work().motors[kink.index];
    const T w = commanded_rate(motor, t), change = cubic_slope(motor.rate, T(t - motor.from));
    return {w - x[at.rate(kink.index)], change - dxdt[at.rate(kink.index)], T(0)};
  }
  if (kink.of == Kink<T>::Of::angle)
    return {x[at.angle(kink.index)], x[at.rate(kink.index)], dxdt[at.rate(kink.index)]};
  if (kink.of == Kink<T>::Of::rate)
    return {x[at.rate(kink.index)], dxdt[at.rate(kink.index)], T(0)};
  const LoopTerms<T>& loop = system.wing().loops[kink.index];
  const LoopState<T> state = system.state_of(loop, x);
  const T va = loop.sense_a * x[at.rate(loop.first)], vb = loop.sense_b * x[at.rate(loop.second)];
  const T aa = loop.sense_a * dxdt[at.rate(loop.first)];
  const T ab = loop.sense_b * dxdt[at.rate(loop.second)];
  T bend(0);
  if (loop.table) {
    const PieceAt<T> piece =
        piece_at(*loop.table, T(loop.sense_a * (x[at.angle(loop.first)] - loop.stowed_a)));
    bend = fused(T(6) * piece.c[3], piece.u, T(2) * piece.c[2]);
  }
  return {state.elastic, loop.stiffness * fused(state.gear, va, -vb),
          loop.stiffness * (fused(state.gear, aa, -ab) + bend * va * va)};
}

/// How far `argument` must be beyond the kink, for rounding not to leave it before.
template <class T, class AnySystem>
[[nodiscard]] T beyond_rounding(const AnySystem& system, const Kink<T>& kink, const State<T>& x) {
  using std::abs;
  const Layout& at = system.layout();
  T size = abs(kink.at);
  if (kink.of == Kink<T>::Of::strands) {
    const LoopTerms<T>& loop = system.wing().loops[kink.index];
    size = size + loop.stiffness * (abs(x[at.angle(loop.first)]) + abs(loop.stowed_a) +
                                    abs(x[at.angle(loop.second)]) + abs(loop.stowed_b));
  }
  if (kink.of == Kink<T>::Of::excess) size = size + T(2) * abs(x[at.rate(kink.index)]);
  return T(8 * epsilon_of<T>) * size;
}

/// Moves a state that stands just before a kink of strands to just beyond, by twice beyond_rounding.
template <class T, class AnySystem>
void cross(const AnySystem& system, const Kink<T>& kink, State<T>& x) {
  const LoopTerms<T>& loop = system.wing().loops[kink.index];
  const T way = kink.way * T(2) * beyond_rounding(system, kink, x) / loop.stiffness; // of e
  const T gear = system.state_of(loop, x).gear;
  if (!system.is_locked(loop.second) || gear == T(0)) {
    T& angle = x[system.layout().angle(loop.second)];
    angle = angle - loop.sense_b * way;
  } else {
    T& angle = x[system.layout().angle(loop.first)];
    angle = angle + loop.sense_a * way / gear;
  }
}

/// K e of a loop over a step, N·m; of a gear by table approximately.
template <class T, class AnySystem>
[[nodiscard]] Quintic<T> elastic_over_step(const AnySystem& system, const Step<T>& step, int l) {
  const Kink<T> taut{Kink<T>::Of::strands, l, T(0), T(0)};
  const Jet<T> start = argument(system, taut, step.x, step.dxdt, step.t),
               end = argument(system, taut, step.x1, step.dxdt1, T(step.t + step.h));
  return hermite<T>(step.h, start, end);
}

/// The largest jump of a loop's torque over a step in which it moves by `elastic`: half of D ė, N·m.
/// @pre jumps(loop)
template <class T>
[[nodiscard]] T jump_of_loop(const LoopTerms<T>& loop, const Quintic<T>& elastic, const T& h) {
  return T(0.5) * (loop.damping / loop.stiffness) * bound(derivative(elastic, h));
}

/// (1) for a jump alone, beyond the tolerance. @param tau s
template <class T, class AnySystem>
[[nodiscard]] Truth<T> jump_matters(const AnySystem& system, const Step<T>& step, int hinge,
                                    const T& jump, const T& tau, const T& rtol, const T& atol) {
  using std::abs;
  const int r = system.layout().rate(hinge);
  const T rate = larger(T(abs(step.x[r])), T(abs(step.x1[r])));
  return mobility_bound(system, hinge) * (tau * jump) > fused(rtol, rate, atol);
}

/// Whether a strand of any loop may go slack or taut inside a step, and its jump may matter: the first test of
/// KinkSearch. For a pack: in which lanes. Cost: about twenty operations a loop, and twenty more where it damps.
/// @param tau as in (1), the longest
template <class T, class AnySystem>
[[nodiscard]] Truth<T> moments_may_jump(const AnySystem& system, const Step<T>& step, const T& tau,
                                        const T& rtol, const T& atol) {
  Truth<T> found{};
  const std::vector<LoopTerms<T>>& loops = system.wing().loops;
  for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
    const LoopTerms<T>& loop = loops[l];
    if (!any(jumps(loop))) continue;
    const Quintic<T> elastic = elastic_over_step(system, step, l);
    Truth<T> passes{};
    for (const T& at : {T(-loop.slack_beyond), loop.slack_beyond})
      for (const T& c : elastic) passes = passes || !((c - at) * (elastic[0] - at) > T(0));
    passes = passes && jumps(loop);
    if (!any(passes)) continue;
    const T jump = jump_of_loop(loop, elastic, step.h);
    const T geared = largest_gear(loop) * jump;
    found = found || (passes && (jump_matters(system, step, loop.second, jump, tau, rtol, atol) ||
                                 jump_matters(system, step, loop.first, geared, tau, rtol, atol)));
  }
  return found;
}

namespace detail {

/// A number of a pack; of one number itself.
template <class T> [[nodiscard]] double number_in(const T& x, [[maybe_unused]] int lane) {
  if constexpr (is_one_number<T>)
    return static_cast<double>(x);
  else
    return x.v[lane];
}
template <class Mask> [[nodiscard]] bool is_set(const Mask& mask, [[maybe_unused]] int lane) {
  if constexpr (std::is_same_v<Mask, bool>) {
    return mask;
  } else {
    const std::int64_t bits = mask.bits[lane];
    return bits != 0;
  }
}
/// Sets the lanes in which a predicate holds.
template <class T, class Holds> void set_where(Truth<T>& mask, Holds&& holds) {
  if constexpr (is_one_number<T>)
    mask = mask || holds(0);
  else
    for (int lane = 0; lane < T::width; ++lane)
      if (holds(lane)) mask.bits[lane] = -1;
}

/// Whether a way passes two knots of a curve, or turns beyond one: the curve may rise and fall inside.
/// @param low, high bounds of the way
[[nodiscard]] inline bool passes_knots_twice(const Curve& curve, double from, double to, double low,
                                             double high) {
  const std::vector<double>& knots = curve.knots();
  const auto up_to = [&knots](double at) {
    return std::upper_bound(knots.begin(), knots.end(), at) - knots.begin();
  };
  const auto between = up_to(std::max(from, to)) - up_to(std::min(from, to));
  return between > 1 || up_to(high) - up_to(low) > between;
}

/// The same of any table of a hinge.
template <class T>
[[nodiscard]] bool passes_tables_twice(const RealHingeTerms<T>& hinge, double from, double to,
                                       double low, double high) {
  for (const Curve* curve : {hinge.spring.curve, hinge.harness.curve, hinge.friction.level})
    if (curve && passes_knots_twice(*curve, from, to, low, high)) return true;
  return false;
}

} // namespace detail

/// Whether a step may leap over what a table is between two knots: the first test of KinkSearch. For a pack: in which
/// lanes. @pre the system's last evaluation was near the step's end
template <class T, class AnySystem>
[[nodiscard]] Truth<T> may_leap_over_tables(const AnySystem& system, const Step<T>& step) {
  Truth<T> found{};
  const Layout& at = system.layout();
  for (int i = 1; i < static_cast<int>(system.wing().real.size()); ++i) {
    const RealHingeTerms<T>& hinge = system.wing().real[i];
    if (!hinge.has_tables()) continue;
    const ValueRange<T> way = hull(step.coordinate(at.angle(i), at.freedoms()));
    const TablePiece<T>& piece = system.work().pieces[i];
    const Truth<T> passes = !(way.low >= piece.low && way.high < piece.high);
    if (!any(passes)) continue;
    const T &from = step.x[at.angle(i)], &to = step.x1[at.angle(i)];
    detail::set_where<T>(found, [&](int lane) {
      return detail::is_set(passes, lane) &&
             detail::passes_tables_twice(hinge, detail::number_in(from, lane),
                                         detail::number_in(to, lane),
                                         detail::number_in(way.low, lane),
                                         detail::number_in(way.high, lane));
    });
  }
  return found;
}

/// The same of what a loop's table is between two knots.
template <class T, class AnySystem>
[[nodiscard]] Truth<T> may_leap_over_gears(const AnySystem& system, const Step<T>& step) {
  Truth<T> found{};
  const Layout& at = system.layout();
  for (const LoopTerms<T>& loop : system.wing().loops) {
    if (!loop.table) continue;
    const int k = at.angle(loop.first);
    const ValueRange<T> angle = hull(step.coordinate(k, at.freedoms()));
    const ValueRange<T> way = scaled(
        loop.sense_a, ValueRange<T>{angle.low - loop.stowed_a, angle.high - loop.stowed_a});
    const T from = loop.sense_a * (step.x[k] - loop.stowed_a);
    const T to = loop.sense_a * (step.x1[k] - loop.stowed_a);
    detail::set_where<T>(found, [&](int lane) {
      return detail::passes_knots_twice(*loop.table, detail::number_in(from, lane),
                                        detail::number_in(to, lane),
                                        detail::number_in(way.low, lane),
                                        detail::number_in(way.high, lane));
    });
  }
  return found;
}

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
    const int hinges = limit_.refused ? 0 : static_cast<int>(system_.wing().real.size());
    for (int i = 1; i < hinges; ++i)
      if (!system_.sticks(i)) search_hinge(i);
    const int motors = static_cast<int>(system_.wing().motors.size());
    for (int i = 1; i < motors; ++i)
      if (!system_.sticks(i) && system_.motor_runs(i)) search_motor(i);
    const int loops = static_cast<int>(system_.wing().loops.size());
    for (int l = 0; l < loops; ++l) search_loop(l);
    return first_;
  }

private:
  using Of = typename Kink<T>::Of;

  void search_hinge(int i) {
    const RealHingeTerms<T>& real = system_.wing().real[i];
    if (limit_.leaps_only && !real.has_tables()) return;
    const Layout& at = system_.layout();
    const Quintic<T> angle = step_.coordinate(at.angle(i), at.freedoms());
    for (const CurveTorqueTerms<T>* torque : {&real.spring, &real.harness})
      if (torque->curve) search_knots(*torque->curve, torque->weight, i, angle);
    if (real.friction.level) search_knots(*real.friction.level, real.friction.weight, i, angle);
    if (!limit_.leaps_only) search_rates(i, step_.rate_of(angle, at.angle(i), at.freedoms()));
  }

  void search_rates(int i, const Quintic<T>& rate) {
    using std::abs;
    const RealHingeTerms<T>& real = system_.wing().real[i];
    const HingeMode<T>& mode = system_.work().modes[i];
    if (real.has_damper && real.damper.law == DamperLaw::power && mode.damper_acts > T(0)) {
      const T turn = abs(T(1) - real.damper.exponent) * real.damper.near_zero;
      for (const T& at : {T(-real.damper.rate), T(real.damper.rate)})
        offer_passage({Of::rate, i, at, T(0)}, rate, {i, T(0), turn, T(0)});
    }
    search_stop(i, rate, real.stop, mode.in_contact);
    search_stop(i, rate, real.far_stop, mode.in_far_contact);
  }

  void search_stop(int i, const Quintic<T>& rate, const StopTerms<T>& terms, const T& in_contact) {
    if (!(in_contact > T(0) && terms.dissipation > T(0))) return;
    const HingeStop<T> stop{terms, in_contact};
    const T depth = larger(stop.depth(step_.x[system_.layout().angle(i)]),
                           stop.depth(step_.x1[system_.layout().angle(i)]));
    const T turn = terms.stiffness * terms.dissipation * larger(depth, T(0));
    offer_passage({Of::rate, i, T(terms.sense / terms.dissipation), T(0)}, rate,
                  {i, T(0), turn, T(0)});
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
    for_each_knot(curve, angle, [&](const T& knot, const T& turn, const T& bend) {
      offer_passage({Of::angle, i, knot, T(0)}, angle,
                    {i, T(0), abs(weight) * turn, abs(weight) * bend});
    });
  }

  [[nodiscard]] static bool leaps_over(const Curve& curve, const Quintic<T>& u) {
    const ValueRange<T> way = hull(u);
    return detail::passes_knots_twice(
        curve, static_cast<double>(u.front()), static_cast<double>(u.back()),
        static_cast<double>(way.low), static_cast<double>(way.high));
  }

  /// Calls visit(knot, jump of the slope, jump of half the second derivative) for the knots in the hull of u.
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
      visit(knot, T(abs(T(after[1] - slope))), T(abs(T(after[2] - half_bend))));
    }
  }

  void search_loop(int l) {
    const LoopTerms<T>& loop = system_.wing().loops[l];
    if (system_.sticks(loop.first) && system_.sticks(loop.second)) return;
    const bool only_jumps = limit_.leaps_only;
    if (only_jumps && !jumps(loop)) return;
    const Quintic<T> elastic = elastic_over_step(system_, step_, l);
    if (loop.table && !only_jumps) search_gear(loop, largest(elastic.front(), elastic.back()));
    if (!(bound(elastic) > loop.slack_beyond) || (limit_.leaps_only && !jumps(loop))) return;
    const T jump = jumps(loop) ? jump_of_loop(loop, elastic, step_.h) : T(0);
    const T turn(limit_.leaps_only ? 0 : 0.5);
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
    for_each_knot(*loop.table, travel, [&](const T& knot, const T& turn, const T& bend) {
      const T angle_there = fused(loop.sense_a, knot, loop.stowed_a);
      const Kink<T> kink{Of::angle, loop.first, angle_there, T(0)};
      const T gear = largest_gear(loop);
      offer_passage(kink, angle,
                    {loop.first, turn * elastic,
                     fused(gear * loop.stiffness, turn, T(2) * bend * elastic),
                     gear * loop.stiffness * bend});
      offer_passage(kink, angle, {loop.second, T(0), loop.stiffness * turn, loop.stiffness * bend});
    });
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
    const int r = system_.layout().rate(change.hinge);
    const T tau = limit_.refused ? step_.h : T(step_.h * smaller(s, T(T(1) - s)));
    const T way = speed * tau;
    const T impulse =
        tau * (change.jump + way * fused(T(0.5), change.turn, way * change.bend / T(3)));
    const T rate = larger(T(abs(step_.x[r])), T(abs(step_.x1[r])));
    return mobility_bound(system_, change.hinge) * impulse >
           fused(T(limit_.rtol), rate, T(limit_.atol));
  }

  const AnySystem& system_;
  const Step<T>& step_;
  const KinkLimit limit_;
  std::optional<Found> first_;
};

} // namespace wingspread
