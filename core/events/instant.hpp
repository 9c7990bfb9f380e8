/// When two events count as simultaneous.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// Largest time between simultaneous events about t, s: 4096 ε t. Heuristic: rounding separates the events of mirrored
/// wings by less; a smaller value separates their latches, a larger one merges events that have an order.
template <class T> [[nodiscard]] T one_instant(const T& t) { return T(4096 * epsilon_of<T>) * t; }

/// The same for latches; and, beside a due event of their kind, for edges, rests, latches that let go and slack strands.
/// Heuristic: extrapolation (seulex, bulirsch_stoer) subtracts large numbers, and its rounding separates the latches of
/// mirrored wings by up to 1e-10 t. Between them one latch would bear what two share: a peak force of 142 N for 134 N. A
/// larger value moves a latch that is really the later one.
template <class T> [[nodiscard]] T one_instant_of_latches(const T& t) {
  return T(1024 * 1024 * epsilon_of<T>) * t;
}

} // namespace wingspread
