/// The one place that knows for which kinds of wing the templates are compiled.
#pragma once

#include "core/mechanics/wing.hpp"

namespace wingspread {

namespace detail {

/// The chain of a length that the compiler knows, if it has that.
template <int N = 1, class Visit> auto with_chain(const Wing<double>& wing, Visit&& visit) {
  if constexpr (N <= longest_static_chain) {
    if (wing.size() == N) return visit.template operator()<Chain<N>, BaseMotion::fixed>();
    return with_chain<N + 1>(wing, visit);
  } else {
    return visit.template operator()<Tree, BaseMotion::fixed>();
  }
}

} // namespace detail

/// visit.operator()<Topology, motion>() for the wing's own.
template <class Visit> auto with_structure(const Wing<double>& wing, Visit&& visit) {
  switch (wing.base.motion) {
  case BaseMotion::prescribed:
    return visit.template operator()<Tree, BaseMotion::prescribed>();
  case BaseMotion::free:
    return visit.template operator()<Tree, BaseMotion::free>();
  case BaseMotion::fixed:
    break;
  }
  if (is_chain(wing.tree)) return detail::with_chain(wing, visit);
  return visit.template operator()<Tree, BaseMotion::fixed>();
}

} // namespace wingspread
