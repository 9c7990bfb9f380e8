/// The kinds of wing for which core's templates are compiled, and the one table that chooses among
/// them at run time.
#pragma once

#include "core/mechanics/wing.hpp"

namespace wingspread {

/// Names a kind of wing: its bodies as Tree or Chain<N>, and how its base moves.
template <class Topology, BaseMotion M> struct Structure {};

/// Calls function(Structure<Topology, M>{}) for the kind of this wing and returns its result.
/// Chain<N> serves fixed bases only, where it is faster than Tree (figures: Chain<N> in tree.hpp).
template <class Function> auto with_structure(const Wing<double>& wing, Function function) {
  constexpr BaseMotion fixed = BaseMotion::fixed;
  static_assert(longest_static_chain == 4, "a case for each length");
  if (wing.base.motion == BaseMotion::prescribed)
    return function(Structure<Tree, BaseMotion::prescribed>{});
  if (wing.base.motion == BaseMotion::free) return function(Structure<Tree, BaseMotion::free>{});
  switch (is_chain(wing.tree) ? wing.size() : 0) {
  case 1:
    return function(Structure<Chain<1>, fixed>{});
  case 2:
    return function(Structure<Chain<2>, fixed>{});
  case 3:
    return function(Structure<Chain<3>, fixed>{});
  case 4:
    return function(Structure<Chain<4>, fixed>{});
  default:
    return function(Structure<Tree, fixed>{});
  }
}

} // namespace wingspread
