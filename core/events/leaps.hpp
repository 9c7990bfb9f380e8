/// Ranges of angles that a step of an explicit method may leap over with no stage inside (kinks.hpp): the range in
/// which both strands of a damped loop are taut, and the range between two knots of a table. These tests come before
/// KinkSearch (kink_search.hpp), for one number and for packs. They may exclude a kink, and never find one.
#pragma once

#include "core/events/kinks.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace wingspread {

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

/// The number in a lane of a pack; a single number itself.
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

/// Whether a step may leap over a piece of a hinge's table between two knots: the first test of KinkSearch. For a pack:
/// in which lanes. @pre the system's last evaluation was near the step's end
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
             detail::passes_tables_twice(
                 hinge, detail::number_in(from, lane), detail::number_in(to, lane),
                 detail::number_in(way.low, lane), detail::number_in(way.high, lane));
    });
  }
  return found;
}

/// Whether a hinge may meet a kink of its own laws inside a step: the first test of KinkSearch::first_of_hinges. For a
/// pack: in which lanes. @pre as of may_leap_over_tables
template <class T, class AnySystem>
[[nodiscard]] Truth<T> may_meet_kink(const AnySystem& system, const Step<T>& step) {
  Truth<T> found{};
  const Layout& at = system.layout();
  for (int i = 1; i < static_cast<int>(system.wing().real.size()); ++i) {
    const RealHingeTerms<T>& hinge = system.wing().real[i];
    if (hinge.has_tables()) {
      const ValueRange<T> way = hull(step.coordinate(at.angle(i), at.freedoms()));
      const TablePiece<T>& piece = system.work().pieces[i];
      found = found || !(way.low >= piece.low && way.high < piece.high);
    }
    for_each_kink_of_rate(hinge, system.work().modes[i],
                          [&](const T& there, const Truth<T>& acts, const HingeStop<T>* /*stop*/) {
                            if (!any(acts)) return;
                            const ValueRange<T> rate = hull(step.rate(at.angle(i), at.freedoms()));
                            found = found || (acts && !(rate.low > there) && !(rate.high < there));
                          });
  }
  return found;
}

/// Whether a step may leap over a piece of a loop's table between two knots. For a pack: in which lanes.
template <class T, class AnySystem>
[[nodiscard]] Truth<T> may_leap_over_gears(const AnySystem& system, const Step<T>& step) {
  Truth<T> found{};
  const Layout& at = system.layout();
  for (const LoopTerms<T>& loop : system.wing().loops) {
    if (!loop.table) continue;
    const int k = at.angle(loop.first);
    const ValueRange<T> angle = hull(step.coordinate(k, at.freedoms()));
    const ValueRange<T> way =
        scaled(loop.sense_a, ValueRange<T>{angle.low - loop.stowed_a, angle.high - loop.stowed_a});
    const T from = loop.sense_a * (step.x[k] - loop.stowed_a);
    const T to = loop.sense_a * (step.x1[k] - loop.stowed_a);
    detail::set_where<T>(found, [&](int lane) {
      return detail::passes_knots_twice(
          *loop.table, detail::number_in(from, lane), detail::number_in(to, lane),
          detail::number_in(way.low, lane), detail::number_in(way.high, lane));
    });
  }
  return found;
}

} // namespace wingspread
