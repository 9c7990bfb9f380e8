/// How odeint computes with a state.
#pragma once

#include "core/number/scalar.hpp"

#include <cstddef>
#include <tuple>
#include <utility>

namespace wingspread {

/// odeint's algebra for contiguous states: one plain loop whatever the number of operands.
struct StateAlgebra {
  template <class Operation, class First, class... Rest>
  static void apply(Operation operation, First& first, Rest&... rest) {
    const std::size_t size = first.size();
    for (std::size_t k = 0; k < size; ++k) operation(first[k], rest[k]...);
  }
  // odeint passes the operation last
  template <class... Args> static void for_each2(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each3(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each4(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each5(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each6(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each7(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each8(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each9(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each10(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each11(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each12(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each13(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each14(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each15(Args&&... args) { operation_last(args...); }

  /// Largest |x|; NaN if any x is NaN. odeint's own norm_inf would ignore NaN.
  template <class S> [[nodiscard]] static typename S::value_type norm_inf(const S& x) {
    using std::abs;
    typename S::value_type largest(0), poison(0);
    for (const auto& v : x) largest = larger(largest, decltype(largest)(abs(v))), poison += v - v;
    return largest + poison;
  }

private:
  template <class... Args> static void operation_last(Args&... args) {
    const auto all = std::tie(args...);
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      apply(std::get<sizeof...(I)>(all), std::get<I>(all)...);
    }
    (std::make_index_sequence<sizeof...(Args) - 1>{});
  }
};

} // namespace wingspread
