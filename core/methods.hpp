/// Integration methods behind one interface: a method takes a step and estimates its error;
/// deciding on it (step_control.hpp), events and peaks (integrator.hpp) are common to all.
///
/// A method has `order` of the solution carried on, `error_order` of the estimate, and
///
///     step(system, x, dxdt, t, h, x1, dxdt1, error)
///
/// from (x, dxdt) at t to (x1, dxdt1) at t + h, with the estimated error of x1 in each component.
#pragma once

#include "core/system.hpp"

#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <cstddef>
#include <functional>

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
};

/// Dormand and Prince's explicit Runge-Kutta pair of order 5(4), odeint's; first same as last.
template <class T> class DormandPrince5 {
public:
  static constexpr int order = 5;
  static constexpr int error_order = 4;

  template <class System>
  void step(System& system, const State<T>& x, const State<T>& dxdt, const T& t, const T& h,
            State<T>& x1, State<T>& dxdt1, State<T>& error) {
    stepper_.do_step(std::ref(system), x, dxdt, t, x1, dxdt1, h, error);
  }

private:
  boost::numeric::odeint::runge_kutta_dopri5<State<T>, T, State<T>, T, StateAlgebra> stepper_;
};

} // namespace wingspread
