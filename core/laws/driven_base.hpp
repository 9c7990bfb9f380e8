/// A base of prescribed motion: by constants, or by a table of time whose pieces are cubics.
///
/// | symbol  | meaning                                                  | unit          |
/// |---------|----------------------------------------------------------|---------------|
/// | u       | t − from                                                 | s             |
/// | a, α    | acceleration of its origin; angular: cubics in u         | m/s², rad/s²  |
/// | v, Ω, θ | velocity, rate, angle: exact integrals of these          | m/s, rad/s, rad |
///
/// The current piece is part of the run's state, as the modes of hinges are. It changes at a knot, where a step ends.
/// So the motion is smooth inside a step, and an evaluation needs no search for the piece.
#pragma once

#include "core/number/planar.hpp"
#include "core/number/quintic.hpp"
#include "core/scene/scene.hpp"

#include <array>
#include <iterator>

namespace wingspread {

inline constexpr double never = 1e300; ///< s

/// The latest release or end of a run that counts as reached at t, s: no step is short enough to end there. Instants a
/// rounding apart (0.1 s + 0.2 s is not 0.3 s) are one instant.
template <class T> [[nodiscard]] T reached_at(const T& t) {
  return t + T(T(8 * epsilon_of<T>) * t);
}
/// reached_at for the knots of tables, but at least 1 ps later: no wing has knots closer together.
template <class T> [[nodiscard]] T knots_reached_at(const T& t) {
  return larger(reached_at(t), T(t + T(1e-12)));
}

template <class T> struct DrivenPiece {
  int number;                     ///< of the table's pieces
  T from;                         ///< s
  T until;                        ///< the next knot, s; `never` after the last
  std::array<T, 4> x, y, turning; ///< a and α in powers of u
  Vec2<T> velocity;               ///< at `from`, m/s
  T rate, angle;                  ///< at `from`, rad/s and rad
};

/// c in powers of u + w instead of u.
template <class T> [[nodiscard]] std::array<T, 4> shifted(const std::array<T, 4>& c, const T& w) {
  return {fused(w, fused(w, fused(w, c[3], c[2]), c[1]), c[0]),
          fused(w, fused(w, T(3) * c[3], T(2) * c[2]), c[1]), fused(T(3) * c[3], w, c[2]), c[3]};
}

template <class T> [[nodiscard]] T cubic_at(const std::array<T, 4>& c, const T& u) {
  return fused(u, fused(u, fused(u, c[3], c[2]), c[1]), c[0]);
}
/// First derivative of the cubic, and below its second.
template <class T> [[nodiscard]] T cubic_slope(const std::array<T, 4>& c, const T& u) {
  return fused(u, fused(u, T(3) * c[3], T(2) * c[2]), c[1]);
}
template <class T> [[nodiscard]] T cubic_bend(const std::array<T, 4>& c, const T& u) {
  return fused(u, T(6) * c[3], T(2) * c[2]);
}
/// ∫ of the cubic from 0 to u.
template <class T> [[nodiscard]] T cubic_integral(const std::array<T, 4>& c, const T& u) {
  const T high = fused(u, T(0.25) * c[3], c[2] / T(3));
  return u * fused(u, fused(u, high, T(0.5) * c[1]), c[0]);
}
/// Double integral of the cubic: ∫ of cubic_integral from 0 to u.
template <class T> [[nodiscard]] T cubic_double_integral(const std::array<T, 4>& c, const T& u) {
  const T high = fused(u, c[3] / T(20), c[2] / T(12));
  return u * u * fused(u, fused(u, high, c[1] / T(6)), T(0.5) * c[0]);
}

template <class T> [[nodiscard]] Vec2<T> acceleration(const DrivenPiece<T>& base, const T& t) {
  const T u = t - base.from;
  return {cubic_at(base.x, u), cubic_at(base.y, u)};
}
template <class T> [[nodiscard]] Vec2<T> velocity(const DrivenPiece<T>& base, const T& t) {
  const T u = t - base.from;
  return base.velocity + Vec2<T>{cubic_integral(base.x, u), cubic_integral(base.y, u)};
}

/// How the base turns at t.
template <class T> struct Turning { T acceleration, rate, angle; };

template <class T> [[nodiscard]] Turning<T> turning(const DrivenPiece<T>& base, const T& t) {
  const T u = t - base.from;
  return {cubic_at(base.turning, u), base.rate + cubic_integral(base.turning, u),
          fused(u, base.rate, base.angle) + cubic_double_integral(base.turning, u)};
}

/// Upper bounds of |c|, |c'|, |c''| for u from 0 to h.
template <class T> struct CubicBounds { T value, first, second; };

template <class T>
[[nodiscard]] CubicBounds<T> cubic_bounds(const std::array<T, 4>& c, const T& h) {
  using std::abs;
  const T c1 = abs(c[1]), c2 = abs(c[2]), c3 = abs(c[3]);
  return {fused(h, fused(h, fused(h, c3, c2), c1), T(abs(c[0]))),
          fused(h, fused(h, T(3) * c3, T(2) * c2), c1), fused(T(6) * h, c3, T(2) * c2)};
}

/// Whether all accelerations are constant from this piece on.
template <class T> [[nodiscard]] bool accelerates_constantly(const DrivenPiece<T>& base) {
  bool constant = !(base.until < T(never));
  for (int power = 1; power < 4; ++power)
    constant =
        constant && base.x[power] == T(0) && base.y[power] == T(0) && base.turning[power] == T(0);
  return constant;
}

/// Whether the rate is constant too, so that only the angle changes.
template <class T> [[nodiscard]] bool is_steady(const DrivenPiece<T>& base) {
  return accelerates_constantly(base) && base.turning[0] == T(0);
}

template <class T> struct BaseTerms {
  BaseMotion motion;
  Vec2<T> acceleration;   ///< prescribed, m/s²
  Vec2<T> gravity;        ///< m/s²
  T angular_acceleration; ///< prescribed, rad/s²
  T angle, rate;          ///< at the start, rad, rad/s
  Vec2<T> position, velocity;
  const BaseTable* table; ///< replaces the constants of the quantities it gives; null: none
  T table_scale;

  /// The acceleration that the wing feels where it is constant, m/s².
  [[nodiscard]] Vec2<T> felt() const { return acceleration - gravity; }
};

namespace detail {

/// The motion by the constants alone, in powers of t − from.
template <class T>
[[nodiscard]] DrivenPiece<T> constant_piece(const BaseTerms<T>& base, const T& from) {
  const T &a = base.angular_acceleration, none(0);
  return {0,
          from,
          T(never),
          {base.acceleration.x, none, none, none},
          {base.acceleration.y, none, none, none},
          {a, none, none, none},
          scaled(from, base.acceleration),
          fused(a, from, base.rate),
          fused(from, fused(T(0.5) * a, from, base.rate), base.angle)};
}

template <class T>
[[nodiscard]] std::array<T, 4> scaled(const T& by, const std::array<double, 4>& c) {
  return {by * T(c[0]), by * T(c[1]), by * T(c[2]), by * T(c[3])};
}

} // namespace detail

/// A piece of the base's table times its scale; quantities that the table does not give follow the constants.
template <class T> [[nodiscard]] DrivenPiece<T> driven_piece(const BaseTerms<T>& base, int number) {
  const BaseTable& table = *base.table;
  const BaseTable::Piece& given = table.pieces()[number];
  const T& scale = base.table_scale;
  DrivenPiece<T> piece = detail::constant_piece(base, T(given.from));
  piece.number = number;
  if (number + 1 < std::ssize(table.pieces())) piece.until = T(table.pieces()[number + 1].from);
  if (table.gives_acceleration()) {
    piece.x = detail::scaled(scale, given.x), piece.y = detail::scaled(scale, given.y);
    piece.velocity = {scale * T(given.velocity.x()), scale * T(given.velocity.y())};
  }
  if (!table.gives_turning()) return piece;
  piece.turning = detail::scaled(scale, given.turning);
  const T before = table.gives_rate() ? T(0) : base.rate; // the table's rates add to this one
  piece.rate = fused(scale, T(given.rate), before);
  piece.angle = fused(scale, T(given.angle), fused(before, piece.from, base.angle));
  return piece;
}

/// Index of the piece that holds t, by knots_reached_at.
/// @param before index of an earlier time's piece, where the search starts
template <class T>
[[nodiscard]] int number_of_piece(const BaseTable& table, const T& t, int before = 0) {
  const T reached = knots_reached_at(t);
  int k = before;
  while (k + 1 < std::ssize(table.pieces()) && T(table.pieces()[k + 1].from) <= reached) ++k;
  return k;
}

/// The piece at t = 0.
template <class T> [[nodiscard]] DrivenPiece<T> first_piece(const BaseTerms<T>& base) {
  return driven_piece(base, number_of_piece(*base.table, T(0)));
}

/// Sets `piece` to the one at t. @return whether it changed @pre the base has a table
template <class T> bool enter_piece(const BaseTerms<T>& base, const T& t, DrivenPiece<T>& piece) {
  const int before = piece.number, number = number_of_piece(*base.table, t, before);
  if (number != before) piece = driven_piece(base, number);
  return number != before;
}

/// Motion of a prescribed base at one instant.
template <class T> struct Drive {
  Vec2<T> felt; ///< acceleration that the wing feels, m/s²
  T angular_acceleration, rate, angle;
};

/// @param piece the one at t; unused without a table
template <class T>
[[nodiscard, gnu::always_inline]] inline Drive<T>
drive_at(const BaseTerms<T>& given, const DrivenPiece<T>& piece, const T& t) {
  if (given.table) {
    const Turning<T> turns = turning(piece, t);
    return {acceleration(piece, t) - given.gravity, turns.acceleration, turns.rate, turns.angle};
  }
  return {given.felt(), given.angular_acceleration,
          fused(given.angular_acceleration, t, given.rate),
          fused(t, fused(T(0.5) * given.angular_acceleration, t, given.rate), given.angle)};
}

/// Whether all accelerations, also the angular one, are constant from this piece on.
template <class T>
[[nodiscard]] bool accelerates_constantly(const BaseTerms<T>& base, const DrivenPiece<T>& piece) {
  return !base.table || accelerates_constantly(piece);
}

/// Whether the accelerations are constant and the rate of turn is constant from this piece on.
template <class T>
[[nodiscard]] bool is_steady(const BaseTerms<T>& base, const DrivenPiece<T>& piece) {
  return base.table ? is_steady(piece) : base.angular_acceleration == T(0);
}

/// The angle of a prescribed base over a step from t to t + h, less the angle at t; exact.
/// @param piece the step's; unused without a table
template <class T>
[[nodiscard]] Quintic<T> turn_of_base(const BaseTerms<T>& base, const DrivenPiece<T>& piece,
                                      const T& t, const T& h) {
  if (base.table) {
    const T u = t - piece.from, rate = piece.rate + cubic_integral(piece.turning, u);
    const std::array<T, 4> c = shifted(piece.turning, u);
    const T turned = fused(h, rate, cubic_double_integral(c, h));
    return hermite<T>(h, {T(0), rate, c[0]}, {turned, rate + cubic_integral(c, h), cubic_at(c, h)});
  }
  const T& second = base.angular_acceleration;
  const T first = fused(second, t, base.rate), last = fused(second, h, first);
  const T turned = h * fused(T(0.5) * h, second, first);
  return hermite<T>(h, {T(0), first, second}, {turned, last, second});
}

/// Upper bounds over a step of the acceleration that the wing on a prescribed base feels, and of its first two
/// derivatives.
template <class T>
[[nodiscard]] CubicBounds<T> push_of_base(const BaseTerms<T>& base, const DrivenPiece<T>& piece,
                                          const T& t, const T& h) {
  using std::sqrt;
  const auto length = [](const T& x, const T& y) { return T(sqrt(fused(x, x, y * y))); };
  if (!base.table) return {length(base.felt().x, base.felt().y), T(0), T(0)};
  std::array<T, 4> x = shifted(piece.x, T(t - piece.from));
  std::array<T, 4> y = shifted(piece.y, T(t - piece.from));
  x[0] = x[0] - base.gravity.x, y[0] = y[0] - base.gravity.y;
  const CubicBounds<T> a = cubic_bounds(x, h), b = cubic_bounds(y, h);
  return {length(a.value, b.value), length(a.first, b.first), length(a.second, b.second)};
}

} // namespace wingspread
