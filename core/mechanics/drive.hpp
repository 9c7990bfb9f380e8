/// How a base of prescribed motion moves: by constants, by a table of time, or some of either.
#pragma once

#include "core/laws/driven_base.hpp"
#include "core/mechanics/wing.hpp"

#include <iterator>
#include <limits>

namespace wingspread {

namespace detail {

/// What the base's constants do alone, with powers about `from`.
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

/// A piece of the base's table, times its scale; by the constants what the table does not give.
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
  const T before = table.gives_rate() ? T(0) : base.rate; // what the table adds to
  piece.rate = fused(scale, T(given.rate), before);
  piece.angle = fused(scale, T(given.angle), fused(before, piece.from, base.angle));
  return piece;
}

/// The number of the piece that begins at t or holds it, sought from that of an earlier time on. A
/// knot so near that no step could be made to it counts as reached.
template <class T>
[[nodiscard]] int number_of_piece(const BaseTable& table, const T& t, int before = 0) {
  const T epsilon =
      std::numeric_limits<T>::epsilon(); // a quad's is none of the compiler's constants
  const T reached = t + larger(T(T(8) * epsilon * t), T(1e-12));
  int k = before;
  while (k + 1 < std::ssize(table.pieces()) && T(table.pieces()[k + 1].from) <= reached) ++k;
  return k;
}

/// The piece in which a run begins.
template <class T> [[nodiscard]] DrivenPiece<T> first_piece(const BaseTerms<T>& base) {
  return driven_piece(base, number_of_piece(*base.table, T(0)));
}

/// A run of a base with a table stands at t. @return whether its motion goes on by another piece
template <class T> bool enter_piece(const BaseTerms<T>& base, const T& t, DrivenPiece<T>& piece) {
  const int before = piece.number, number = number_of_piece(*base.table, t, before);
  if (number != before) piece = driven_piece(base, number);
  return number != before;
}

/// Of a base of prescribed motion, at an instant.
template <class T> struct Drive {
  Vec2<T> felt; ///< acceleration that the wing feels, m/s²
  T angular_acceleration, rate, angle;
};

/// @param piece at t, of a base with a table
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

/// Whether its accelerations stay as they are from this piece on, and it turns at a constant rate.
template <class T>
[[nodiscard]] bool is_steady(const BaseTerms<T>& base, const DrivenPiece<T>& piece) {
  return base.table ? is_steady(piece) : base.angular_acceleration == T(0);
}

} // namespace wingspread
