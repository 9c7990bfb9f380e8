/// When two events count as simultaneous.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// Largest time between simultaneous events about t, s: 4096 ε t. Heuristic: rounding separates the events of mirrored
/// wings by less; a smaller value separates their latches, a larger one merges events that have an order.
template <class T> [[nodiscard]] T one_instant(const T& t) { return T(4096 * epsilon_of<T>) * t; }

} // namespace wingspread
