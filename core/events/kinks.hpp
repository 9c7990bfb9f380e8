/// Kinks: where a law bends or jumps inside its domain, and no event changes the law. A strand of a loop goes slack, a
/// hinge passes a knot of a table, a damper's power law its regularization rate, a stop the rate at which it lets go, a
/// motor its torque limit, a smoothed latch the ends of its smooth steps.
///
/// Estimates of extrapolation, of implicit methods and of Fehlberg's formula expect a smooth right-hand side: they may
/// accept a step over a kink and be wrong by a thousand tolerances. Their steps therefore end at the kinks that matter.
/// So do all methods' steps at the limits of motors, where loads have their peaks, and where a step may leap over a
/// range of angles with no stage there: a loop damps between the angles at which its strands go slack twice as much as
/// outside, and a table may be steep between two knots.
///
/// Let the law's change across the kink be jump + turn·abs(u − b) + bend·(u − b)². A step that meets the kink at the
/// time τ from its nearer end differs from one under the smooth law, by the impulse of that change:
///
///     Δφ̇ ≤ σ (jump τ + turn abs(u̇) τ²/2 + bend u̇² τ³/3),    σ ≥ (M⁻¹)_ii                           (1)
///
/// (mobility_bound). Where (1) is below the tolerance of a step, the kink does not matter. The same holds of Ṡ, the
/// rate of a smoothed latch's own state, with σ = 1.
///
/// At a knot of a table the third derivative jumps too: twist·abs(u − b)³ adds σ abs(u̇)³ twist τ⁴/4 to (1). This term
/// counts only in a step that an explicit method has refused, because the jump may be the cause.
#pragma once

#include "core/dense/step.hpp"
#include "core/events/instant.hpp"
#include "core/laws/smoothed_latch.hpp"
#include "core/mechanics/linear_solve.hpp"

namespace wingspread {

/// Tolerance of a step, by which kinks matter.
struct KinkLimit {
  double rtol, atol;
  /// Only the kinks that end the steps of all methods: limits of motors, and ranges of angles that a step may leap
  /// over.
  bool leaps_only = false;
  /// The step is refused. Hinges' own kinks do not count then, and the impulse (1) is that over the whole step: the
  /// last stage may lie on either side of the kink.
  bool refused = false;
};

/// A function u of the state and its value b at a kink.
template <class T> struct Kink {
  enum class Of : signed char {
    angle,   ///< of hinge `index`
    rate,    ///< of hinge `index`
    excess,  ///< of the rate that the motor of hinge `index` commands, over the hinge's
    strands, ///< K e of loop `index`
    latch    ///< S of the smoothed latch of hinge `index`
  };
  Of of;
  int index;
  T at;
  T way; ///< in which u passes b: −1 or 1
};

/// The change of a law across a kink, as in (1), at a hinge.
template <class T> struct KinkChange {
  int hinge;
  T jump, turn, bend;
  T twist = T(0);        ///< counts in first_of_hinges alone
  bool of_latch = false; ///< of Ṡ of the hinge's smoothed latch, not of the moment
};

/// u, u̇ and ü; of a rate, ü is unknown, 0. @param x, dxdt the state at t and its derivative
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
  if (kink.of == Kink<T>::Of::latch)
    return {x[at.latch(kink.index)], dxdt[at.latch(kink.index)],
            engagement_acceleration(system.wing().hinges[kink.index], x[at.angle(kink.index)],
                                    x[at.rate(kink.index)], system.epsilon())};
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

/// Moves K e of a kink of strands on by so much, N·m.
template <class T, class AnySystem>
void move_strands(const AnySystem& system, const Kink<T>& kink, const T& by, State<T>& x) {
  const LoopTerms<T>& loop = system.wing().loops[kink.index];
  const T way = kink.way * by / loop.stiffness; // of e
  const T gear = system.state_of(loop, x).gear;
  if (!system.is_locked(loop.second) || gear == T(0)) {
    T& angle = x[system.layout().angle(loop.second)];
    angle = angle - loop.sense_b * way;
  } else {
    T& angle = x[system.layout().angle(loop.first)];
    angle = angle + loop.sense_a * way / gear;
  }
}

/// Moves a state that stands just before a kink of strands to just beyond, by twice beyond_rounding. Strands of loops of
/// other hinges that reach a kink within an instant are moved beyond it too: else one of two mirrored loops would bear
/// alone for that time.
/// @param dxdt of the state at t
template <class T, class AnySystem>
void cross(const AnySystem& system, const Kink<T>& kink, const T& t, State<T>& x,
           const State<T>& dxdt) {
  using std::abs;
  move_strands(system, kink, T(T(2) * beyond_rounding(system, kink, x)), x);
  const std::vector<LoopTerms<T>>& loops = system.wing().loops;
  const LoopTerms<T>& due = loops[kink.index];
  for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
    if (joins(loops[l], due.first) || joins(loops[l], due.second) || !jumps(loops[l])) continue;
    for (const T& there : {T(-loops[l].slack_beyond), loops[l].slack_beyond}) {
      Kink<T> other{Kink<T>::Of::strands, l, there, T(1)};
      const Jet<T> u = argument(system, other, x, dxdt, t);
      if (u.first == T(0)) continue;
      other.way = u.first < T(0) ? T(-1) : T(1);
      const T past = other.way * (u.value - there), beyond = beyond_rounding(system, other, x);
      const T near = T(2) * beyond + one_instant_of_latches(t) * abs(u.first);
      if (past > -near && past < beyond) move_strands(system, other, T(beyond - past), x);
    }
  }
}

} // namespace wingspread
