/// A motor of a hinge: drives it at a commanded rate, by a gain, up to a torque.
///
/// | symbol  | meaning                                                             | unit      |
/// |---------|---------------------------------------------------------------------|-----------|
/// | w       | commanded rate: s r(t − t_release), a cubic in time                 | rad/s     |
/// | c, T    | gain; torque limit                                                  | N·m·s/rad, N·m |
/// | M_0, D  | the moment at φ̇ = 0; M − M_0                                        | N·m       |
///
///     M = clamp(c (w − φ̇), −T, T)                                                               (1)
///
/// from the hinge's release on. M falls as φ̇ rises, with a slope between −c and 0. While w is constant, the motor is
/// therefore a constant drive and a part that opposes the rate:
///
///     M = M_0 + D,    M_0 = clamp(c w, −T, T),    D φ̇ ≤ 0,    |D| ≤ min(c |φ̇|, T + |M_0|)       (2)
///
/// The current piece of w is part of the run's state. It changes at a knot of the rate's table, where a step ends.
#pragma once

#include "core/laws/driven_base.hpp"
#include "core/laws/hinge_law.hpp"
#include "core/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread {

template <class T> struct MotorTerms {
  bool present;
  const Curve* table; ///< r against the time since release; null: constant
  T rate;             ///< s r, or s times the table's scale
  T gain, limit;      ///< c, T
};

/// The command from one knot to the next.
template <class T> struct MotorPiece {
  int number;            ///< of the table's pieces
  T runs;                ///< 1 from the hinge's release on, 0 before it and without a motor
  T release;             ///< time of the hinge's release, s
  T from, until;         ///< start and end of this piece, s; `until` is `never` after the last knot
  std::array<T, 4> rate; ///< w in powers of t − from
  T now;                 ///< w at the last evaluation
};

/// The motor of a hinge that is held, or has none: no command and no moment.
template <class T> [[nodiscard]] MotorPiece<T> idle_motor() {
  return {0, T(0), T(0), T(0), T(never), {T(0), T(0), T(0), T(0)}, T(0)};
}

/// A piece of the command of a motor whose hinge was released at `release`.
template <class T>
[[nodiscard]] MotorPiece<T> motor_piece(const MotorTerms<T>& terms, const T& release, int number) {
  MotorPiece<T> piece = idle_motor<T>();
  piece.number = number, piece.runs = T(terms.present ? 1 : 0);
  piece.release = piece.from = release;
  piece.rate[0] = terms.rate;
  if (!terms.table) return piece;
  const std::vector<double>& knots = terms.table->knots();
  piece.from = release + T(knots[number > 0 ? number - 1 : 0]);
  if (number < std::ssize(knots)) piece.until = release + T(knots[number]);
  piece.rate = detail::scaled(terms.rate, terms.table->pieces()[number].c);
  return piece;
}

/// The command after the last knot.
template <class T> [[nodiscard]] MotorPiece<T> last_motor_piece(const MotorTerms<T>& terms) {
  return motor_piece(terms, T(0), terms.table ? static_cast<int>(terms.table->knots().size()) : 0);
}

/// Sets `piece` to the one at t, by knots_reached_at.
/// @return whether the piece changed
template <class T> bool enter_piece(const MotorTerms<T>& terms, const T& t, MotorPiece<T>& piece) {
  const int before = piece.number;
  const T reached = knots_reached_at(t);
  while (piece.runs > T(0) && piece.until <= reached)
    piece = motor_piece(terms, T(piece.release), piece.number + 1);
  return piece.number != before;
}

/// The motor of a hinge released at t. @pre terms.present
template <class T>
[[nodiscard]] MotorPiece<T> started_motor(const MotorTerms<T>& terms, const T& t) {
  MotorPiece<T> piece = motor_piece(terms, t, 0);
  (void)enter_piece(terms, t, piece);
  return piece;
}

/// w at t.
template <class T> [[nodiscard]] T commanded_rate(const MotorPiece<T>& piece, const T& t) {
  return cubic_at(piece.rate, T(t - piece.from));
}

/// w − φ̇ at t.
template <class T>
[[nodiscard]] T command_excess(const MotorPiece<T>& piece, const T& t, const T& rate) {
  return commanded_rate(piece, t) - rate;
}

/// Whether w is constant from this piece on.
template <class T> [[nodiscard]] bool is_steady(const MotorPiece<T>& piece) {
  return !(piece.until < T(never)) && piece.rate[1] == T(0) && piece.rate[2] == T(0) &&
         piece.rate[3] == T(0);
}

/// (1) by the excess of the command over the rate, w − φ̇, N·m.
template <class T>
[[nodiscard]] T motor_moment(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                             const T& excess) {
  return piece.runs * larger(smaller(T(terms.gain * excess), terms.limit), T(-terms.limit));
}

/// −∂M/∂φ̇, N·m·s/rad.
template <class T>
[[nodiscard]] T motor_damping(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                              const T& excess) {
  using std::abs;
  return select(terms.gain * abs(excess) < terms.limit, T(piece.runs * terms.gain), T(0));
}

/// dM/dt, N·m/s. @param rate, acceleration φ̇ and φ̈ at t
template <class T>
[[nodiscard]] T motor_moment_rate(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                                  const T& t, const T& rate, const T& acceleration) {
  return motor_damping(terms, piece, command_excess(piece, t, rate)) *
         (cubic_slope(piece.rate, T(t - piece.from)) - acceleration);
}

/// w − φ̇ over a step from t. @param rate φ̇ over the step
template <class T>
[[nodiscard]] Quintic<T> motor_excess(const MotorPiece<T>& piece, const T& t, const T& h,
                                      const Quintic<T>& rate) {
  const auto jet = [&](const T& u) -> Jet<T> {
    return {cubic_at(piece.rate, u), cubic_slope(piece.rate, u), cubic_bend(piece.rate, u)};
  };
  const T u = t - piece.from;
  Quintic<T> excess = hermite<T>(h, jet(u), jet(u + h)); // a cubic is its own interpolant
  for (int k = 0; k < 6; ++k) excess[k] = excess[k] - rate[k];
  return excess;
}

/// A range of (1) over a step, N·m.
template <class T>
[[nodiscard]] ValueRange<T> motor_range(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                                        const Quintic<T>& excess) {
  const ValueRange<T> over = hull(excess);
  return {motor_moment(terms, piece, over.low), motor_moment(terms, piece, over.high)};
}

/// The side of the torque limit on which the whole step lies: −1, 1; 0: within the limit; 2: not known to be on one
/// side. For packs: lane by lane.
template <class T>
[[nodiscard]] T motor_regime(const MotorTerms<T>& terms, const Quintic<T>& excess) {
  const ValueRange<T> over = scaled(terms.gain, hull(excess));
  const auto within = over.low >= -terms.limit && over.high <= terms.limit;
  const T beyond =
      select(over.low >= terms.limit, T(1), select(over.high <= -terms.limit, T(-1), T(2)));
  return select(within, T(0), beyond);
}

/// A range of dM/dt over a step of h, N·m/s.
template <class T>
[[nodiscard]] ValueRange<T> motor_change(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                                         const Quintic<T>& excess, const T& h) {
  const T regime = motor_regime(terms, excess);
  ValueRange<T> change = scaled(T(piece.runs * terms.gain), hull(derivative(excess, h)));
  const auto limited = !(regime == T(0)), always = limited && regime < T(2);
  change.low = select(always, T(0), select(limited, smaller(change.low, T(0)), change.low));
  change.high = select(always, T(0), select(limited, larger(change.high, T(0)), change.high));
  return change;
}

/// ∫ M φ̇ dt over the part a … b of a step of h on one side of the limit, J. Gauss's rule of five points: exact for the
/// dense output.
template <class T>
[[nodiscard]] T motor_work(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                           const Quintic<T>& excess, const Quintic<T>& rate, const T& h, const T& a,
                           const T& b) {
  constexpr std::array nodes{0.0, 0.53846931010568309104, 0.90617984593866399280};
  constexpr std::array weights{0.56888888888888888889, 0.47862867049936646804,
                               0.23692688505618908751};
  const T middle = T(0.5) * (a + b), half = T(0.5) * (b - a);
  const auto power = [&](const T& s) {
    return T(motor_moment(terms, piece, value(excess, s)) * value(rate, s));
  };
  T sum = T(weights[0]) * power(middle);
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const T off = T(nodes[k]) * half;
    sum = fused(T(weights[k]), T(power(T(middle - off)) + power(T(middle + off))), sum);
  }
  return half * h * sum;
}

/// ∫ M φ̇ dt over a whole step, J. Where the motor may reach or leave its limit, the step is cut into parts without
/// such a change. The part with the change is 2⁻²⁰ of the step: it neglects a kink of M, an error of the order 2⁻⁴⁰.
template <class T>
[[nodiscard]] T motor_work_by_parts(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                                    const Quintic<T>& excess, const Quintic<T>& rate, const T& h) {
  constexpr double finest = 0x1p-20;
  T work(0);
  for (T a(0), part(1); a < T(1); part = smaller(T(T(2) * part), T(T(1) - a))) {
    while (part > T(finest) && motor_regime(terms, part_of(excess, a, T(a + part))) == T(2))
      part = T(0.5) * part;
    const T b = a + part;
    work = work + motor_work(terms, piece, excess, rate, h, a, b);
    a = b;
  }
  return work;
}

/// M_0 of (2), N·m. @pre is_steady(piece)
template <class T>
[[nodiscard]] T motor_drive(const MotorTerms<T>& terms, const MotorPiece<T>& piece) {
  return motor_moment(terms, piece, piece.rate[0]);
}

/// Bound of |D| in (2), N·m. @param most bounds |φ̇|
template <class T>
[[nodiscard]] T most_braking(const MotorTerms<T>& terms, const MotorPiece<T>& piece,
                             const T& most) {
  using std::abs;
  return smaller(T(terms.gain * most), T(terms.limit + abs(motor_drive(terms, piece))));
}

/// (2) near rest: D = −taken φ̇ for |φ̇| ≤ until. There the motor reaches its limit, or leaves it.
struct MotorAtRest {
  double drive = 0;           ///< M_0, N·m
  double taken = 0;           ///< c if the motor at rest is within its limit, else 0, N·m·s/rad
  double until = 0, gain = 0; ///< rad/s; c
  double most = 0;            ///< bound of |D| if taken is 0, else infinite, N·m

  MotorAtRest() = default;
  /// @pre is_steady(piece)
  MotorAtRest(const MotorTerms<double>& terms, const MotorPiece<double>& piece)
      : gain(piece.runs * terms.gain), most(std::numeric_limits<double>::infinity()) {
    if (!(gain > 0)) return;
    drive = motor_drive(terms, piece);
    const double w = std::abs(piece.rate[0]), limit = terms.limit / terms.gain;
    until = std::abs(w - limit);
    if (w < limit)
      taken = gain;
    else
      most = 2 * terms.limit;
  }

  /// Bound of |D + taken φ̇| for |φ̇| up to v, N·m.
  [[nodiscard]] double beyond(double v) const {
    return v > until ? std::min(gain * (v - until), most) : 0;
  }
};

/// The motor of hinge i at rest; without effect if `pieces` is empty. @pre is_steady(pieces[i])
[[nodiscard]] inline MotorAtRest motor_at_rest(const std::vector<MotorTerms<double>>& terms,
                                               const std::vector<MotorPiece<double>>& pieces,
                                               int i) {
  return pieces.empty() ? MotorAtRest{} : MotorAtRest(terms[i], pieces[i]);
}

} // namespace wingspread
