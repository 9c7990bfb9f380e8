/// How odeint works on a state.
///
/// The explicit methods are odeint's. What is their own is the verdict: odeint accepts a step whose
/// error is NaN.
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
  template <class A, class B, class Op> static void for_each2(A& a, B& b, Op op) {
    apply(op, a, b);
  }
  template <class A, class B, class C, class Op> static void for_each3(A& a, B& b, C& c, Op op) {
    apply(op, a, b, c);
  }
  template <class A, class B, class C, class D, class Op>
  static void for_each4(A& a, B& b, C& c, D& d, Op op) {
    apply(op, a, b, c, d);
  }
  template <class A, class B, class C, class D, class E, class Op>
  static void for_each5(A& a, B& b, C& c, D& d, E& e, Op op) {
    apply(op, a, b, c, d, e);
  }
  template <class A, class B, class C, class D, class E, class F, class Op>
  static void for_each6(A& a, B& b, C& c, D& d, E& e, F& f, Op op) {
    apply(op, a, b, c, d, e, f);
  }
  template <class A, class B, class C, class D, class E, class F, class G, class Op>
  static void for_each7(A& a, B& b, C& c, D& d, E& e, F& f, G& g, Op op) {
    apply(op, a, b, c, d, e, f, g);
  }
  // the long formulas: operation last, as odeint calls them
  template <class... Args> static void for_each8(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each9(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each10(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each11(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each12(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each13(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each14(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each15(Args&&... args) { operation_last(args...); }

  /// Largest |x|; NaN when any is, unlike odeint's own.
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
