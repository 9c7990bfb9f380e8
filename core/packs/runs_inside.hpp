/// The functions behind runs.hpp: one instance for every kind of wing. Included once for each level
/// of instructions.
#pragma once

#include "core/packs/lanes.hpp"
#include "core/packs/runs.hpp"
#include "core/run/integrator.hpp"

#include <type_traits>

namespace wingspread::detail {

/// visit.operator()<motion>(topology): the chain of a length known to the compiler, if it has one.
template <int N = 1, class Visit> auto with_chain(const Wing<double>& wing, Visit&& visit) {
  if constexpr (N <= longest_static_chain) {
    if (wing.size() == N) return visit.template operator()<BaseMotion::fixed>(Chain<N>{});
    return with_chain<N + 1>(wing, visit);
  } else {
    return visit.template operator()<BaseMotion::fixed>(wing.tree);
  }
}

template <class Visit> auto with_structure(const Wing<double>& wing, Visit&& visit) {
  switch (wing.base.motion) {
  case BaseMotion::prescribed:
    return visit.template operator()<BaseMotion::prescribed>(wing.tree);
  case BaseMotion::free:
    return visit.template operator()<BaseMotion::free>(wing.tree);
  case BaseMotion::fixed:
    break;
  }
  if (is_chain(wing.tree)) return with_chain(wing, visit);
  return visit.template operator()<BaseMotion::fixed>(wing.tree);
}

inline void set_numbers(Wing<double>& wing, const Scene& scene) { set_parameters(wing, scene); }

inline Outcome run_alone(const Wing<double>& wing, Workspace<double>& scratch,
                         const Integration& how, const Goal& goal, const Observer& observer) {
  return with_structure(wing, [&]<BaseMotion M>(const auto& topology) {
    using Topology = std::decay_t<decltype(topology)>;
    System<double, Topology, M> system(wing, topology, how.smoothing, scratch);
    return Integrator<double, Topology, M>(system, how, goal, observer).run();
  });
}

inline Occupancy run_in_lanes(const Wing<double>& structure, PackEngine& engine, Method method,
                              const Integration& how, const Goal& goal, const Runs::NextWing& next,
                              const Runs::Done& done) {
  return with_structure(structure, [&]<BaseMotion M>(const auto& topology) {
    using Topology = std::decay_t<decltype(topology)>;
    return wingspread::Lanes<Topology, M>(structure, topology, engine, method, how, goal)
        .run(next, done);
  });
}

inline constexpr Runs runs_here{&set_numbers, &run_alone, &run_in_lanes};

} // namespace wingspread::detail
