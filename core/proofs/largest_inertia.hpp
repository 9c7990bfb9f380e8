/// The largest inertia that a wing and its free base may come to have about their common centre: I_max of
/// remaining_energy.hpp (3).
#pragma once

#include "core/mechanics/wing.hpp"

namespace wingspread {
namespace detail {

/// The length of the path along the bodies between the centres of k and l, m: it bounds their distance for ever.
template <class T, class AnySystem>
[[nodiscard]] T path_between(const AnySystem& system, int k, int l) {
  const Wing<T>& wing = system.wing();
  Vec2<T> on_k = wing.bodies[k].center, on_l = wing.bodies[l].center; // where the path enters
  T sum(0);
  while (k != l) { // a body has a greater number than its parent
    int& outer = k > l ? k : l;
    Vec2<T>& place = k > l ? on_k : on_l;
    if (system.is_held(outer)) { // one body with its parent
      place = wing.bodies[outer].arm + rotated(sine_cosine(wing.hinges[outer].stowed), place);
    } else {
      sum = sum + length(place);
      place = wing.bodies[outer].arm;
    }
    outer = system.topology().parent_of(outer);
  }
  return sum + length(on_k - on_l);
}

} // namespace detail

/// I_max, kg·m². Cost O(n²) times the tree's depth.
template <class T, class AnySystem> [[nodiscard]] T largest_inertia(const AnySystem& system) {
  const Wing<T>& wing = system.wing();
  T products(0), mass(0), inertia(0);
  for (int l = 0; l <= wing.size(); ++l) {
    mass = mass + wing.bodies[l].mass;
    inertia = inertia + wing.bodies[l].central_inertia;
    for (int k = 0; k < l; ++k) {
      const T d = detail::path_between<T>(system, k, l);
      products = fused(wing.bodies[k].mass * wing.bodies[l].mass, d * d, products);
    }
  }
  return products / mass + inertia;
}

} // namespace wingspread
