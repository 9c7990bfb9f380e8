/// The list of laws that a hinge may have beyond linear_law.hpp, regularized friction and smoothed latch.
///
///     M = w_s S(φ) + w_h H(φ) − σ f F(φ) + [damper acts] damper(φ̇) + [in contact] stop(φ, φ̇)
///         + [in contact] far stop(φ, φ̇) + [latch bears] dissipation(φ, φ̇)                       (1)
///
/// with spring and harness by tables (curve_torque.hpp), measured friction (friction.hpp), a damper (damper.hpp), a
/// stop (stop.hpp) at either side and a latch's dissipation (latch_laws.hpp). Three conditions are modes of the run:
/// whether the damper acts, a stop is in contact, and the latch bears. They change at events only, so inside a step
/// every law is smooth. Whether the latch engages and lets go: latch_laws.hpp.
///
/// The right-hand side sums the tables of a hinge to one polynomial between two knots (TablePiece).
///
/// To add a law: README.md.
#pragma once

#include "core/laws/curve_torque.hpp"
#include "core/laws/damper.hpp"
#include "core/laws/friction.hpp"
#include "core/laws/hinge_law.hpp"
#include "core/laws/latch_laws.hpp"
#include "core/laws/stop.hpp"
#include "core/scene/scene.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wingspread {

/// The modes of a real hinge. They change at events only.
template <class T> struct HingeMode {
  T in_contact;     ///< 1 while the stop is in contact, else 0
  T damper_acts;    ///< 1 or 0
  T sliding;        ///< σ of exact friction: −1, 0, 1
  T bears;          ///< side on which the engaged latch bears: −1, 1; 0: on none
  T in_far_contact; ///< 1 while the far stop is in contact, else 0
};

template <class T> struct RealHingeTerms {
  CurveTorqueTerms<T> spring, harness;
  MeasuredFrictionTerms<T> friction;
  bool has_damper, has_window, has_backlash;
  DamperTerms<T> damper;
  T window_low, window_high; ///< angles between which the damper acts, rad
  StopTerms<T> stop;
  T half_backlash; ///< β/2 of the latch, rad
  LatchDissipationTerms<T> dissipation;
  StopTerms<T> far_stop;
  CaptureTerms<T> capture;

  /// Whether the latch's law changes at the latched angle, or at the ends of its backlash.
  [[nodiscard]] bool has_latch_edge() const { return has_backlash || dissipation.present; }
  [[nodiscard]] bool has_tables() const { return spring.curve || harness.curve || friction.level; }
  /// Whether it has any law of (1).
  [[nodiscard]] bool has_law() const {
    return has_tables() || has_damper || stop.present || far_stop.present || dissipation.present;
  }
  /// Whether it has any edge (mechanics/edges.hpp).
  [[nodiscard]] bool has_edge() const {
    return stop.present || far_stop.present || capture.present || has_window || has_latch_edge();
  }
};

/// Calls visit(rate, acts, stop) for each rate at which the damper's law or a stop's has a kink. `acts`: whether the
/// law acts now, for a pack in which lanes. `stop`: null for the damper.
template <class T, class Visit>
void for_each_kink_of_rate(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                           Visit&& visit) {
  if (hinge.has_damper && hinge.damper.law == DamperLaw::power)
    for (const T& rate : {T(-hinge.damper.rate), hinge.damper.rate})
      visit(rate, mode.damper_acts > T(0), static_cast<const HingeStop<T>*>(nullptr));
  const auto offer = [&visit](const StopTerms<T>& terms, const T& in_contact) {
    if (!terms.present) return;
    const HingeStop<T> stop{terms, in_contact};
    visit(T(terms.sense / terms.dissipation), in_contact > T(0) && terms.dissipation > T(0), &stop);
  };
  offer(hinge.stop, mode.in_contact);
  offer(hinge.far_stop, mode.in_far_contact);
}

/// Calls visit(law) for each law of (1) that the hinge has and that has no table. A new law is a line here.
template <class T, class Visit>
void for_each_law_without_table(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                Visit&& visit) {
  const auto offer = [&visit](const HingeLaw<T> auto& law) { visit(law); };
  if (hinge.has_damper) offer(HingeDamper<T>{hinge.damper, mode.damper_acts});
  if (hinge.stop.present) offer(HingeStop<T>{hinge.stop, mode.in_contact});
  if (hinge.far_stop.present) offer(HingeStop<T>{hinge.far_stop, mode.in_far_contact});
  if (hinge.dissipation.present) offer(LatchDissipation<T>{hinge.dissipation, mode.bears});
}

/// Calls visit(law) for each law of (1) that the hinge has, in the order of (1).
template <class T, class Visit>
void for_each_law(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode, Visit&& visit) {
  const auto offer = [&visit](const HingeLaw<T> auto& law) { visit(law); };
  if (hinge.spring.curve) offer(CurveTorque<T>{hinge.spring});
  if (hinge.harness.curve) offer(CurveTorque<T>{hinge.harness});
  if (hinge.friction.level) offer(MeasuredFriction<T>{hinge.friction, mode.sliding});
  for_each_law_without_table(hinge, mode, visit);
}

/// Whether a hinge is real: it has a law of (1), or a latch that has backlash, may miss or may let go.
[[nodiscard]] inline bool is_real(const Hinge& hinge) {
  return hinge.spring.table || hinge.harness.table || hinge.damper || hinge.stop ||
         hinge.far_stop ||
         (hinge.latch &&
          (hinge.latch->backlash > 0 || hinge.latch->dissipation || hinge.latch->can_miss()));
}

/// The tables of a hinge between two neighbouring knots, as polynomials of u = φ − origin. The workspace keeps the
/// piece of the last evaluation, because the next angle mostly lies in it too.
template <class T> struct TablePiece {
  T low, high;            ///< it holds for low ≤ φ < high, rad
  T origin;               ///< rad
  std::array<T, 4> drive; ///< coefficients of w_s S + w_h H, N·m/radᵏ
  std::array<T, 4> level; ///< coefficients of f F, N·m/radᵏ
};

/// A piece that holds for no angle.
template <class T> [[nodiscard]] TablePiece<T> no_table_piece() {
  const T none(0);
  return {none, none, none, {none, none, none, none}, {none, none, none, none}};
}

namespace detail {

/// A table of a hinge and its factor in (1).
template <class T> struct WeightedCurve {
  const Curve* curve; ///< null: none
  T weight;
};

/// Adds a curve's piece k to a polynomial about `origin`.
template <class T>
void add_piece(std::array<T, 4>& sum, const WeightedCurve<T>& table, std::size_t k,
               const T& origin) {
  const std::array<double, 4>& c = table.curve->pieces()[k].c;
  const T d = origin - T(knot_of(*table.curve, k));
  const T third = T(3) * T(c[3]);
  const T value = fused(d, fused(d, fused(d, T(c[3]), T(c[2])), T(c[1])), T(c[0]));
  const T slope = fused(d, fused(d, third, T(2) * T(c[2])), T(c[1]));
  sum[0] = fused(table.weight, value, sum[0]);
  sum[1] = fused(table.weight, slope, sum[1]);
  sum[2] = fused(table.weight, fused(d, third, T(c[2])), sum[2]);
  sum[3] = fused(table.weight, T(c[3]), sum[3]);
}

/// The piece of a hinge's tables at an angle. @param tables spring, harness, friction
template <class T>
[[nodiscard]] TablePiece<T> table_piece(const std::array<WeightedCurve<T>, 3>& tables,
                                        const T& angle) {
  constexpr double far = 1e300;
  TablePiece<T> piece = no_table_piece<T>();
  piece.low = T(-far), piece.high = T(far);
  std::array<std::size_t, 3> numbers{};
  for (std::size_t t = 0; t < tables.size(); ++t) {
    if (!tables[t].curve) continue;
    const std::vector<double>& knots = tables[t].curve->knots();
    const std::size_t k = numbers[t] = piece_number(*tables[t].curve, angle);
    if (k > 0) piece.low = larger(piece.low, T(knots[k - 1]));
    if (k < knots.size()) piece.high = smaller(piece.high, T(knots[k]));
  }
  piece.origin = piece.low > T(-far) ? piece.low : piece.high;
  for (std::size_t t = 0; t < tables.size(); ++t)
    if (tables[t].curve)
      add_piece(t < 2 ? piece.drive : piece.level, tables[t], numbers[t], piece.origin);
  return piece;
}

/// Sets the piece at an angle; of packs in the lanes `these`. Not inlined, because knots are passed rarely.
template <class T>
[[gnu::noinline]] void find_table_piece(TablePiece<T>& piece, const RealHingeTerms<T>& hinge,
                                        const T& angle, [[maybe_unused]] const Truth<T>& these) {
  if constexpr (is_one_number<T>) {
    piece = table_piece<T>({{{hinge.spring.curve, hinge.spring.weight},
                             {hinge.harness.curve, hinge.harness.weight},
                             {hinge.friction.level, hinge.friction.weight}}},
                           angle);
  } else {
    for (int lane = 0; lane < T::width; ++lane) {
      const std::int64_t is_in = these.bits[lane];
      if (is_in == 0) continue;
      const TablePiece<double> found =
          table_piece<double>({{{hinge.spring.curve, hinge.spring.weight.v[lane]},
                                {hinge.harness.curve, hinge.harness.weight.v[lane]},
                                {hinge.friction.level, hinge.friction.weight.v[lane]}}},
                              angle.v[lane]);
      piece.low.v[lane] = found.low, piece.high.v[lane] = found.high;
      piece.origin.v[lane] = found.origin;
      for (std::size_t k = 0; k < 4; ++k) {
        piece.drive[k].v[lane] = found.drive[k];
        piece.level[k].v[lane] = found.level[k];
      }
    }
  }
}

template <class T> [[nodiscard]] T value_of_cubic(const std::array<T, 4>& c, const T& u) {
  return fused(u, fused(u, fused(u, c[3], c[2]), c[1]), c[0]);
}

} // namespace detail

/// Terms of (1) by tables, N·m. @param piece of this hinge and run, or no_table_piece; updated
template <class T>
[[nodiscard]] T tables_moment(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                              TablePiece<T>& piece, const T& angle, const T& rate) {
  const Truth<T> outside = !(piece.low <= angle && angle < piece.high);
  if (any(outside)) detail::find_table_piece(piece, hinge, angle, outside);
  const T u = angle - piece.origin;
  const T drive = detail::value_of_cubic(piece.drive, u);
  if (!hinge.friction.level) return drive;
  const MeasuredFriction<T> friction{hinge.friction, mode.sliding};
  return drive - friction.sense(rate) * larger(detail::value_of_cubic(piece.level, u), T(0));
}

/// (1), N·m. @param piece as of tables_moment
template <class T>
[[nodiscard]] T real_moment(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                            TablePiece<T>& piece, const T& angle, const T& rate) {
  T m = hinge.has_tables() ? tables_moment(hinge, mode, piece, angle, rate) : T(0);
  for_each_law_without_table(hinge, mode, [&](const auto& law) { law.add_moment(m, angle, rate); });
  return m;
}

/// −∂M/∂φ and −∂M/∂φ̇ of (1).
template <class T>
[[nodiscard]] HingeResistance<T> real_resistance(const RealHingeTerms<T>& hinge,
                                                 const HingeMode<T>& mode, const T& angle,
                                                 const T& rate) {
  HingeResistance<T> r{T(0), T(0)};
  for_each_law(hinge, mode, [&](const auto& law) { law.add_resistance(r, angle, rate); });
  return r;
}

/// A range of (1) over ranges of angle and rate, N·m.
template <class T>
[[nodiscard]] ValueRange<T> real_range(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                       const ValueRange<T>& angle, const ValueRange<T>& rate) {
  ValueRange<T> range{T(0), T(0)};
  for_each_law(hinge, mode, [&](const auto& law) { law.add_range(range, angle, rate); });
  return range;
}

/// A range of dM/dt over ranges of angle, rate and acceleration, N·m/s; unknown where a law has no slopes.
template <class T>
[[nodiscard]] KnownRange<T> real_change(const RealHingeTerms<T>& hinge, const HingeMode<T>& mode,
                                        const ValueRange<T>& angle, const ValueRange<T>& rate,
                                        const ValueRange<T>& acceleration) {
  KnownRange<T> change;
  for_each_law(hinge, mode, [&](const auto& law) {
    if (any(change.known)) change.known = change.known && law.has_slopes(angle);
  });
  if (!any(change.known)) return change;
  MomentSlopes<T> slopes;
  for_each_law(hinge, mode, [&](const auto& law) { law.add_slopes(slopes, angle, rate); });
  change.add(slopes.change(rate, acceleration));
  return change;
}

/// Potential of the laws, zero at the latched angle, J.
template <class T>
[[nodiscard]] T real_potential(const RealHingeTerms<T>& hinge, const T& latched, const T& angle,
                               const HingeMode<T>& mode) {
  T P(0);
  for_each_law(hinge, mode, [&](const auto& law) { law.add_potential(P, latched, angle); });
  return P;
}

/// Moment of the springs and harnesses by tables, N·m.
template <class T> [[nodiscard]] T curves_moment(const RealHingeTerms<T>& hinge, const T& angle) {
  T m(0);
  for (const CurveTorqueTerms<T>* torque : {&hinge.spring, &hinge.harness})
    if (torque->curve) CurveTorque<T>{*torque}.add_moment(m, angle);
  return m;
}

/// A range of the stiffness −∂M/∂φ of the springs and harnesses by tables, over all angles, N·m/rad.
template <class T> [[nodiscard]] ValueRange<T> stiffness_of_curves(const RealHingeTerms<T>& hinge) {
  ValueRange<T> range{T(0), T(0)};
  for (const CurveTorqueTerms<T>* torque : {&hinge.spring, &hinge.harness})
    if (torque->curve) CurveTorque<T>{*torque}.add_stiffness_range(range);
  return range;
}

/// The same over a range of angles.
template <class T>
[[nodiscard]] ValueRange<T> stiffness_of_curves(const RealHingeTerms<T>& hinge,
                                                const ValueRange<T>& angle) {
  ValueRange<T> range{T(0), T(0)};
  for (const CurveTorqueTerms<T>* torque : {&hinge.spring, &hinge.harness})
    if (torque->curve)
      range = range + scaled(T(-torque->weight), range_of_slope(*torque->curve, angle));
  return range;
}

namespace detail {

template <class T> [[nodiscard]] T largest_value(const Curve& curve) {
  T most(0);
  for (std::size_t k = 0; k < curve.knots().size(); ++k)
    most = larger(most, T(curve.pieces()[k + 1].c[0]));
  return most + T(curve.overshoot());
}

template <class T> void set_curves(RealHingeTerms<T>& terms, const Hinge& hinge, const T& sense) {
  const auto curve = [](const HingeTorque& torque) -> const Curve* {
    return torque.table ? &torque.table->drive() : nullptr;
  };
  terms.spring = {curve(hinge.spring), sense * T(hinge.spring.scale)};
  terms.harness = {curve(hinge.harness), -sense * T(hinge.harness.scale)};
  MeasuredFrictionTerms<T>& friction = terms.friction;
  friction.weight = T(hinge.friction.scale);
  friction.slip_rate = T(hinge.friction.regularization_rate);
  friction.regularized = hinge.friction.model == FrictionModel::regularized;
  if (!hinge.spring.table || !hinge.spring.table->both_ways()) return;
  friction.level = &hinge.spring.table->friction();
  friction.most = friction.weight * largest_value<T>(*friction.level);
}

/// The angle, rad; but the hinge's stowed or latched angle if the two differ by the rounding of a unit only (90 deg has
/// 1e-16). So a damper's window that is written to end at the latched angle ends exactly there.
template <class T> [[nodiscard]] T without_rounding(const Hinge& hinge, double angle) {
  for (const double end : {hinge.stowed, hinge.latched})
    if (std::abs(angle - end) <= 1e-14) return T(end);
  return T(angle);
}

} // namespace detail

/// @param sense sign(φ_latched − φ_stowed)
template <class T>
[[nodiscard]] RealHingeTerms<T> real_hinge_terms(const Hinge& hinge, const T& sense) {
  RealHingeTerms<T> terms{};
  detail::set_curves(terms, hinge, sense);
  if (hinge.damper) {
    terms.has_damper = true;
    terms.damper = damper_terms<T>(*hinge.damper);
    terms.has_window = hinge.damper->window.has_value();
    if (const auto& window = hinge.damper->window) {
      const T from = detail::without_rounding<T>(hinge, (*window)[0]);
      const T to = detail::without_rounding<T>(hinge, (*window)[1]);
      terms.window_low = smaller(from, to), terms.window_high = larger(from, to);
    }
  }
  terms.stop.sense = sense, terms.far_stop.sense = -sense;
  if (hinge.stop)
    terms.stop = {true, sense, T(hinge.stop->stiffness), T(hinge.stop->dissipation),
                  fused(-sense, T(hinge.stop->gap), T(hinge.stowed))};
  if (hinge.far_stop)
    terms.far_stop = {true, -sense, T(hinge.far_stop->stiffness), T(hinge.far_stop->dissipation),
                      fused(sense, T(hinge.far_stop->gap), T(hinge.latched))};
  terms.has_backlash = hinge.latch && hinge.latch->backlash > 0;
  if (hinge.latch) terms.half_backlash = T(0.5) * T(hinge.latch->backlash);
  terms.dissipation = dissipation_terms<T>(hinge);
  terms.capture = capture_terms<T>(hinge, sense);
  return terms;
}

} // namespace wingspread
