/// When two events are one.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// How far apart two instants about t may be and still be one, s.
template <class T> [[nodiscard]] T one_instant(const T& t) { return T(4096 * epsilon_of<T>) * t; }

} // namespace wingspread
